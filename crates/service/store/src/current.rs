//! Lookups of the versions that aliases point to, batched: requests that arrive while a statement
//! is under way share the next one.
//!
//! No answer is older than its request: a statement begins after all requests that share it have
//! arrived. A single request is looked up at once.

use tokio::sync::oneshot;

use crate::arguments::{Arg, args};
use crate::checks;
use crate::connections::Reader;
use crate::error::Result;
use crate::questions::{AT_ONCE, CurrentVersion, Question};
use crate::statements::{same, statements};
use crate::store::Store;

/// One text for one ship and for many.
macro_rules! current {
    ($which:literal) => {
        same(concat!(
            "SELECT a.model, a.version_number AS number, v.id, \
            (SELECT r.id FROM reports r WHERE r.version_id = v.id ORDER BY r.id DESC LIMIT 1) AS \
            report FROM aliases a JOIN ships s ON s.name = a.model JOIN versions v ON v.model = \
            a.model AND v.number = a.version_number WHERE a.alias = $1 AND s.deleted_us IS NULL \
            AND a.model ",
            $which
        ))
    };
}

statements! {
    CURRENT = current!("= $2");
    // Sixteen placeholders, the size of a batch; those that are not used are NULL and match
    // nothing.
    CURRENT_OF = current!("IN ($2, $3, $4, $5, $6, $7, $8, $9, $10, $11, $12, $13, $14, $15, $16, \
        $17)");
}

/// A task that looks up requests as long as some wait.
struct QuestionRound(Store);

impl Store {
    /// Returns the version that an alias of a ship points to; none if the ship or the alias does
    /// not exist.
    pub(crate) async fn current(&self, ship: &str, alias: &str) -> Result<Option<CurrentVersion>> {
        checks::text("ship", ship)?;
        checks::text("alias", alias)?;
        // Within a unit of work the lookup must see what the unit has written.
        if self.database().unit.is_some() {
            return self.database().optional(CURRENT, args![alias: alias, ship: ship]).await;
        }
        let (answer, answered) = oneshot::channel();
        if self.questions().enter(Question {
            ship: ship.to_owned(),
            alias: alias.to_owned(),
            answer,
        }) {
            tokio::spawn(QuestionRound(self.clone()).run());
        }
        match answered.await {
            Ok(found) => Ok(found),
            // The shared statement failed: each of its requests is repeated alone and gets its own
            // error.
            Err(_) => self.database().optional(CURRENT, args![alias: alias, ship: ship]).await,
        }
    }
}

impl QuestionRound {
    async fn run(self) {
        let mut reader = self.0.questions().kept();
        loop {
            let questions = self.0.questions().take();
            let Some(first) = questions.first() else { return self.0.questions().keep(reader) };
            match self.ask(&mut reader, &first.alias, &questions).await {
                Ok(found) => tell(questions, &found),
                // The next round uses another connection; dropping the requests makes each repeat
                // alone.
                Err(_) => reader = None,
            }
        }
    }

    async fn ask(
        &self,
        reader: &mut Option<Reader>,
        alias: &str,
        questions: &[Question],
    ) -> Result<Vec<CurrentVersion>> {
        // Unused places stay NULL.
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

impl Drop for QuestionRound {
    /// Ends the round, also after a panic, so that no request waits for it.
    fn drop(&mut self) {
        self.0.questions().ended();
    }
}

fn tell(questions: Vec<Question>, found: &[CurrentVersion]) {
    for Question { ship, answer, .. } in questions {
        // An error means that the request was dropped and needs no answer.
        let _ = answer.send(found.iter().find(|current| current.model == ship).cloned());
    }
}
