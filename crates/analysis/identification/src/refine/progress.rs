//! What a refinement tells while it works.

use std::sync::atomic::{AtomicU64, Ordering};

use sistership_model::Model;

use super::outcome::RefineError;

/// Told how far a refinement is (0 to 1) and what it does; answers `false` to stop it.
pub type Progress<'a> = &'a (dyn Fn(f64, &str) -> bool + Sync);

/// Told how far a part of the work is (0 to 1), and what it does.
pub(super) type PartProgress<'a> = &'a dyn Fn(f64, &str) -> Result<(), RefineError>;

/// Tells how far a refinement is.
///
/// # Errors
/// It was cancelled.
pub(super) fn step(progress: Progress<'_>, fraction: f64, what: &str) -> Result<(), RefineError> {
    if progress(fraction, what) { Ok(()) } else { Err(RefineError::Cancelled) }
}

/// An iterate of the fit on all trials: for learning curves.
pub struct Iterate<'a> {
    /// Simulations of all trials so far, by a search; 0 for the trajectory form, which does not
    /// count them.
    pub evaluations: usize,
    /// What the estimator makes least, so far; each estimator has its own.
    pub objective: f64,
    /// The model that it would give if it ended here.
    pub model: &'a dyn Fn() -> Model,
}

/// Shown the iterates of a fit.
pub type Watch<'a> = &'a (dyn Fn(&Iterate<'_>) + Sync);

/// Progress that never runs backwards, whatever the parts of the work say.
pub struct MonotoneProgress<'a> {
    told: Progress<'a>,
    /// The bits of the largest fraction so far; those of positive numbers have the numbers' order.
    largest: AtomicU64,
}

impl<'a> MonotoneProgress<'a> {
    /// Of whoever is told.
    pub fn new(told: Progress<'a>) -> Self {
        Self { told, largest: AtomicU64::new(0.0_f64.to_bits()) }
    }

    /// Tells the largest fraction so far.
    pub fn tell(&self, fraction: f64, what: &str) -> bool {
        let bits = fraction.max(0.0).to_bits();
        let before = self.largest.fetch_max(bits, Ordering::Relaxed);
        (self.told)(f64::from_bits(before.max(bits)), what)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn progress_never_runs_backwards() {
        let told = std::sync::Mutex::new(Vec::new());
        let note = |fraction: f64, _: &str| {
            told.lock().is_ok_and(|mut told| {
                told.push(fraction);
                true
            })
        };
        let forward = MonotoneProgress::new(&note);
        assert!(
            [0.1, 0.8, 0.6, f64::NAN, 0.9].into_iter().all(|fraction| forward.tell(fraction, ""))
        );
        assert_eq!(told.into_inner().unwrap_or_default(), [0.1, 0.8, 0.8, 0.8, 0.9]);
    }
}
