//! Lookups of the versions that aliases point to, batched: requests that arrive while a statement
//! is under way share the next one.
//!
//! No answer is older than its request: a statement begins after all requests that share it have
//! arrived. A single request is looked up at once.

use tokio::sync::oneshot;

use crate::alias_lookups::{AliasLookup, BATCH_SIZE, CurrentVersion};
use crate::arguments::{Arg, args};
use crate::checks;
use crate::connections::ReadConnection;
use crate::error::Result;
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
struct LookupRound(Store);

impl Store {
    /// Returns the version that an alias of a ship points to; none if the ship or the alias does
    /// not exist.
    pub(crate) async fn current_version(
        &self,
        ship: &str,
        alias: &str,
    ) -> Result<Option<CurrentVersion>> {
        checks::check_text("ship", ship)?;
        checks::check_text("alias", alias)?;
        // Within a unit of work the lookup must see what the unit has written.
        if self.database().unit.is_some() {
            return self.database().fetch_optional(CURRENT, args![alias: alias, ship: ship]).await;
        }
        let (answer, answered) = oneshot::channel();
        if self.lookup_queue().add_lookup(AliasLookup {
            ship: ship.to_owned(),
            alias: alias.to_owned(),
            answer,
        }) {
            tokio::spawn(LookupRound(self.clone()).run());
        }
        match answered.await {
            Ok(found) => Ok(found),
            // The shared statement failed: each of its requests is repeated alone and gets its own
            // error.
            Err(_) => {
                self.database().fetch_optional(CURRENT, args![alias: alias, ship: ship]).await
            }
        }
    }
}

impl LookupRound {
    async fn run(self) {
        let mut reader = self.0.lookup_queue().take_connection();
        loop {
            let questions = self.0.lookup_queue().take_batch();
            let Some(first) = questions.first() else {
                return self.0.lookup_queue().keep_connection(reader);
            };
            match self.fetch_answers(&mut reader, &first.alias, &questions).await {
                Ok(found) => send_answers(questions, &found),
                // The next round uses another connection; dropping the requests makes each repeat
                // alone.
                Err(_) => reader = None,
            }
        }
    }

    async fn fetch_answers(
        &self,
        reader: &mut Option<ReadConnection>,
        alias: &str,
        questions: &[AliasLookup],
    ) -> Result<Vec<CurrentVersion>> {
        // Unused places stay NULL.
        let mut values = [("ship", Arg::Text(None)); BATCH_SIZE + 1];
        values[0] = ("alias", Arg::from(alias));
        for (place, question) in values[1..].iter_mut().zip(questions) {
            place.1 = Arg::from(&question.ship);
        }
        let reader = match reader {
            Some(reader) => reader,
            None => reader.insert(self.0.database().acquire_reader().await?),
        };
        match questions.len() {
            1 => reader.fetch_all(CURRENT, &values[..2]).await,
            _ => reader.fetch_all(CURRENT_OF, &values).await,
        }
    }
}

impl Drop for LookupRound {
    /// Ends the round, also after a panic, so that no request waits for it.
    fn drop(&mut self) {
        self.0.lookup_queue().end_round();
    }
}

fn send_answers(questions: Vec<AliasLookup>, found: &[CurrentVersion]) {
    for AliasLookup { ship, answer, .. } in questions {
        // An error means that the request was dropped and needs no answer.
        let _ = answer.send(found.iter().find(|current| current.model == ship).cloned());
    }
}
