//! Pools of permits for work that takes processor time. Each kind of work has its own pool, so that
//! a flood of one kind leaves the others theirs, and within a pool no caller keeps others waiting
//! by the number of its requests.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError, Weak};

use sistership_jobs::budget;
use sistership_web_support::problem::{Problem, Result};
use tokio::sync::{OwnedSemaphorePermit, Semaphore};

/// Number of callers from which entries without a waiting request are removed.
const TIDY_ABOVE: usize = 256;

/// A pool of permits.
#[derive(Debug)]
pub(crate) struct ComputePool {
    permits: Arc<Semaphore>,
    size: usize,
    callers: Mutex<HashMap<String, Weak<Semaphore>>>,
}

/// Permission to compute, until it is dropped.
#[derive(Debug)]
pub(crate) struct ComputeTurn {
    _common: OwnedSemaphorePermit,
    _own: OwnedSemaphorePermit,
}

impl ComputePool {
    /// Creates a pool for this number of tasks at a time.
    pub(crate) fn new(size: usize) -> Self {
        let permits = Arc::new(Semaphore::new(size));
        Self { permits, size, callers: Mutex::default() }
    }

    /// Waits for a permit. Of each caller at most as many requests wait for the permits of all as
    /// there are permits; its further ones wait for each other.
    pub(crate) async fn wait_turn(&self, caller: &str) -> Result<ComputeTurn> {
        let own = self.caller_permits(caller).acquire_owned().await.map_err(Problem::internal)?;
        let common = Arc::clone(&self.permits).acquire_owned();
        Ok(ComputeTurn { _common: common.await.map_err(Problem::internal)?, _own: own })
    }

    /// Runs work on a blocking thread when it is the caller's turn.
    pub(crate) async fn run<T: Send + 'static>(
        &self,
        caller: &str,
        work: impl FnOnce() -> T + Send + 'static,
    ) -> Result<T> {
        self.wait_turn(caller).await?.run(work).await
    }

    fn caller_permits(&self, caller: &str) -> Arc<Semaphore> {
        let mut callers = self.callers.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = callers.get(caller).and_then(Weak::upgrade) {
            return known;
        }
        if callers.len() >= TIDY_ABOVE {
            callers.retain(|_, permits| permits.strong_count() > 0);
        }
        let permits = Arc::new(Semaphore::new(self.size));
        callers.insert(caller.to_owned(), Arc::downgrade(&permits));
        permits
    }
}

impl ComputeTurn {
    /// Runs work on a blocking thread, which has the permit until it ends, also if the request that
    /// waits for it is dropped.
    pub(crate) async fn run<T: Send + 'static>(
        self,
        work: impl FnOnce() -> T + Send + 'static,
    ) -> Result<T> {
        let task = tokio::task::spawn_blocking(budget::with_request_memory(move || {
            let _turn = self;
            work()
        }));
        task.await.map_err(Problem::internal)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use std::time::Duration;

    use super::*;

    #[tokio::test]
    async fn a_caller_with_many_requests_delays_others_by_one_at_most() {
        let pool = Arc::new(ComputePool::new(1));
        let done = Arc::new(Mutex::new(Vec::new()));
        let begin = |caller: &'static str| {
            let (pool, done) = (Arc::clone(&pool), Arc::clone(&done));
            tokio::spawn(async move {
                let work = move || {
                    std::thread::sleep(Duration::from_millis(5));
                    done.lock().unwrap().push(caller);
                };
                pool.run(caller, work).await.unwrap();
            })
        };
        let mut tasks: Vec<_> = (0..50).map(|_| begin("flood")).collect();
        // All requests of the flood wait by now.
        tokio::time::sleep(Duration::from_millis(10)).await;
        tasks.push(begin("other"));
        for task in tasks {
            task.await.unwrap();
        }
        let done = done.lock().unwrap();
        let place = done.iter().position(|caller| *caller == "other").unwrap();
        assert!(place <= 6, "behind {place} of the flood");
        assert_eq!(done.len(), 51);
    }

    #[tokio::test]
    async fn callers_without_requests_are_forgotten() {
        let pool = ComputePool::new(1);
        for caller in 0..10_000 {
            pool.run(&caller.to_string(), || ()).await.unwrap();
        }
        assert!(pool.callers.lock().unwrap().len() <= TIDY_ABOVE);
    }
}
