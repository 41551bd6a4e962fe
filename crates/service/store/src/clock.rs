//! Time and ids as parameters: the store reads neither the system clock nor random numbers on its
//! own, so that tests can fix both.

use std::sync::Mutex;
use std::sync::PoisonError;
use std::sync::atomic::{AtomicI64, AtomicU64, Ordering};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use uuid::timestamp::Timestamp;
use uuid::timestamp::context::ContextV7;
use uuid::{Builder, Uuid};

/// Source of the present time.
pub trait Clock: Send + Sync + 'static {
    /// Returns the present time, microseconds since 1970.
    fn now_us(&self) -> i64;
}

/// Generator of ids that sort by their time of creation.
pub trait IdGenerator: Send + Sync + 'static {
    /// Returns a new id for a row created at `now_us`, microseconds since 1970.
    fn new_id(&self, now_us: i64) -> String;
}

/// The system clock.
#[derive(Debug, Default, Clone, Copy)]
pub struct SystemClock;

impl Clock for SystemClock {
    fn now_us(&self) -> i64 {
        SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, duration_us)
    }
}

/// A clock that only moves by [`ManualClock::advance`], for tests.
#[derive(Debug)]
pub struct ManualClock(AtomicI64);

impl ManualClock {
    /// Creates a clock that shows `now_us`, microseconds since 1970.
    pub fn new(now_us: i64) -> Self {
        Self(AtomicI64::new(now_us))
    }

    /// Moves the clock forward.
    pub fn advance(&self, by: Duration) {
        self.0.fetch_add(duration_us(by), Ordering::SeqCst);
    }
}

impl Clock for ManualClock {
    fn now_us(&self) -> i64 {
        self.0.load(Ordering::SeqCst)
    }
}

/// UUID version 7: sorted by time, and by order of creation within one process.
#[derive(Debug, Default)]
pub struct UuidIds(Mutex<ContextV7>);

impl IdGenerator for UuidIds {
    fn new_id(&self, now_us: i64) -> String {
        let now = Duration::from_micros(u64::try_from(now_us).unwrap_or(0));
        // The context counts within a millisecond, which keeps the order of ids.
        let context = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        Uuid::new_v7(Timestamp::from_unix(&*context, now.as_secs(), now.subsec_nanos())).to_string()
    }
}

/// UUID version 7 with a counter in place of the random bits: the same calls give the same ids.
#[derive(Debug, Default)]
pub struct SequentialIds(AtomicU64);

impl IdGenerator for SequentialIds {
    fn new_id(&self, now_us: i64) -> String {
        let mut random = [0; 10];
        // The counter takes the last eight of the ten random bytes; it increases with each id.
        random[2..].copy_from_slice(&self.0.fetch_add(1, Ordering::SeqCst).to_be_bytes());
        let millis = u64::try_from(now_us / 1000).unwrap_or(0);
        Builder::from_unix_timestamp_millis(millis, &random).into_uuid().to_string()
    }
}

pub(crate) fn duration_us(duration: Duration) -> i64 {
    i64::try_from(duration.as_micros()).unwrap_or(i64::MAX)
}
