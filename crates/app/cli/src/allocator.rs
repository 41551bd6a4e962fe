//! Configuration of the system's allocator for memory that was freed.

/// Smallest block that is mapped separately and returned to the system when it is freed, bytes.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
const MMAP_THRESHOLD_BYTES: libc::c_int = 1 << 20;

/// Makes glibc return large blocks at once. By default it raises the bound to 32 MiB as soon as a
/// block of that size is freed, and then keeps such blocks in an arena for each thread: after eight
/// uploads of 108 MB, 185 MB stayed with an idle server (50 MB with this), which the memory budgets
/// do not include.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
#[allow(unsafe_code)]
pub(crate) fn return_large_blocks() {
    // SAFETY: `mallopt` is called before any thread is started, with a parameter and a value that
    // its manual allows. Where it refuses, the defaults stay.
    unsafe { libc::mallopt(libc::M_MMAP_THRESHOLD, MMAP_THRESHOLD_BYTES) };
}

/// Does nothing for other allocators.
#[cfg(not(all(target_os = "linux", target_env = "gnu")))]
pub(crate) fn return_large_blocks() {}
