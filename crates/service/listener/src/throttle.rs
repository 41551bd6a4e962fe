//! Limits on wrong API keys by address: some attempts are free, then further ones must wait.
//!
//! The right key is never refused, otherwise one program could lock out others at the same address.
//! So this does not make a short key safe: it bounds the cost of guessing for the server, and logs
//! it.

use std::collections::HashMap;
use std::net::IpAddr;
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use tokio::time::Instant;

/// Number of free failed attempts.
const FREE: f64 = 10.0;
/// Time after which one failed attempt is forgotten.
const FORGET_AFTER: Duration = Duration::from_secs(6);
/// Maximum count of an address, which bounds its waiting time.
const MOST: f64 = 2.0 * FREE;
/// Maximum number of addresses in the table.
const ADDRESSES: usize = 4096;

/// Failed attempts by address.
#[derive(Default)]
pub struct KeyThrottle(Mutex<HashMap<IpAddr, FailedAttempts>>);

#[derive(Debug, Clone, Copy)]
struct FailedAttempts {
    count: f64,
    at: Instant,
}

impl FailedAttempts {
    fn current_count(&self, now: Instant) -> f64 {
        (self.count
            - now.saturating_duration_since(self.at).as_secs_f64() / FORGET_AFTER.as_secs_f64())
        .max(0.0)
    }
}

impl KeyThrottle {
    /// Counts a wrong key; returns the time for which further ones are refused, if there were too
    /// many.
    pub fn record_wrong(&self, from: IpAddr) -> Option<Duration> {
        self.record_wrong_at(from, Instant::now())
    }

    fn record_wrong_at(&self, from: IpAddr, now: Instant) -> Option<Duration> {
        let mut table = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if table.len() >= ADDRESSES && !table.contains_key(&from) {
            evict_entry(&mut table, now);
        }
        let mistakes = table.entry(from).or_insert(FailedAttempts { count: 0.0, at: now });
        let before = mistakes.current_count(now);
        *mistakes = FailedAttempts { count: (before + 1.0).min(MOST), at: now };
        // Logged once for each time that the limit is reached, not for every attempt.
        if before < FREE && mistakes.count >= FREE {
            tracing::warn!(%from, "many wrong API keys from this address");
        }
        (mistakes.count > FREE).then(|| FORGET_AFTER.mul_f64(mistakes.count - FREE))
    }
}

/// Removes expired entries and, if the table is still full, the address with the fewest failed
/// attempts.
fn evict_entry(table: &mut HashMap<IpAddr, FailedAttempts>, now: Instant) {
    table.retain(|_, mistakes| mistakes.current_count(now) > 0.0);
    let fewest = table
        .iter()
        .min_by(|a, b| a.1.current_count(now).total_cmp(&b.1.current_count(now)))
        .map(|(from, _)| *from);
    if let Some(from) = fewest.filter(|_| table.len() >= ADDRESSES) {
        table.remove(&from);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mistakes_are_forgotten_and_the_table_is_bounded() {
        let (throttle, start) = (KeyThrottle::default(), Instant::now());
        let address: IpAddr = [10, 0, 0, 1].into();
        assert!((0..10).all(|_| throttle.record_wrong_at(address, start).is_none()));
        assert_eq!(throttle.record_wrong_at(address, start), Some(FORGET_AFTER));
        assert!(
            throttle.record_wrong_at([10, 0, 0, 2].into(), start).is_none(),
            "others are not concerned"
        );
        assert!(throttle.record_wrong_at(address, start + FORGET_AFTER * 3).is_none());
        for last in 0..2 * ADDRESSES as u32 {
            throttle.record_wrong_at(std::net::Ipv4Addr::from(last).into(), start);
        }
        assert_eq!(throttle.0.lock().map(|table| table.len()).ok(), Some(ADDRESSES));
    }
}
