//! Limits on failed sign-ins: some attempts are free, then further ones must wait. A password is
//! short enough to be guessed, so that, unlike with keys, the right one waits too.
//!
//! Failures are counted for a name from a client, for a client with any name, and for a name from
//! any client. A client from which a name has signed in before is only limited by the first of
//! these: neither guesses of the name elsewhere nor guesses of other names from the same client
//! lock a person out. An attempt is counted before its password is compared, so that parallel
//! attempts cannot exceed the limit.

use std::collections::HashMap;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Free failed attempts for a name from a client.
const FREE: f64 = 5.0;
/// Free failed attempts for a client with any name: an office has more than one person who
/// mistypes.
const FREE_OF_CLIENT: f64 = 20.0;
/// Free failed attempts for a name from any client: the number that many clients may guess
/// together.
const FREE_OF_NAME: f64 = 50.0;
/// Time after which one failed attempt is forgotten.
const FORGET_AFTER: Duration = Duration::from_secs(12);
/// Maximum number of entries of each table.
const MAX_ENTRIES: usize = 4096;

/// An attempt to sign in.
#[derive(Debug, Clone, Copy)]
pub struct SignInAttempt<'a> {
    /// Name of the user.
    pub name: &'a str,
    /// The client's address.
    pub from: &'a str,
}

/// Failed attempts by name and client, and the clients from which a name has signed in.
#[derive(Debug, Default)]
pub struct FailedAttempts(Mutex<AttemptTables>);

#[derive(Debug, Default)]
struct AttemptTables {
    mistakes: HashMap<String, (f64, Instant)>,
    known: HashMap<String, Instant>,
}

impl FailedAttempts {
    /// Counts an attempt before its password is compared.
    ///
    /// # Errors
    /// Returns the time to wait if there were too many attempts; this one is not counted then.
    pub fn begin_attempt(&self, attempt: SignInAttempt<'_>, now: Instant) -> Result<(), Duration> {
        let mut tables = self.lock_tables();
        let concerned = tables.attempt_keys(attempt);
        let wait = |(whom, free): &(String, f64)| {
            let count = tables.failure_count(whom, now);
            (count + 1.0 > *free).then(|| FORGET_AFTER.mul_f64(count + 1.0 - free))
        };
        match concerned.iter().filter_map(wait).max() {
            Some(wait) => Err(wait),
            None => {
                concerned.iter().for_each(|(whom, _)| tables.add_failure(whom, now));
                Ok(())
            }
        }
    }

    /// Removes an attempt from the counts: its password was right, or was not compared.
    pub fn withdraw_attempt(&self, attempt: SignInAttempt<'_>, now: Instant) {
        let mut tables = self.lock_tables();
        for (whom, _) in tables.attempt_keys(attempt) {
            let left = tables.failure_count(&whom, now) - 1.0;
            if let Some(mistakes) = tables.mistakes.get_mut(&whom) {
                *mistakes = (left.max(0.0), now);
            }
        }
    }

    /// Records a successful sign-in: the client becomes known for the name.
    pub fn record_success(&self, attempt: SignInAttempt<'_>, now: Instant) {
        self.withdraw_attempt(attempt, now);
        let mut tables = self.lock_tables();
        if tables.known.len() >= MAX_ENTRIES {
            // A full table drops its oldest entry.
            let oldest = tables.known.iter().min_by_key(|(_, at)| **at);
            if let Some(oldest) = oldest.map(|(whom, _)| whom.clone()) {
                tables.known.remove(&oldest);
            }
        }
        tables.known.insert(pair_key(attempt), now);
    }

    /// Returns true if the name has signed in from the client before.
    pub fn is_known(&self, attempt: SignInAttempt<'_>) -> bool {
        self.lock_tables().known.contains_key(&pair_key(attempt))
    }

    fn lock_tables(&self) -> MutexGuard<'_, AttemptTables> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl AttemptTables {
    /// Returns the keys under which an attempt counts, each with its number of free failures.
    fn attempt_keys(&self, attempt: SignInAttempt<'_>) -> Vec<(String, f64)> {
        let pair = pair_key(attempt);
        if self.known.contains_key(&pair) {
            return vec![(pair, FREE)];
        }
        let (name, client) = (format!("name {}", attempt.name), format!("from {}", attempt.from));
        vec![(pair, FREE), (client, FREE_OF_CLIENT), (name, FREE_OF_NAME)]
    }

    /// Returns the number of failed attempts under a key that are not forgotten yet.
    fn failure_count(&self, whom: &str, now: Instant) -> f64 {
        self.mistakes.get(whom).map_or(0.0, |mistakes| remaining_failures(*mistakes, now))
    }

