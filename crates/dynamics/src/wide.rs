//! Wide vector instructions where the processor has them.
//!
//! The same code is compiled twice, once with AVX2, and the processor is asked which to run. Nothing else differs: without fused
//! multiplication every lane is rounded as it is in the plain code, so that results are the same to the last bit.

/// What is worth compiling twice.
pub(crate) trait Wide {
    /// Does it; to be `#[inline(always)]`, and so all that it calls in its loops.
    fn go(self);
}

/// Does it with AVX2 where the processor has that, else as it is.
#[inline]
pub(crate) fn widest(work: impl Wide) {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx2") {
        // SAFETY: the processor has just been found to have AVX2.
        #[allow(unsafe_code)]
        unsafe {
            with_avx2(work);
        }
        return;
    }
    work.go();
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn with_avx2(work: impl Wide) {
    work.go();
}
