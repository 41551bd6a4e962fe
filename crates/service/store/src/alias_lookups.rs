//! Queue of lookups of aliases that wait for the statement that answers them.

use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use tokio::sync::oneshot;

use crate::connections::{IDLE_BEFORE_PING, ReadConnection};
use crate::record::record;

/// Maximum number of ships of one statement: the number of its placeholders.
pub(crate) const BATCH_SIZE: usize = 16;
/// Maximum number of concurrent statements; with more of them, each would answer fewer lookups.
const MAX_ROUNDS: usize = 2;

record! {
    /// The version that an alias of a ship points to; [`crate::Versions::by_id`] has its other
    /// fields, which never change.
    pub struct CurrentVersion {
        /// The model (the ship's name).
        pub model: String,
        /// Number of the version: 1, 2, 3, ... within the model.
        pub number: i64,
        /// Its id.
        pub id: String,
        /// The id of the newest report on it.
        pub report: Option<String>,
    }
}

/// The lookups of one process.
#[derive(Default)]
pub(crate) struct LookupQueue(Mutex<LookupState>);

#[derive(Default)]
struct LookupState {
    waiting: Vec<AliasLookup>,
    rounds: usize,
    /// Connections of rounds that have ended, with the time: the next round reuses one, as a pool
    /// would ping it first.
    kept: Vec<(ReadConnection, Instant)>,
    /// True once the store closes: no connection is kept any more.
    closed: bool,
}

/// A lookup that waits, and the channel of its answer.
pub(crate) struct AliasLookup {
    pub(crate) ship: String,
    pub(crate) alias: String,
    pub(crate) answer: oneshot::Sender<Option<CurrentVersion>>,
}

impl LookupQueue {
    fn lock_state(&self) -> MutexGuard<'_, LookupState> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Adds a lookup; returns true if the caller must start a further round.
    pub(crate) fn add_lookup(&self, question: AliasLookup) -> bool {
        let mut open = self.lock_state();
        open.waiting.push(question);
        // A round in progress takes the lookup with its next statement.
        let begins = open.rounds < MAX_ROUNDS;
        open.rounds += usize::from(begins);
        begins
    }

    /// Takes a recently used connection, if there is one; connections idle for longer return to
    /// their pool.
    pub(crate) fn take_connection(&self) -> Option<ReadConnection> {
        let kept = &mut self.lock_state().kept;
        kept.retain(|(_, since)| since.elapsed() < IDLE_BEFORE_PING);
        kept.pop().map(|(reader, _)| reader)
    }

    /// Keeps a connection for the next round. One of SQLite returns to its pool at once: the pool
    /// does not ping it, and it may be the only one.
    pub(crate) fn keep_connection(&self, reader: Option<ReadConnection>) {
        let mut open = self.lock_state();
        let reader =
            reader.filter(|reader| matches!(reader, ReadConnection::Postgres(..)) && !open.closed);
        open.kept.extend(reader.map(|reader| (reader, Instant::now())));
    }

    /// Returns all connections to their pool, which closes only after that; rounds in progress keep
    /// none afterwards.
    pub(crate) fn close(&self) {
        let mut open = self.lock_state();
        open.closed = true;
        open.kept.clear();
    }

    /// Takes the lookups of one alias that have waited longest.
    pub(crate) fn take_batch(&self) -> Vec<AliasLookup> {
        let waiting = &mut self.lock_state().waiting;
        let Some(alias) = waiting.first().map(|first| first.alias.clone()) else {
            return Vec::new();
        };
        // One statement has one alias; lookups of others keep their place.
        waiting.extract_if(.., |question| question.alias == alias).take(BATCH_SIZE).collect()
    }

    /// Ends a round. After the last round the waiting lookups are dropped, so that none waits for a
    /// round that does not exist.
    pub(crate) fn end_round(&self) {
        let mut open = self.lock_state();
        open.rounds -= 1;
        if open.rounds == 0 {
            open.waiting.clear();
        }
    }
}
