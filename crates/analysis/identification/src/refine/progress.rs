//! Progress of a refinement.

use std::sync::atomic::{AtomicU64, Ordering};

use sistership_model::Model;

use super::outcome::RefineError;

/// Callback with the fraction of a refinement that is done (0 to 1) and its present step; returns
/// `false` to cancel it.
pub type Progress<'a> = &'a (dyn Fn(f64, &str) -> bool + Sync);

/// Callback with the fraction of a part of the work that is done (0 to 1) and its present step.
pub(super) type PartProgress<'a> = &'a dyn Fn(f64, &str) -> Result<(), RefineError>;

/// Reports the fraction of a refinement that is done.
///
/// # Errors
/// Returns an error if the callback cancels the refinement.
pub(super) fn report_progress(
    progress: Progress<'_>,
    fraction: f64,
    what: &str,
) -> Result<(), RefineError> {
    if progress(fraction, what) { Ok(()) } else { Err(RefineError::Cancelled) }
}

/// An iterate of the fit on all trials, for learning curves.
pub struct FitIterate<'a> {
    /// Simulations of all trials so far, for a search; 0 for the trajectory form, which does not
    /// count them.
    pub evaluations: usize,
    /// Value of the objective so far; each estimator has its own objective.
    pub objective: f64,
    /// Model that the fit would give if it ended here.
    pub model: &'a dyn Fn() -> Model,
}

/// Observer of the iterates of a fit.
pub type IterateObserver<'a> = &'a (dyn Fn(&FitIterate<'_>) + Sync);

/// Progress that never decreases, whatever fractions the parts of the work report.
pub struct MonotoneProgress<'a> {
    told: Progress<'a>,
    /// Bits of the largest fraction so far. Positive floating-point numbers have the order of their
    /// bits, so that an atomic maximum of integers serves.
    largest: AtomicU64,
}

impl<'a> MonotoneProgress<'a> {
    /// Creates the progress in front of a callback.
    pub fn new(told: Progress<'a>) -> Self {
        Self { told, largest: AtomicU64::new(0.0_f64.to_bits()) }
    }

    /// Reports the larger of a fraction and the largest one before; returns `false` to cancel.
    pub fn report_fraction(&self, fraction: f64, what: &str) -> bool {
        // `max` also turns a fraction that is not a number into 0.
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
            [0.1, 0.8, 0.6, f64::NAN, 0.9]
                .into_iter()
                .all(|fraction| forward.report_fraction(fraction, ""))
        );
        assert_eq!(told.into_inner().unwrap_or_default(), [0.1, 0.8, 0.8, 0.8, 0.9]);
    }
}
