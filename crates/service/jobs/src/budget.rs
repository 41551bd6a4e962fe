//! Memory budget shared by requests and jobs: a large allocation first reserves a share of the
//! budget.
//!
//! A reservation that does not fit at the moment waits a limited time; one that exceeds the whole
//! budget is refused at once. The shares of a request are kept as long as any work for it runs,
//! also after its client has disconnected.

use std::future::Future;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use tokio::sync::{Notify, OwnedSemaphorePermit, Semaphore};

const KIB: u64 = 1 << 10;
/// Poll interval of a waiting reservation, in case a notification is missed.
const LOOK: Duration = Duration::from_millis(100);

/// Memory budget of one kind of work. A clone is another handle on the same budget.
#[derive(Debug, Clone)]
pub struct Budget(Arc<Inner>);

#[derive(Debug)]
struct Inner {
    /// One permit for each KiB.
    permits: Arc<Semaphore>,
    given_back: Arc<Notify>,
    bytes: u64,
    setting: &'static str,
}

/// Share of a budget, returned when it is dropped.
#[derive(Debug)]
pub struct Share {
    permit: Option<OwnedSemaphorePermit>,
    given_back: Arc<Notify>,
}

/// Reason for which memory cannot be reserved, with sizes in bytes.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Shortage {
    /// More than the whole budget.
    #[error("this takes about {} MiB of memory, more than the {} MiB that there are ({setting})", mib(*.needed), mib(*.bytes))]
    Never {
        /// Requested size, bytes.
        needed: u64,
        /// Bytes of the budget.
        bytes: u64,
        /// Setting that defines the size.
        setting: &'static str,
    },
    /// More than what is free at the moment.
    #[error(
        "this takes about {} MiB of memory, and {} of {} MiB are free at the moment ({setting})",
        mib(*.needed), .free / (1 << 20), mib(*.bytes)
    )]
    Busy {
        /// Requested size, bytes.
        needed: u64,
        /// Bytes that were free.
        free: u64,
        /// Bytes of the budget.
        bytes: u64,
        /// Setting that defines the size.
        setting: &'static str,
    },
}

fn mib(bytes: u64) -> u64 {
    bytes.div_ceil(1 << 20)
}

impl Budget {
    /// Creates a budget of `bytes`; `setting` is the name of the setting in messages.
    pub fn new(bytes: u64, setting: &'static str) -> Self {
        let permits =
            // A semaphore counts at most `MAX_PERMITS`; a budget above that many KiB is limited to
            // it.
            usize::try_from(bytes / KIB).unwrap_or(usize::MAX).min(Semaphore::MAX_PERMITS);
        let given_back = Arc::new(Notify::new());
        Self(Arc::new(Inner {
            permits: Arc::new(Semaphore::new(permits)),
            given_back,
            bytes,
            setting,
        }))
    }

    /// Reserves a share if it is free now.
    ///
    /// # Errors
    /// Returns an error with the sizes if the budget is too small, or too little of it is free now.
    pub fn try_take(&self, bytes: u64) -> Result<Share, Shortage> {
        let Inner { permits, given_back, bytes: all, setting } = &*self.0;
        let never = || Shortage::Never { needed: bytes, bytes: *all, setting };
        let needed = u32::try_from(bytes.div_ceil(KIB))
            .ok()
            .filter(|needed| u64::from(*needed) * KIB <= *all)
            .ok_or_else(never)?;
        let taken = Arc::clone(permits).try_acquire_many_owned(needed);
        // Only for the message; others may take or return memory meanwhile.
        let free = permits.available_permits() as u64 * KIB;
        let permit =
            taken.map_err(|_| Shortage::Busy { needed: bytes, free, bytes: *all, setting })?;
        Ok(Share { permit: Some(permit), given_back: Arc::clone(given_back) })
    }

    /// Reserves a share as soon as it is free. There is no queue: a small reservation may pass a
    /// large one that waits.
    ///
    /// # Errors
    /// Returns an error with the sizes if the budget is too small, or too little of it is free
    /// until `patience` has passed.
    pub async fn take(&self, bytes: u64, patience: Duration) -> Result<Share, Shortage> {
        let end = tokio::time::Instant::now() + patience;
        loop {
            // Created before the attempt, so that a share that is returned in between is not
            // missed.
            let given_back = self.0.given_back.notified();
            let shortage = match self.try_take(bytes) {
                Err(shortage @ Shortage::Busy { .. }) if tokio::time::Instant::now() < end => {
                    shortage
                }
                other => return other,
            };
            tracing::trace!(%shortage, "waiting for memory");
            let _ =
                tokio::time::timeout_at(end.min(tokio::time::Instant::now() + LOOK), given_back)
                    .await;
        }
    }

    /// Free memory, bytes.
    pub fn free(&self) -> u64 {
        self.0.permits.available_permits() as u64 * KIB
    }
}

impl Drop for Share {
    fn drop(&mut self) {
        // The permits go back first: a task that is woken must find them.
        drop(self.permit.take());
        self.given_back.notify_waiters();
    }
}

/// Memory reserved by a request. A clone is another handle; the memory is returned with the last
/// one.
#[derive(Debug, Clone)]
pub struct Held(Arc<Holding>);