    fn add_failure(&mut self, whom: &str, now: Instant) {
        if self.mistakes.len() >= MAX_ENTRIES && !self.mistakes.contains_key(whom) {
            self.evict_entry(now);
        }
        let count = self.failure_count(whom, now) + 1.0;
        self.mistakes.insert(whom.to_owned(), (count, now));
    }

    /// Removes expired entries and, if the table is still full, the one with the fewest failures.
    fn evict_entry(&mut self, now: Instant) {
        self.mistakes.retain(|_, mistakes| remaining_failures(*mistakes, now) > 0.0);
        let fewest = self
            .mistakes
            .iter()
            .min_by(|a, b| remaining_failures(*a.1, now).total_cmp(&remaining_failures(*b.1, now)));
        let fewest = fewest.map(|(whom, _)| whom.clone());
        if let Some(fewest) = fewest.filter(|_| self.mistakes.len() >= MAX_ENTRIES) {
            self.mistakes.remove(&fewest);
        }
    }
}

fn pair_key(attempt: SignInAttempt<'_>) -> String {
    format!("name {} from {}", attempt.name, attempt.from)
}

fn remaining_failures((count, at): (f64, Instant), now: Instant) -> f64 {
    // Linear decay: failures are forgotten one by one at a constant rate, in fractions.
    let passed = now.saturating_duration_since(at).as_secs_f64() / FORGET_AFTER.as_secs_f64();
    (count - passed).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn attempt<'a>(name: &'a str, from: &'a str) -> SignInAttempt<'a> {
        SignInAttempt { name, from }
    }

    #[test]
    fn mistakes_make_wait_and_are_forgotten() {
        let (attempts, start) = (FailedAttempts::default(), Instant::now());
        let ann = attempt("ann", "a");
        assert!((0..5).all(|_| attempts.begin_attempt(ann, start).is_ok()));
        assert_eq!(attempts.begin_attempt(ann, start), Err(FORGET_AFTER));
        assert_eq!(attempts.begin_attempt(attempt("bob", "a"), start), Ok(()));
        assert_eq!(attempts.begin_attempt(ann, start + FORGET_AFTER), Ok(()));
        for n in 0..MAX_ENTRIES / 2 {
            let name = n.to_string();
            assert!(attempts.begin_attempt(attempt(&name, &name), start).is_ok());
        }
        assert!(attempts.lock_tables().mistakes.len() <= MAX_ENTRIES);
    }

    #[test]
    fn of_many_at_a_time_five_are_compared() {
        let (attempts, now) = (FailedAttempts::default(), Instant::now());
        let compared = std::thread::scope(|scope| {
            let one = |_| scope.spawn(|| attempts.begin_attempt(attempt("ann", "a"), now).is_ok());
            let all: Vec<_> = (0..400).map(one).collect();
            all.into_iter().filter_map(|one| one.join().ok()).filter(|begun| *begun).count()
        });
        assert_eq!(compared, 5);
    }

    #[test]
    fn a_name_is_not_shut_out_by_those_who_guess_it_elsewhere() {
        let (attempts, start) = (FailedAttempts::default(), Instant::now());
        let mut now = start;
        for _ in 0..1000 {
            now += Duration::from_millis(12_500);
            assert!(attempts.begin_attempt(attempt("ann", "far"), now).is_ok());
            let own = attempt("ann", "own");
            assert!(attempts.begin_attempt(own, now).is_ok());
            attempts.withdraw_attempt(own, now);
        }
        // Many clients together bring a name to its limit, but not where it has signed in.
        attempts.record_success(attempt("ann", "home"), now);
        for n in 0..60 {
            let _ = attempts.begin_attempt(attempt("ann", &n.to_string()), now);
        }
        assert!(attempts.begin_attempt(attempt("ann", "new"), now).is_err());
        assert!(attempts.begin_attempt(attempt("ann", "home"), now).is_ok());
    }

    #[test]
    fn others_behind_an_address_are_not_shut_out_by_one_who_errs() {
        let (attempts, now) = (FailedAttempts::default(), Instant::now());
        for _ in 0..6 {
            let _ = attempts.begin_attempt(attempt("nobody", "office"), now);
        }
        assert!(attempts.begin_attempt(attempt("ann", "office"), now).is_ok());
        attempts.record_success(attempt("ann", "office"), now);
        for n in 0..40 {
            let _ = attempts.begin_attempt(attempt(&n.to_string(), "office"), now);
        }
        assert!(attempts.begin_attempt(attempt("new", "office"), now).is_err());
        assert!(
            attempts.begin_attempt(attempt("ann", "office"), now).is_ok(),
            "it has signed in there"
        );
    }
}
