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
const FORGOTTEN: Duration = Duration::from_secs(6);
/// Maximum count of an address, which bounds its waiting time.
const MOST: f64 = 2.0 * FREE;
/// Maximum number of addresses in the table.
const ADDRESSES: usize = 4096;

/// Failed attempts by address.
#[derive(Default)]
pub struct Throttle(Mutex<HashMap<IpAddr, Mistakes>>);

#[derive(Debug, Clone, Copy)]
struct Mistakes {
    count: f64,
    at: Instant,
}

impl Mistakes {
    fn now(&self, now: Instant) -> f64 {
        (self.count
            - now.saturating_duration_since(self.at).as_secs_f64() / FORGOTTEN.as_secs_f64())
        .max(0.0)
    }
}

impl Throttle {
    /// Counts a wrong key; returns the time for which further ones are refused, if there were too
    /// many.
    pub fn wrong(&self, from: IpAddr) -> Option<Duration> {
        self.wrong_at(from, Instant::now())
    }

    fn wrong_at(&self, from: IpAddr, now: Instant) -> Option<Duration> {
        let mut table = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if table.len() >= ADDRESSES && !table.contains_key(&from) {
            make_room(&mut table, now);
        }
        let mistakes = table.entry(from).or_insert(Mistakes { count: 0.0, at: now });
        let before = mistakes.now(now);
        *mistakes = Mistakes { count: (before + 1.0).min(MOST), at: now };
        // Logged once for each time that the limit is reached, not for every attempt.
        if before < FREE && mistakes.count >= FREE {
            tracing::warn!(%from, "many wrong API keys from this address");
        }
        (mistakes.count > FREE).then(|| FORGOTTEN.mul_f64(mistakes.count - FREE))
    }
}

/// Removes expired entries and, if the table is still full, the address with the fewest failed
/// attempts.
fn make_room(table: &mut HashMap<IpAddr, Mistakes>, now: Instant) {
    table.retain(|_, mistakes| mistakes.now(now) > 0.0);
    let fewest =
        table.iter().min_by(|a, b| a.1.now(now).total_cmp(&b.1.now(now))).map(|(from, _)| *from);
    if let Some(from) = fewest.filter(|_| table.len() >= ADDRESSES) {
        table.remove(&from);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mistakes_are_forgotten_and_the_table_is_bounded() {
        let (throttle, start) = (Throttle::default(), Instant::now());
        let address: IpAddr = [10, 0, 0, 1].into();
        assert!((0..10).all(|_| throttle.wrong_at(address, start).is_none()));
        assert_eq!(throttle.wrong_at(address, start), Some(FORGOTTEN));
        assert!(
            throttle.wrong_at([10, 0, 0, 2].into(), start).is_none(),
            "others are not concerned"
        );
        assert!(throttle.wrong_at(address, start + FORGOTTEN * 3).is_none());
        for last in 0..2 * ADDRESSES as u32 {
            throttle.wrong_at(std::net::Ipv4Addr::from(last).into(), start);
        }
        assert_eq!(throttle.0.lock().map(|table| table.len()).ok(), Some(ADDRESSES));
    }
}
