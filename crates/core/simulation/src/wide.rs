//! Wide vector instructions where the processor has them.
//!
//! The same code is compiled three times, with AVX-512, with AVX2 and plainly, and the processor is
//! asked which to run. Nothing else differs: without fused multiplication every lane is rounded as
//! it is in the plain code, so that results are the same to the last bit. What calls
//! [`f64::mul_add`] itself passes [`fused`].

/// What is worth compiling for each width.
pub trait Wide {
    /// Does it; to be `#[inline(always)]`, and so all that it calls in its loops.
    fn go(self);
}

/// Does it with the widest instructions that the processor has.
#[inline]
#[allow(unsafe_code)]
pub fn widest(work: impl Wide) {
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
    work.go();
}

/// Does it where the processor has instructions that multiply and add with one rounding
/// ([`f64::mul_add`]), by the widest of them, and says whether it did: elsewhere each would be a
/// call.
#[inline]
#[allow(unsafe_code)]
pub fn fused(work: impl Wide) -> bool {
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
fn with_avx512(work: impl Wide) {
    work.go();
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn with_avx2(work: impl Wide) {
    work.go();
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn with_avx2_fused(work: impl Wide) {
    work.go();
}
