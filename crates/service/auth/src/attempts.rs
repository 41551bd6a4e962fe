//! Wrong passwords of late: some are free, then further attempts wait. A password is short enough
//! to be guessed, so that, unlike with keys, the right one waits too.
//!
//! They are counted for a name from a client, for a client whatever the name, and for a name
//! wherever they come from. Who signs in from a client from which that name has signed in before is
//! held to the first of these only: neither those who guess the name elsewhere nor those who guess
//! other names from the same place shut a person out. An attempt counts from before it is compared,
//! so that of many at a time no more are compared than are free.

use std::collections::HashMap;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Mistakes that are free for a name from a client.
const FREE: f64 = 5.0;
/// The same for a client whatever the name: an office has more than one person who mistypes.
const FREE_OF_CLIENT: f64 = 20.0;
/// The same for a name wherever they come from: what many clients may guess together.
const FREE_OF_NAME: f64 = 50.0;
/// The time after which one mistake is forgotten.
const FORGOTTEN: Duration = Duration::from_secs(12);
/// Names and clients that are remembered.
const KNOWN: usize = 4096;

/// Who tries to sign in, and from where.
#[derive(Debug, Clone, Copy)]
pub struct Attempt<'a> {
    /// The name.
    pub name: &'a str,
    /// The client's address.
    pub from: &'a str,
}

/// Mistakes by whom they concern, and clients from which a name has signed in.
#[derive(Debug, Default)]
pub struct Attempts(Mutex<Tables>);

#[derive(Debug, Default)]
struct Tables {
    mistakes: HashMap<String, (f64, Instant)>,
    known: HashMap<String, Instant>,
}

impl Attempts {
    /// Counts an attempt that is about to be compared.
    ///
    /// # Errors
    /// How long it must wait; it is not counted then.
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

    /// The attempt was no mistake, or was not compared after all.
    pub fn withdraw(&self, attempt: Attempt<'_>, now: Instant) {
        let mut tables = self.tables();
        for (whom, _) in tables.concerned(attempt) {
            let left = tables.count(&whom, now) - 1.0;
            if let Some(mistakes) = tables.mistakes.get_mut(&whom) {
                *mistakes = (left.max(0.0), now);
            }
        }
    }

    /// The password was right: the client is one from which the name signs in.
    pub fn right(&self, attempt: Attempt<'_>, now: Instant) {
        self.withdraw(attempt, now);
        let mut tables = self.tables();
        if tables.known.len() >= KNOWN {
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
    /// Whom an attempt concerns, and how many mistakes are free for each.
    fn concerned(&self, attempt: Attempt<'_>) -> Vec<(String, f64)> {
        let pair = pair(attempt);
        if self.known.contains_key(&pair) {
            return vec![(pair, FREE)];
        }
        let (name, client) = (format!("name {}", attempt.name), format!("from {}", attempt.from));
        vec![(pair, FREE), (client, FREE_OF_CLIENT), (name, FREE_OF_NAME)]
    }

    /// The mistakes that are not forgotten yet.
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

    /// Forgets what is forgotten anyway, and whoever has the fewest mistakes.
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