#[derive(Debug)]
struct Holding {
    budget: Budget,
    patience: Duration,
    shares: Mutex<Vec<Share>>,
}

tokio::task_local! {
    static HELD: Held;
}

impl Held {
    /// Creates an empty reservation; each later one waits at most `patience` for the budget.
    pub fn new(budget: Budget, patience: Duration) -> Self {
        Self(Arc::new(Holding { budget, patience, shares: Mutex::default() }))
    }

    /// Runs a request; reservations within it belong to this request.
    pub async fn scope<T>(self, work: impl Future<Output = T>) -> T {
        HELD.scope(self, work).await
    }

    /// Runs a closure on a blocking thread; reservations within it belong to this request.
    pub fn sync_scope<T>(self, work: impl FnOnce() -> T) -> T {
        HELD.sync_scope(self, work)
    }

    /// Returns the reservation of the current request; `None` outside of a request.
    pub fn current() -> Option<Self> {
        HELD.try_with(Self::clone).ok()
    }

    fn keep(&self, share: Share) {
        // A poisoned lock is usable: a push leaves the list complete or unchanged.
        self.0.shares.lock().unwrap_or_else(PoisonError::into_inner).push(share);
    }
}

/// Reserves memory for the current request until it has been answered. Does nothing outside of one.
///
/// # Errors
/// Returns an error with the sizes if the budget is too small, or too little of it becomes free in
/// time.
pub async fn take(bytes: u64) -> Result<(), Shortage> {
    if let Some(held) = Held::current() {
        held.keep(held.0.budget.take(bytes, held.0.patience).await?);
    }
    Ok(())
}

/// Reserves a separate share for a part of the current request that ends before it; `None` outside
/// of a request.
///
/// # Errors
/// Returns an error with the sizes if the budget is too small, or too little of it becomes free in
/// time.
pub async fn share(bytes: u64) -> Result<Option<Share>, Shortage> {
    let Some(held) = Held::current() else { return Ok(None) };
    Ok(Some(held.0.budget.take(bytes, held.0.patience).await?))
}

/// Reserves memory for the current request from a thread that cannot wait. Does nothing outside of
/// one.
///
/// # Errors
/// Returns an error with the sizes if the budget is too small, or too little of it is free now.
pub fn take_now(bytes: u64) -> Result<(), Shortage> {
    if let Some(held) = Held::current() {
        held.keep(held.0.budget.try_take(bytes)?);
    }
    Ok(())
}

/// Wraps work for a blocking thread so that it keeps the memory of the current request until it
/// ends.
pub fn carried<T>(
    work: impl FnOnce() -> T + Send + 'static,
) -> impl FnOnce() -> T + Send + 'static {
    let held = Held::current();
    move || match held {
        Some(held) => held.sync_scope(work),
        None => work(),
    }
}

/// Runs a future that continues after the client has disconnected, with the memory of its request.
pub async fn carried_on<T>(held: Option<Held>, work: impl Future<Output = T>) -> T {
    match held {
        Some(held) => held.scope(work).await,
        None => work.await,
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    const MIB: u64 = 1 << 20;

    #[tokio::test]
    async fn what_never_fits_is_refused_and_what_is_taken_waits() {
        let budget = Budget::new(4 * MIB, "--memory-mb");
        let never = budget.take(5 * MIB, Duration::from_secs(60)).await.unwrap_err();
        assert_eq!(
            never.to_string(),
            "this takes about 5 MiB of memory, more than the 4 MiB that there are (--memory-mb)"
        );
        assert!(matches!(never, Shortage::Never { .. }));
        let most = budget.try_take(3 * MIB).unwrap();
        let busy = budget.take(2 * MIB, Duration::from_millis(20)).await.unwrap_err();
        assert!(busy.to_string().contains("1 of 4 MiB are free"), "{busy}");
        assert!(matches!(busy, Shortage::Busy { .. }));
        let small = budget.try_take(MIB).unwrap();
        let waiting = tokio::spawn({
            let budget = budget.clone();
            async move { budget.take(2 * MIB, Duration::from_secs(60)).await.map(drop) }
        });
        tokio::task::yield_now().await;
        drop((most, small));
        waiting.await.unwrap().unwrap();
        assert_eq!(budget.free(), 4 * MIB);
    }

    #[tokio::test]
    async fn small_requests_pass_a_large_one_that_waits() {
        let budget = Budget::new(4 * MIB, "x");
        let first = budget.try_take(2 * MIB).unwrap();
        let other = budget.clone();
        let large =
            tokio::spawn(
                async move { other.take(4 * MIB, Duration::from_secs(60)).await.map(drop) },
            );
        tokio::task::yield_now().await;
        drop(budget.take(2 * MIB, Duration::ZERO).await.unwrap());
        drop(first);
        large.await.unwrap().unwrap();
    }

    #[tokio::test]
    async fn what_a_request_has_taken_outlives_it_where_work_goes_on() {
        let budget = Budget::new(4 * MIB, "x");
        let held = Held::new(budget.clone(), Duration::ZERO);
        let left = held
            .scope(async {
                take(3 * MIB).await.unwrap();
                carried(|| take_now(MIB).unwrap())
            })
            .await;
        assert_eq!(budget.free(), MIB);
        left();
        assert_eq!(budget.free(), 4 * MIB);
    }
}
