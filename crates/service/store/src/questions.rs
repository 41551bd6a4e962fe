//! Questions for what aliases stand for, waiting for the statement that answers them.

use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use tokio::sync::oneshot;

use crate::connections::{RESTED, Reader};
use crate::record::record;

/// The most ships that one statement asks for: as many as it has places.
pub(crate) const AT_ONCE: usize = 16;
/// Statements under way at a time. With more of them each would have fewer to answer.
const ROUNDS: usize = 2;

record! {
    /// The version that an alias of a ship stands for; [`crate::Versions::by_id`] has the rest of
    /// it, which never changes.
    pub struct CurrentVersion {
        /// The model (the ship's name).
        pub model: String,
        /// 1, 2, 3, ... within the model.
        pub number: i64,
        /// Its id.
        pub id: String,
        /// The id of the newest report on it.
        pub report: Option<String>,
    }
}

/// The questions of one process.
#[derive(Default)]
pub(crate) struct Questions(Mutex<OpenQuestions>);

#[derive(Default)]
struct OpenQuestions {
    waiting: Vec<Question>,
    rounds: usize,
    /// Connections of rounds that have ended, and when: the next goes on with one, which a pool
    /// would have asked twice whether it is still there.
    kept: Vec<(Reader, Instant)>,
    /// Nothing is kept any more.
    closed: bool,
}

/// Who asks for what.
pub(crate) struct Question {
    pub(crate) ship: String,
    pub(crate) alias: String,
    pub(crate) answer: oneshot::Sender<Option<CurrentVersion>>,
}

impl Questions {
    fn open(&self) -> MutexGuard<'_, OpenQuestions> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Whether a further round is to begin.
    pub(crate) fn enter(&self, question: Question) -> bool {
        let mut open = self.open();
        open.waiting.push(question);
        let begins = open.rounds < ROUNDS;
        open.rounds += usize::from(begins);
        begins
    }

    /// A connection that was used a moment ago, if there is one; what has rested longer goes back
    /// to its pool.
    pub(crate) fn kept(&self) -> Option<Reader> {
        let kept = &mut self.open().kept;
        kept.retain(|(_, since)| since.elapsed() < RESTED);
        kept.pop().map(|(reader, _)| reader)
    }

    /// SQLite's goes back at once: it is given out again without a question, and may be the only
    /// one.
    pub(crate) fn keep(&self, reader: Option<Reader>) {
        let mut open = self.open();
        let reader = reader.filter(|reader| matches!(reader, Reader::Postgres(..)) && !open.closed);
        open.kept.extend(reader.map(|reader| (reader, Instant::now())));
    }

    /// Gives connections back to their pool, which ends only then, also those of rounds that still
    /// end.
    pub(crate) fn close(&self) {
        let mut open = self.open();
        open.closed = true;
        open.kept.clear();
    }

    /// The questions of one alias that wait the longest.
    pub(crate) fn take(&self) -> Vec<Question> {
        let waiting = &mut self.open().waiting;
        let Some(alias) = waiting.first().map(|first| first.alias.clone()) else {
            return Vec::new();
        };
        waiting.extract_if(.., |question| question.alias == alias).take(AT_ONCE).collect()
    }

    /// Tells that a round has ended: nobody waits for a round that is no more.
    pub(crate) fn ended(&self) {
        let mut open = self.open();
        open.rounds -= 1;
        if open.rounds == 0 {
            open.waiting.clear();
        }
    }
}
