//! Memory that requests and jobs may take together: who needs more than a little takes a share of a
//! budget before allocating it.
//!
//! What does not fit at the moment waits a while for others to end; what can never fit is refused
//! at once. A request's shares are kept for as long as anything works for it, also where its caller
//! has hung up.

use std::future::Future;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use tokio::sync::{Notify, OwnedSemaphorePermit, Semaphore};

const KIB: u64 = 1 << 10;
/// How often somebody waiting looks again, should a word of what is given back be missed.
const LOOK: Duration = Duration::from_millis(100);

/// Memory that some kind of work may take. A clone is another handle on the same one.
#[derive(Debug, Clone)]
pub struct Budget(Arc<Inner>);

#[derive(Debug)]
struct Inner {
    /// One for each KiB.
    permits: Arc<Semaphore>,
    given_back: Arc<Notify>,
    bytes: u64,
    setting: &'static str,
}

/// A part of a budget, given back when it is dropped.
#[derive(Debug)]
pub struct Share {
    permit: Option<OwnedSemaphorePermit>,
    given_back: Arc<Notify>,
}

/// Why there is no memory for something, in numbers.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Shortage {
    /// It is more than all of it.
    #[error("this takes about {} MiB of memory, more than the {} MiB that there are ({setting})", mib(*.needed), mib(*.bytes))]
    Never {
        /// Bytes that were asked for.
        needed: u64,
        /// Bytes of the budget.
        bytes: u64,
        /// What sets it.
        setting: &'static str,
    },
    /// Others have too much of it.
    #[error(
        "this takes about {} MiB of memory, and {} of {} MiB are free at the moment ({setting})",
        mib(*.needed), .free / (1 << 20), mib(*.bytes)
    )]
    Busy {
        /// Bytes that were asked for.
        needed: u64,
        /// Bytes that were free.
        free: u64,
        /// Bytes of the budget.
        bytes: u64,
        /// What sets it.
        setting: &'static str,
    },
}

fn mib(bytes: u64) -> u64 {
    bytes.div_ceil(1 << 20)
}

impl Budget {
    /// Of so many bytes; `setting` is what its user knows it by.
    pub fn new(bytes: u64, setting: &'static str) -> Self {
        let permits =
            usize::try_from(bytes / KIB).unwrap_or(usize::MAX).min(Semaphore::MAX_PERMITS);
        let given_back = Arc::new(Notify::new());
        Self(Arc::new(Inner {
            permits: Arc::new(Semaphore::new(permits)),
            given_back,
            bytes,
            setting,
        }))
    }

    /// A share, if it is free now.
    ///
    /// # Errors
    /// There is not so much, or not now.
    pub fn try_take(&self, bytes: u64) -> Result<Share, Shortage> {
        let Inner { permits, given_back, bytes: all, setting } = &*self.0;
        let never = || Shortage::Never { needed: bytes, bytes: *all, setting };
        let needed = u32::try_from(bytes.div_ceil(KIB))
            .ok()
            .filter(|needed| u64::from(*needed) * KIB <= *all)
            .ok_or_else(never)?;
        let taken = Arc::clone(permits).try_acquire_many_owned(needed);
        let free = permits.available_permits() as u64 * KIB;
        let permit =
            taken.map_err(|_| Shortage::Busy { needed: bytes, free, bytes: *all, setting })?;
        Ok(Share { permit: Some(permit), given_back: Arc::clone(given_back) })
    }

    /// A share, as soon as it is free. Nobody waits behind another: what is small goes on while
    /// something large waits.
    ///
    /// # Errors
    /// There is not so much, or not soon.
    pub async fn take(&self, bytes: u64, patience: Duration) -> Result<Share, Shortage> {
        let end = tokio::time::Instant::now() + patience;
        loop {
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

    /// Bytes that nobody has.
    pub fn free(&self) -> u64 {
        self.0.permits.available_permits() as u64 * KIB
    }
}

impl Drop for Share {
    fn drop(&mut self) {
        drop(self.permit.take());
        self.given_back.notify_waiters();
    }
}

/// What a request has taken. A clone is another handle on the same: all is given back with the
/// last.
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
    /// Nothing yet, of a budget for whose memory it may wait so long.
    pub fn new(budget: Budget, patience: Duration) -> Self {
        Self(Arc::new(Holding { budget, patience, shares: Mutex::default() }))
    }

    /// Carries a request out; [`take`] within it takes for it.
    pub async fn scope<T>(self, work: impl Future<Output = T>) -> T {
        HELD.scope(self, work).await
    }

    /// As [`scope`](Self::scope), on a thread of its own.
    pub fn sync_scope<T>(self, work: impl FnOnce() -> T) -> T {
        HELD.sync_scope(self, work)
    }

    /// What the request that is being carried out has taken; none outside of one.
    pub fn current() -> Option<Self> {
        HELD.try_with(Self::clone).ok()
    }

    fn keep(&self, share: Share) {
        self.0.shares.lock().unwrap_or_else(PoisonError::into_inner).push(share);
    }
}

/// Takes memory for the request that is being carried out, until it has been answered.
///
/// # Errors
/// There is not so much, or not soon.
pub async fn take(bytes: u64) -> Result<(), Shortage> {
    if let Some(held) = Held::current() {
        held.keep(held.0.budget.take(bytes, held.0.patience).await?);
    }
    Ok(())
}

/// A share of its own for a part of a request that ends before it; none outside of one.
///
/// # Errors
/// There is not so much, or not soon.
pub async fn share(bytes: u64) -> Result<Option<Share>, Shortage> {
    let Some(held) = Held::current() else { return Ok(None) };
    Ok(Some(held.0.budget.take(bytes, held.0.patience).await?))
}

/// As [`take`], from a thread that cannot wait.
///
/// # Errors
/// There is not so much, or not now.
pub fn take_now(bytes: u64) -> Result<(), Shortage> {
    if let Some(held) = Held::current() {
        held.keep(held.0.budget.try_take(bytes)?);
    }
    Ok(())
}

/// Runs work on a thread that may block, with what the request has taken until the work has ended.
pub fn carried<T>(
    work: impl FnOnce() -> T + Send + 'static,
) -> impl FnOnce() -> T + Send + 'static {
    let held = Held::current();
    move || match held {
        Some(held) => held.sync_scope(work),
        None => work(),
    }
}

/// A future that goes on if its request's caller hangs up, with what the request has taken.
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
