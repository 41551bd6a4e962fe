//! What aliases stand for, asked by many at once: those who come while others are being answered share the next statement.
//!
//! Nobody gets an answer that is older than the question: a statement begins after all have come who share it. Alone, one is
//! asked for at once.

use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use tokio::sync::oneshot;

use crate::arguments::{Arg, args};
use crate::checks;
use crate::connect::RESTED;
use crate::database::Reader;
use crate::error::Result;
use crate::record::record;
use crate::statements::{same, statements};
use crate::store::Store;

/// The most ships that one statement asks for: as many as it has places.
const AT_ONCE: usize = 16;
/// Statements under way at a time. With more of them each would have fewer to answer.
const ROUNDS: usize = 2;

/// One text for one ship and for many.
macro_rules! current {
    ($which:literal) => {
        same(concat!(
            "SELECT a.model, a.version_number AS number, v.id, \
            (SELECT r.id FROM reports r WHERE r.version_id = v.id ORDER BY r.id DESC LIMIT 1) AS report FROM aliases a \
            JOIN ships s ON s.name = a.model JOIN versions v ON v.model = a.model AND v.number = a.version_number \
            WHERE a.alias = $1 AND s.deleted_us IS NULL AND a.model ",
            $which
        ))
    };
}

statements! {
    CURRENT = current!("= $2");
    CURRENT_OF = current!("IN ($2, $3, $4, $5, $6, $7, $8, $9, $10, $11, $12, $13, $14, $15, $16, $17)");
}

record! {
    /// The version that an alias of a ship stands for; [`crate::Versions::by_id`] has the rest of it, which never changes.
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
pub(crate) struct Questions(Mutex<Open>);

#[derive(Default)]
struct Open {
    waiting: Vec<Question>,
    rounds: usize,
    /// Connections of rounds that have ended, and when: the next goes on with one, which a pool would have asked twice whether it
    /// is still there.
    kept: Vec<(Reader, Instant)>,
    /// Nothing is kept any more.
    closed: bool,
}

struct Question {
    ship: String,
    alias: String,
    answer: oneshot::Sender<Option<CurrentVersion>>,
}

/// Somebody who asks as long as questions wait.
struct Round(Store);

impl Store {
    /// The version that an alias of a ship stands for; none where ship or alias are not there.
    pub(crate) async fn current(&self, ship: &str, alias: &str) -> Result<Option<CurrentVersion>> {
        checks::text("ship", ship)?;
        checks::text("alias", alias)?;
        if self.database().unit.is_some() {
            return self.database().optional(CURRENT, args![alias: alias, ship: ship]).await;
        }
        let (answer, answered) = oneshot::channel();
        if self.questions().enter(Question { ship: ship.to_owned(), alias: alias.to_owned(), answer }) {
            tokio::spawn(Round(self.clone()).run());
        }
        match answered.await {
            Ok(found) => Ok(found),
            // Those who shared a statement that failed ask for themselves: each has a reason of their own to tell.
            Err(_) => self.database().optional(CURRENT, args![alias: alias, ship: ship]).await,
        }
    }
}

impl Questions {
    fn open(&self) -> MutexGuard<'_, Open> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Whether a further round is to begin.
    fn enter(&self, question: Question) -> bool {
        let mut open = self.open();
        open.waiting.push(question);
        let begins = open.rounds < ROUNDS;
        open.rounds += usize::from(begins);
        begins
    }

    /// A connection that was used a moment ago, if there is one; what has rested longer goes back to its pool.
    fn kept(&self) -> Option<Reader> {
        let kept = &mut self.open().kept;
        kept.retain(|(_, since)| since.elapsed() < RESTED);
        kept.pop().map(|(reader, _)| reader)
    }

    /// SQLite's goes back at once: it is given out again without a question, and may be the only one.
    fn keep(&self, reader: Option<Reader>) {
        let mut open = self.open();
        let reader = reader.filter(|reader| matches!(reader, Reader::Postgres(_)) && !open.closed);
        open.kept.extend(reader.map(|reader| (reader, Instant::now())));
    }

    /// Gives connections back to their pool, which ends only then, also those of rounds that still end.
    pub(crate) fn close(&self) {
        let mut open = self.open();
        open.closed = true;
        open.kept.clear();
    }

    /// The questions of one alias that wait the longest.
    fn take(&self) -> Vec<Question> {
        let waiting = &mut self.open().waiting;
        let Some(alias) = waiting.first().map(|first| first.alias.clone()) else { return Vec::new() };
        waiting.extract_if(.., |question| question.alias == alias).take(AT_ONCE).collect()
    }
}

impl Round {
    async fn run(self) {
        let mut reader = self.0.questions().kept();
        loop {
            let questions = self.0.questions().take();
            let Some(first) = questions.first() else { return self.0.questions().keep(reader) };
            match self.ask(&mut reader, &first.alias, &questions).await {
                Ok(found) => tell(questions, &found),
                // With another connection next time.
                Err(_) => reader = None,
            }
        }
    }

    async fn ask(&self, reader: &mut Option<Reader>, alias: &str, questions: &[Question]) -> Result<Vec<CurrentVersion>> {
        let mut values = [("ship", Arg::Text(None)); AT_ONCE + 1];
        values[0] = ("alias", Arg::from(alias));
        for (place, question) in values[1..].iter_mut().zip(questions) {
            place.1 = Arg::from(&question.ship);
        }
        let reader = match reader {
            Some(reader) => reader,
            None => reader.insert(self.0.database().reader().await?),
        };
        match questions.len() {
            1 => reader.all(CURRENT, &values[..2]).await,
            _ => reader.all(CURRENT_OF, &values).await,
        }
    }
}

impl Drop for Round {
    /// However it ends, nobody waits for a round that is no more.
    fn drop(&mut self) {
        let mut open = self.0.questions().open();
        open.rounds -= 1;
        if open.rounds == 0 {
            open.waiting.clear();
        }
    }
}

fn tell(questions: Vec<Question>, found: &[CurrentVersion]) {
    for Question { ship, answer, .. } in questions {
        // Who does not wait any more needs no answer.
        let _ = answer.send(found.iter().find(|current| current.model == ship).cloned());
    }
}
