//! Dispatch to wide vector instructions where the processor has them.
//!
//! The same code is compiled three times, with AVX-512, with AVX2 and for the base target, and the
//! version is selected at run time. Without fused multiplication every lane is rounded as it is in
//! the base version, so that results are the same to the last bit. A kernel that calls
//! [`f64::mul_add`] itself is passed to [`fused`].

/// Computation that is compiled for each vector width.
pub trait SimdKernel {
    /// Runs the computation; must be `#[inline(always)]`, and so must all that it calls in its
    /// loops.
    fn run(self);
}

/// Runs a kernel with the widest instructions of the processor.
#[inline]
#[allow(unsafe_code)]
pub fn dispatch_simd(work: impl SimdKernel) {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx512f") {
        // SAFETY: the processor has just been found to have AVX-512.
        return unsafe { with_avx512(work) };
    }
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx2") {
        // SAFETY: the processor has just been found to have AVX2.
        return unsafe { with_avx2(work) };
    }
    work.run();
}

/// Runs a kernel with the widest instructions that multiply and add with one rounding
/// ([`f64::mul_add`]), if the processor has them, and returns true if it did: without them each
/// `mul_add` would be a function call.
#[inline]
#[allow(unsafe_code)]
pub fn dispatch_fused(work: impl SimdKernel) -> bool {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx512f") {
        // SAFETY: the processor has just been found to have AVX-512, of which fusing is a part.
        unsafe { with_avx512(work) };
        return true;
    }
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("fma") {
        // SAFETY: the processor has just been found to have both.
        unsafe { with_avx2_fused(work) };
        return true;
    }
    false
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f")]
fn with_avx512(work: impl SimdKernel) {
    work.run();
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn with_avx2(work: impl SimdKernel) {
    work.run();
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn with_avx2_fused(work: impl SimdKernel) {
    work.run();
}
