//! Configuration of the system's allocator for memory that was freed.

/// Smallest block that is mapped separately and returned to the system when it is freed, bytes.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
const MMAP_THRESHOLD_BYTES: libc::c_int = 1 << 20;

/// Makes glibc keep less of the memory that was freed.
///
/// Large blocks are returned at once. By default glibc raises the bound to 32 MiB as soon as a
/// block of that size is freed, and then keeps such blocks in an arena for each thread: after eight
/// uploads of 108 MB, 185 MB stayed with an idle server (50 MB with this), which the memory budgets
/// do not include.
///
/// There is one arena for each core, not eight: each arena keeps what it once needed, so that the
/// memory of a server grew for as long as requests met further arenas.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
#[allow(unsafe_code)]
pub(crate) fn configure_allocator() {
    let cores = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    // More than that is no limit for any machine in use.
    let arenas = libc::c_int::try_from(cores.max(2)).unwrap_or(libc::c_int::MAX);
    // SAFETY: `mallopt` is called before any thread is started, with parameters and values that
    // its manual allows. Where it refuses, the defaults stay.
    unsafe {
        libc::mallopt(libc::M_MMAP_THRESHOLD, MMAP_THRESHOLD_BYTES);
        libc::mallopt(libc::M_ARENA_MAX, arenas);
    }
}

/// Does nothing for other allocators.
#[cfg(not(all(target_os = "linux", target_env = "gnu")))]
pub(crate) fn configure_allocator() {}
