//! What an attack is, and what it is given.

use std::future::Future;
use std::pin::Pin;
use std::sync::Arc;
use std::time::{Duration, Instant};

use rand::SeedableRng as _;
use rand_chacha::ChaCha12Rng;

use crate::faults::Faults;
use crate::place::{Database, Place};
use crate::tally::Tally;

/// Why an attack could not go on. It counts as wrong: what should have been found was not looked
/// for.
pub type Failure = Box<dyn std::error::Error + Send + Sync>;

/// An attack under way.
pub type Running<'a> = Pin<Box<dyn Future<Output = Result<(), Failure>> + 'a>>;

/// One way to make a store fail.
pub trait Attack {
    /// Its row in the table.
    fn name(&self) -> &'static str;

    /// Its part of the time, in parts of all attacks' parts.
    fn share(&self) -> f64 {
        1.0
    }

    /// Minutes of a run from which it is part of it where no attack is named.
    fn least_minutes(&self) -> f64 {
        0.0
    }

    /// Whether its processes work on jobs, which have a memory budget of their own.
    fn works(&self) -> bool {
        false
    }

    /// Runs until the field's time is over.
    fn run<'a>(&'a self, field: &'a Field) -> Running<'a>;
}

/// What an attack is given.
pub struct Field {
    /// The kind of database.
    pub database: Database,
    /// What every random choice follows from.
    pub seed: u64,
    /// When to end.
    pub until: Instant,
    /// Where it counts.
    pub tally: Arc<Tally>,
    /// Faults for processes, where they could be built.
    pub faults: Option<Arc<Faults>>,
}

impl Field {
    /// Whether there is time left.
    pub fn goes_on(&self) -> bool {
        Instant::now() < self.until
    }

    /// The time left.
    pub fn left(&self) -> Duration {
        self.until.saturating_duration_since(Instant::now())
    }

    /// Random numbers of a stream.
    pub fn rng(&self, stream: u64) -> ChaCha12Rng {
        let mut rng = ChaCha12Rng::seed_from_u64(self.seed);
        rng.set_stream(stream);
        rng
    }

    /// An empty store.
    ///
    /// # Errors
    /// No database can be made.
    pub async fn place(&self) -> Result<Place, Failure> {
        Place::new(self.database, Arc::clone(&self.tally)).await
    }
}
