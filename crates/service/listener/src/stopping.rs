//! The word that the server shall stop.

use tokio::sync::watch;

/// Listens for the word. A clone listens as well.
#[derive(Debug, Clone)]
pub struct Stopping(watch::Receiver<bool>);

impl Stopping {
    /// Who sends `true`, or goes, stops the server.
    pub fn new() -> (watch::Sender<bool>, Self) {
        let (sender, receiver) = watch::channel(false);
        (sender, Self(receiver))
    }

    /// Whether the server shall stop.
    pub fn now(&self) -> bool {
        *self.0.borrow() || self.0.has_changed().is_err()
    }

    /// Waits until it shall.
    pub async fn wait(&mut self) {
        // An error means that the sender is gone, which says the same.
        drop(self.0.wait_for(|stop| *stop).await);
    }
}
