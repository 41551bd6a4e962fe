//! Progress and stop signal between a worker and the work that it supervises.

use std::sync::{Arc, OnceLock};

use tokio::sync::watch;

use super::outcome::{JobError, Result};

/// Reason to stop work before its end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum StopReason {
    /// The job was cancelled.
    Cancelled,
    /// The server is stopping.
    Leaving,
    /// Another worker has the job now.
    Lost,
}

/// Progress of work, and the signal to stop it. A clone is another handle on the same.
#[derive(Debug, Clone)]
pub(super) struct JobProgress {
    stop: Arc<OnceLock<StopReason>>,
    told: Arc<watch::Sender<(f64, String)>>,
}

impl JobProgress {
    pub(super) fn new() -> (Self, watch::Receiver<(f64, String)>) {
        let (told, seen) = watch::channel((0.0, String::new()));
        (Self { stop: Arc::default(), told: Arc::new(told) }, seen)
    }

    /// Reports progress, a fraction of 1; returns false if the work must stop. The progress never
    /// goes back: work that begins anew, as others came in between, keeps the greatest value so
    /// far.
    pub(super) fn report(&self, fraction: f64, what: &str) -> bool {
        self.told.send_modify(|(so_far, doing)| {
            *so_far = so_far.max(fraction);
            what.clone_into(doing);
        });
        self.stop.get().is_none()
    }

    /// Asks the work to stop; the first reason counts.
    pub(super) fn stop(&self, why: StopReason) {
        self.stop.get_or_init(|| why);
    }

    pub(super) fn stop_reason(&self) -> Option<StopReason> {
        self.stop.get().copied()
    }
}

/// Reports the progress of a job.
///
/// # Errors
/// Returns an error if the job must stop.
pub(super) fn report_progress(progress: &JobProgress, fraction: f64, what: &str) -> Result<()> {
    if progress.report(fraction, what) { Ok(()) } else { Err(JobError::Stopped) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn progress_never_runs_backwards() {
        let (progress, seen) = JobProgress::new();
        for (fraction, shown) in [(0.5, 0.5), (0.2, 0.5), (f64::NAN, 0.5), (0.9, 0.9)] {
            assert!(progress.report(fraction, "work"));
            assert_eq!(seen.borrow().0, shown);
        }
        progress.stop(StopReason::Cancelled);
        assert!(!progress.report(1.0, "work"));
    }
}
