//! What a worker's supervisor and the work it supervises tell each other.

use std::sync::{Arc, OnceLock};

use tokio::sync::watch;

/// Why work is stopped before its end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Stop {
    /// Somebody cancelled the job.
    Cancelled,
    /// The server is told to stop.
    Leaving,
    /// Another worker has the job now.
    Lost,
}

/// How far work is, and whether it shall go on. A clone is another handle on the same.
#[derive(Debug, Clone)]
pub(super) struct Progress {
    stop: Arc<OnceLock<Stop>>,
    told: Arc<watch::Sender<(f64, String)>>,
}

impl Progress {
    pub(super) fn new() -> (Self, watch::Receiver<(f64, String)>) {
        let (told, seen) = watch::channel((0.0, String::new()));
        (Self { stop: Arc::default(), told: Arc::new(told) }, seen)
    }

    /// Tells how far it is; false when it shall stop.
    pub(super) fn tell(&self, fraction: f64, what: &str) -> bool {
        self.told.send_replace((fraction, what.to_owned()));
        self.stop.get().is_none()
    }

    /// Asks the work to stop; the first reason counts.
    pub(super) fn stop(&self, why: Stop) {
        self.stop.get_or_init(|| why);
    }

    pub(super) fn stopped(&self) -> Option<Stop> {
        self.stop.get().copied()
    }
}
