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
const POLL_INTERVAL: Duration = Duration::from_millis(100);

/// Memory budget of one kind of work. A clone is another handle on the same budget.
#[derive(Debug, Clone)]
pub struct MemoryBudget(Arc<BudgetState>);

#[derive(Debug)]
struct BudgetState {
    /// One permit for each KiB.
    permits: Arc<Semaphore>,
    given_back: Arc<Notify>,
    bytes: u64,
    setting: &'static str,
}

/// Share of a budget, returned when it is dropped.
#[derive(Debug)]
pub struct MemoryShare {
    permit: Option<OwnedSemaphorePermit>,
    given_back: Arc<Notify>,
}

/// Reason for which memory cannot be reserved, with sizes in bytes.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum MemoryShortage {
    /// More than the whole budget.
    #[error(
        "this needs about {} MiB of memory, more than the limit of {} MiB ({setting})",
        mib(*.needed),
        mib(*.bytes)
    )]
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
        "this needs about {} MiB of memory, but {} of {} MiB are free at the moment ({setting})",
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

impl MemoryBudget {
    /// Creates a budget of `bytes`; `setting` is the name of the setting in messages.
    pub fn new(bytes: u64, setting: &'static str) -> Self {
        let permits =
            // A semaphore counts at most `MAX_PERMITS`; a budget above that many KiB is limited to
            // it.
            usize::try_from(bytes / KIB).unwrap_or(usize::MAX).min(Semaphore::MAX_PERMITS);
        let given_back = Arc::new(Notify::new());
        Self(Arc::new(BudgetState {
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
    pub fn try_reserve(&self, bytes: u64) -> Result<MemoryShare, MemoryShortage> {
        let BudgetState { permits, given_back, bytes: all, setting } = &*self.0;
        let never = || MemoryShortage::Never { needed: bytes, bytes: *all, setting };
        let needed = u32::try_from(bytes.div_ceil(KIB))
            .ok()
            .filter(|needed| u64::from(*needed) * KIB <= *all)
            .ok_or_else(never)?;
        let taken = Arc::clone(permits).try_acquire_many_owned(needed);
        // Only for the message; others may take or return memory meanwhile.
        let free = permits.available_permits() as u64 * KIB;
        let permit = taken.map_err(|_| MemoryShortage::Busy {
            needed: bytes,
            free,
            bytes: *all,
            setting,
        })?;
        Ok(MemoryShare { permit: Some(permit), given_back: Arc::clone(given_back) })
    }

    /// Reserves a share as soon as it is free. There is no queue: a small reservation may pass a
    /// large one that waits.
    ///
    /// # Errors
    /// Returns an error with the sizes if the budget is too small, or too little of it is free
    /// until `patience` has passed.
    pub async fn reserve(
        &self,
        bytes: u64,
        patience: Duration,
    ) -> Result<MemoryShare, MemoryShortage> {
        let end = tokio::time::Instant::now() + patience;
        loop {
            // Created before the attempt, so that a share that is returned in between is not
            // missed.
            let given_back = self.0.given_back.notified();
            let shortage = match self.try_reserve(bytes) {
                Err(shortage @ MemoryShortage::Busy { .. })
                    if tokio::time::Instant::now() < end =>
                {
                    shortage
                }
                other => return other,
            };
            tracing::trace!(%shortage, "waiting for memory");
            let _ = tokio::time::timeout_at(
                end.min(tokio::time::Instant::now() + POLL_INTERVAL),
                given_back,
            )
            .await;
        }
    }

    /// Free memory, bytes.
    pub fn free_bytes(&self) -> u64 {
        self.0.permits.available_permits() as u64 * KIB
    }
}

impl Drop for MemoryShare {
    fn drop(&mut self) {
        // The permits go back first: a task that is woken must find them.
        drop(self.permit.take());
        self.given_back.notify_waiters();
    }
}

/// Memory reserved by a request. A clone is another handle; the memory is returned with the last
/// one.
#[derive(Debug, Clone)]
pub struct RequestMemory(Arc<RequestMemoryState>);

#[derive(Debug)]
struct RequestMemoryState {
    budget: MemoryBudget,
    patience: Duration,
    shares: Mutex<Vec<MemoryShare>>,
}

tokio::task_local! {
    static HELD: RequestMemory;
}

impl RequestMemory {
    /// Creates an empty reservation; each later one waits at most `patience` for the budget.
    pub fn new(budget: MemoryBudget, patience: Duration) -> Self {
        Self(Arc::new(RequestMemoryState { budget, patience, shares: Mutex::default() }))
    }

    /// Runs a request; reservations within it belong to this request.
    pub async fn run_async<T>(self, work: impl Future<Output = T>) -> T {
        HELD.scope(self, work).await
    }

    /// Runs a closure on a blocking thread; reservations within it belong to this request.
    pub fn run_blocking<T>(self, work: impl FnOnce() -> T) -> T {
        HELD.sync_scope(self, work)
    }

    /// Returns the reservation of the current request; `None` outside of a request.
    pub fn current() -> Option<Self> {
        HELD.try_with(Self::clone).ok()
    }

    fn add_share(&self, share: MemoryShare) {
        // A poisoned lock is usable: a push leaves the list complete or unchanged.
        self.0.shares.lock().unwrap_or_else(PoisonError::into_inner).push(share);
    }
}

/// Reserves memory for the current request until it has been answered. Does nothing outside of one.
///
/// # Errors
/// Returns an error with the sizes if the budget is too small, or too little of it becomes free in
/// time.
pub async fn reserve_for_request(bytes: u64) -> Result<(), MemoryShortage> {
    if let Some(held) = RequestMemory::current() {
        held.add_share(held.0.budget.reserve(bytes, held.0.patience).await?);
    }
    Ok(())
}

/// Reserves a separate share for a part of the current request that ends before it; `None` outside
/// of a request.
///
/// # Errors
/// Returns an error with the sizes if the budget is too small, or too little of it becomes free in
/// time.
pub async fn reserve_share(bytes: u64) -> Result<Option<MemoryShare>, MemoryShortage> {
    let Some(held) = RequestMemory::current() else { return Ok(None) };
    Ok(Some(held.0.budget.reserve(bytes, held.0.patience).await?))
}

/// Reserves memory for the current request from a thread that cannot wait. Does nothing outside of
/// one.
///
/// # Errors
/// Returns an error with the sizes if the budget is too small, or too little of it is free now.
pub fn try_reserve_for_request(bytes: u64) -> Result<(), MemoryShortage> {
    if let Some(held) = RequestMemory::current() {
        held.add_share(held.0.budget.try_reserve(bytes)?);
    }
    Ok(())
}

/// Wraps work for a blocking thread so that it keeps the memory of the current request until it
/// ends.
pub fn with_request_memory<T>(
    work: impl FnOnce() -> T + Send + 'static,
) -> impl FnOnce() -> T + Send + 'static {
    let held = RequestMemory::current();
    move || match held {
        Some(held) => held.run_blocking(work),
        None => work(),
    }
}

/// Runs a future that continues after the client has disconnected, with the memory of its request.
pub async fn run_with_request_memory<T>(
    held: Option<RequestMemory>,
    work: impl Future<Output = T>,
) -> T {
    match held {
        Some(held) => held.run_async(work).await,
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
        let budget = MemoryBudget::new(4 * MIB, "--memory-mb");
        let never = budget.reserve(5 * MIB, Duration::from_secs(60)).await.unwrap_err();
        assert_eq!(
            never.to_string(),
            "this needs about 5 MiB of memory, more than the limit of 4 MiB (--memory-mb)"
        );
        assert!(matches!(never, MemoryShortage::Never { .. }));
        let most = budget.try_reserve(3 * MIB).unwrap();
        let busy = budget.reserve(2 * MIB, Duration::from_millis(20)).await.unwrap_err();
        assert!(busy.to_string().contains("1 of 4 MiB are free"), "{busy}");
        assert!(matches!(busy, MemoryShortage::Busy { .. }));
        let small = budget.try_reserve(MIB).unwrap();
        let waiting = tokio::spawn({
            let budget = budget.clone();
            async move { budget.reserve(2 * MIB, Duration::from_secs(60)).await.map(drop) }
        });
        tokio::task::yield_now().await;
        drop((most, small));
        waiting.await.unwrap().unwrap();
        assert_eq!(budget.free_bytes(), 4 * MIB);
    }

    #[tokio::test]
    async fn small_requests_pass_a_large_one_that_waits() {
        let budget = MemoryBudget::new(4 * MIB, "x");
        let first = budget.try_reserve(2 * MIB).unwrap();
        let other = budget.clone();
        let large =
            tokio::spawn(
                async move { other.reserve(4 * MIB, Duration::from_secs(60)).await.map(drop) },
            );
        tokio::task::yield_now().await;
        drop(budget.reserve(2 * MIB, Duration::ZERO).await.unwrap());
        drop(first);
        large.await.unwrap().unwrap();
    }

    #[tokio::test]
    async fn what_a_request_has_taken_outlives_it_where_work_goes_on() {
        let budget = MemoryBudget::new(4 * MIB, "x");
        let held = RequestMemory::new(budget.clone(), Duration::ZERO);
        let left = held
            .run_async(async {
                reserve_for_request(3 * MIB).await.unwrap();
                with_request_memory(|| try_reserve_for_request(MIB).unwrap())
            })
            .await;
        assert_eq!(budget.free_bytes(), MIB);
        left();
        assert_eq!(budget.free_bytes(), 4 * MIB);
    }
}
