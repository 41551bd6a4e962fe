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
const FORGOTTEN: Duration = Duration::from_secs(12);
/// Maximum number of entries of each table.
const KNOWN: usize = 4096;

/// An attempt to sign in.
#[derive(Debug, Clone, Copy)]
pub struct Attempt<'a> {
    /// Name of the user.
    pub name: &'a str,
    /// The client's address.
    pub from: &'a str,
}

/// Failed attempts by name and client, and the clients from which a name has signed in.
#[derive(Debug, Default)]
pub struct Attempts(Mutex<Tables>);

#[derive(Debug, Default)]
struct Tables {
    mistakes: HashMap<String, (f64, Instant)>,
    known: HashMap<String, Instant>,
}

impl Attempts {
    /// Counts an attempt before its password is compared.
    ///
    /// # Errors
    /// Returns the time to wait if there were too many attempts; this one is not counted then.
    pub fn begin(&self, attempt: Attempt<'_>, now: Instant) -> Result<(), Duration> {
        let mut tables = self.tables();
        let concerned = tables.concerned(attempt);
        let wait = |(whom, free): &(String, f64)| {
            let count = tables.count(whom, now);
            (count + 1.0 > *free).then(|| FORGOTTEN.mul_f64(count + 1.0 - free))
        };
        match concerned.iter().filter_map(wait).max() {
            Some(wait) => Err(wait),
            None => {
                concerned.iter().for_each(|(whom, _)| tables.add(whom, now));
                Ok(())
            }
        }
    }

    /// Removes an attempt from the counts: its password was right, or was not compared.
    pub fn withdraw(&self, attempt: Attempt<'_>, now: Instant) {
        let mut tables = self.tables();
        for (whom, _) in tables.concerned(attempt) {
            let left = tables.count(&whom, now) - 1.0;
            if let Some(mistakes) = tables.mistakes.get_mut(&whom) {
                *mistakes = (left.max(0.0), now);
            }
        }
    }

    /// Records a successful sign-in: the client becomes known for the name.
    pub fn right(&self, attempt: Attempt<'_>, now: Instant) {
        self.withdraw(attempt, now);
        let mut tables = self.tables();
        if tables.known.len() >= KNOWN {
            // A full table drops its oldest entry.
            let oldest = tables.known.iter().min_by_key(|(_, at)| **at);
            if let Some(oldest) = oldest.map(|(whom, _)| whom.clone()) {
                tables.known.remove(&oldest);
            }
        }
        tables.known.insert(pair(attempt), now);
    }

    fn tables(&self) -> MutexGuard<'_, Tables> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Tables {
    /// Returns the keys under which an attempt counts, each with its number of free failures.
    fn concerned(&self, attempt: Attempt<'_>) -> Vec<(String, f64)> {
        let pair = pair(attempt);
        if self.known.contains_key(&pair) {
            return vec![(pair, FREE)];
        }
        let (name, client) = (format!("name {}", attempt.name), format!("from {}", attempt.from));
        vec![(pair, FREE), (client, FREE_OF_CLIENT), (name, FREE_OF_NAME)]
    }

    /// Returns the number of failed attempts under a key that are not forgotten yet.
    fn count(&self, whom: &str, now: Instant) -> f64 {
        self.mistakes.get(whom).map_or(0.0, |mistakes| left(*mistakes, now))
    }

    fn add(&mut self, whom: &str, now: Instant) {
        if self.mistakes.len() >= KNOWN && !self.mistakes.contains_key(whom) {
            self.make_room(now);
        }
        let count = self.count(whom, now) + 1.0;
        self.mistakes.insert(whom.to_owned(), (count, now));
    }

    /// Removes expired entries and, if the table is still full, the one with the fewest failures.
    fn make_room(&mut self, now: Instant) {
        self.mistakes.retain(|_, mistakes| left(*mistakes, now) > 0.0);
        let fewest =
            self.mistakes.iter().min_by(|a, b| left(*a.1, now).total_cmp(&left(*b.1, now)));
        let fewest = fewest.map(|(whom, _)| whom.clone());
        if let Some(fewest) = fewest.filter(|_| self.mistakes.len() >= KNOWN) {
            self.mistakes.remove(&fewest);
        }
    }
}

fn pair(attempt: Attempt<'_>) -> String {
    format!("name {} from {}", attempt.name, attempt.from)
}

fn left((count, at): (f64, Instant), now: Instant) -> f64 {
    // Linear decay: failures are forgotten one by one at a constant rate, in fractions.
    let passed = now.saturating_duration_since(at).as_secs_f64() / FORGOTTEN.as_secs_f64();
    (count - passed).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn attempt<'a>(name: &'a str, from: &'a str) -> Attempt<'a> {
        Attempt { name, from }
    }

    #[test]
    fn mistakes_make_wait_and_are_forgotten() {
        let (attempts, start) = (Attempts::default(), Instant::now());
        let ann = attempt("ann", "a");
        assert!((0..5).all(|_| attempts.begin(ann, start).is_ok()));
        assert_eq!(attempts.begin(ann, start), Err(FORGOTTEN));
        assert_eq!(attempts.begin(attempt("bob", "a"), start), Ok(()));
        assert_eq!(attempts.begin(ann, start + FORGOTTEN), Ok(()));
        for n in 0..KNOWN / 2 {
            let name = n.to_string();
            assert!(attempts.begin(attempt(&name, &name), start).is_ok());
        }
        assert!(attempts.tables().mistakes.len() <= KNOWN);
    }

    #[test]
    fn of_many_at_a_time_five_are_compared() {
        let (attempts, now) = (Attempts::default(), Instant::now());
        let compared = std::thread::scope(|scope| {
            let one = |_| scope.spawn(|| attempts.begin(attempt("ann", "a"), now).is_ok());
            let all: Vec<_> = (0..400).map(one).collect();
            all.into_iter().filter_map(|one| one.join().ok()).filter(|begun| *begun).count()
        });
        assert_eq!(compared, 5);
    }

    #[test]
    fn a_name_is_not_shut_out_by_those_who_guess_it_elsewhere() {
        let (attempts, start) = (Attempts::default(), Instant::now());
        let mut now = start;
        for _ in 0..1000 {
            now += Duration::from_millis(12_500);
            assert!(attempts.begin(attempt("ann", "far"), now).is_ok());
            let own = attempt("ann", "own");
            assert!(attempts.begin(own, now).is_ok());
            attempts.withdraw(own, now);
        }
        // Many clients together bring a name to its limit, but not where it has signed in.
        attempts.right(attempt("ann", "home"), now);
        for n in 0..60 {
            let _ = attempts.begin(attempt("ann", &n.to_string()), now);
        }
        assert!(attempts.begin(attempt("ann", "new"), now).is_err());
        assert!(attempts.begin(attempt("ann", "home"), now).is_ok());
    }

    #[test]
    fn others_behind_an_address_are_not_shut_out_by_one_who_errs() {
        let (attempts, now) = (Attempts::default(), Instant::now());
        for _ in 0..6 {
            let _ = attempts.begin(attempt("nobody", "office"), now);
        }
        assert!(attempts.begin(attempt("ann", "office"), now).is_ok());
        attempts.right(attempt("ann", "office"), now);
        for n in 0..40 {
            let _ = attempts.begin(attempt(&n.to_string(), "office"), now);
        }
        assert!(attempts.begin(attempt("new", "office"), now).is_err());
        assert!(attempts.begin(attempt("ann", "office"), now).is_ok(), "it has signed in there");
    }
}
