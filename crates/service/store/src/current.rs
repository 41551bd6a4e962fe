//! What aliases stand for, asked by many at once: those who come while others are being answered
//! share the next statement.
//!
//! Nobody gets an answer that is older than the question: a statement begins after all have come
//! who share it. Alone, one is asked for at once.

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
    CURRENT_OF = current!("IN ($2, $3, $4, $5, $6, $7, $8, $9, $10, $11, $12, $13, $14, $15, $16, \
        $17)");
}

/// Somebody who asks as long as questions wait.
struct QuestionRound(Store);

impl Store {
    /// The version that an alias of a ship stands for; none where ship or alias are not there.
    pub(crate) async fn current(&self, ship: &str, alias: &str) -> Result<Option<CurrentVersion>> {
        checks::text("ship", ship)?;
        checks::text("alias", alias)?;
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
            // Those who shared a statement that failed ask for themselves: each has a reason of
            // their own to tell.
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
                // With another connection next time.
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
    /// However it ends, nobody waits for a round that is no more.
    fn drop(&mut self) {
        self.0.questions().ended();
    }
}

fn tell(questions: Vec<Question>, found: &[CurrentVersion]) {
    for Question { ship, answer, .. } in questions {
        // Who does not wait any more needs no answer.
        let _ = answer.send(found.iter().find(|current| current.model == ship).cloned());
    }
}
