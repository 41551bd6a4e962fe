//! Signal that jobs have been queued, raised after the commit that queued them: a worker that looked
//! earlier would not find them.

use tokio::sync::watch;

/// Sender of the signal, shared by all handles of a store.
#[derive(Debug, Clone)]
pub(crate) struct QueueSignal(watch::Sender<()>);

/// One worker's view of the queue: it also notices jobs that are queued while it does not wait.
#[derive(Debug)]
pub struct QueueWatch(watch::Receiver<()>);

impl Default for QueueSignal {
    fn default() -> Self {
        Self(watch::Sender::new(()))
    }
}

impl QueueSignal {
    /// Wakes all workers that watch the queue.
    pub(crate) fn raise(&self) {
        self.0.send_replace(());
    }

    pub(crate) fn subscribe(&self) -> QueueWatch {
        QueueWatch(self.0.subscribe())
    }
}

impl QueueWatch {
    /// Waits until jobs are queued through this store; returns at once if that happened since the
    /// last call.
    pub async fn wait_queued(&mut self) {
        // Without a store there are no more jobs to wait for.
        if self.0.changed().await.is_err() {
            std::future::pending().await
        }
    }
}
