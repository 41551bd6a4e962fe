//! Wrong passwords of late, by name and by address: some are free, then further attempts wait. A
//! password is short enough to be guessed, so that, unlike with keys, the right one waits too; the
//! wait is bounded, so that nobody is shut out for long.

use std::collections::HashMap;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Mistakes that are free.
const FREE: f64 = 5.0;
/// The time after which one mistake is forgotten.
const FORGOTTEN: Duration = Duration::from_secs(12);
/// The most mistakes that are remembered.
const MOST: f64 = 10.0;
/// Names and addresses that are remembered.
const KNOWN: usize = 4096;

/// Mistakes by whom they concern.
#[derive(Debug, Default)]
pub struct Attempts(Mutex<HashMap<String, (f64, Instant)>>);

impl Attempts {
    /// How long an attempt must wait, if it must.
    pub fn wait(&self, whom: &str, now: Instant) -> Option<Duration> {
        let table = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let count = table.get(whom).map_or(0.0, |mistakes| left(*mistakes, now));
        (count >= FREE).then(|| FORGOTTEN.mul_f64(count - FREE + 1.0))
    }

    /// Counts a mistake.
    pub fn wrong(&self, whom: &str, now: Instant) {
        let mut table = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if table.len() >= KNOWN {
            table.retain(|_, mistakes| left(*mistakes, now) > 0.0);
        }
        if table.len() >= KNOWN && !table.contains_key(whom) {
            let fewest = table.iter().min_by(|a, b| left(*a.1, now).total_cmp(&left(*b.1, now)));
            if let Some(fewest) = fewest.map(|(whom, _)| whom.clone()) {
                table.remove(&fewest);
            }
        }
        let mistakes = table.entry(whom.to_owned()).or_insert((0.0, now));
        *mistakes = ((left(*mistakes, now) + 1.0).min(MOST), now);
    }
}

/// What is not forgotten yet.
fn left((count, at): (f64, Instant), now: Instant) -> f64 {
    let passed = now.saturating_duration_since(at).as_secs_f64() / FORGOTTEN.as_secs_f64();
    (count - passed).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mistakes_make_wait_and_are_forgotten() {
        let (attempts, start) = (Attempts::default(), Instant::now());
        for _ in 0..5 {
            assert_eq!(attempts.wait("ann", start), None);
            attempts.wrong("ann", start);
        }
        assert_eq!(attempts.wait("ann", start), Some(FORGOTTEN));
        assert_eq!(attempts.wait("bob", start), None);
        assert_eq!(attempts.wait("ann", start + FORGOTTEN * 2), None);
        (0..50).for_each(|_| attempts.wrong("ann", start));
        assert_eq!(attempts.wait("ann", start), Some(FORGOTTEN * 6), "bounded");
        (0..2 * KNOWN).for_each(|n| attempts.wrong(&n.to_string(), start));
        assert!(attempts.0.lock().is_ok_and(|table| table.len() == KNOWN));
    }
}
