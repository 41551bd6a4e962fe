//! Stop signal of the server.

use tokio::sync::watch;

/// Receiver of the stop signal; clones receive it as well.
#[derive(Debug, Clone)]
pub struct StopSignal(watch::Receiver<bool>);

impl StopSignal {
    /// Creates a signal; sending `true`, or dropping the sender, stops the server.
    pub fn new() -> (watch::Sender<bool>, Self) {
        let (sender, receiver) = watch::channel(false);
        (sender, Self(receiver))
    }

    /// Returns true if the server is to stop.
    pub fn is_stopping(&self) -> bool {
        *self.0.borrow() || self.0.has_changed().is_err()
    }

    /// Waits for the signal.
    pub async fn wait(&mut self) {
        // An error means that the sender was dropped, which stops the server too.
        drop(self.0.wait_for(|stop| *stop).await);
    }
}
