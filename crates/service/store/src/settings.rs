//! Settings that hold for every process on a store.

use serde_json::json;

use crate::actor::Actor;
use crate::arguments::args;
use crate::database::Transaction;
use crate::error::{Result, StoreError};
use crate::record::record;
use crate::statements::{same, statements};
use crate::store::Store;

/// The alias that a second person may be asked for.
const CHAMPION: &str = "champion";
/// The setting of that.
const SECOND_PERSON: &str = "second-person";

statements! {
    GET = same("SELECT value FROM settings WHERE name = $1");
    PUT = same("INSERT INTO settings (name, value, changed_us) VALUES ($1, $2, $3) \
        ON CONFLICT (name) DO UPDATE SET value = excluded.value, changed_us = excluded.changed_us");
    AUTHOR = same("SELECT author AS value FROM versions WHERE model = $1 AND number = $2 AND \
        author IS NOT NULL");
}

record! {
    /// A text.
    pub struct SettingValue {
        /// The text.
        pub value: String,
    }
}

/// The settings of a store.
#[derive(Debug, Clone, Copy)]
pub struct StoreSettings<'a>(pub(crate) &'a Store);

impl Store {
    /// Settings that hold for every process on the store.
    pub fn settings(&self) -> StoreSettings<'_> {
        StoreSettings(self)
    }
}

impl StoreSettings<'_> {
    /// Whether a version becomes champion only by the word of somebody else than who made it.
    pub async fn second_person(&self) -> Result<bool> {
        let found: Option<SettingValue> =
            self.0.database().optional(GET, args![name: SECOND_PERSON]).await?;
        Ok(is_on(found))
    }

    /// Asks for a second person, or no longer.
    pub async fn set_second_person(&self, on: bool) -> Result<()> {
        let mut tx = self.0.begin().await?;
        let before = is_on(tx.optional(GET, args![name: SECOND_PERSON]).await?);
        let value = if on { "on" } else { "off" };
        let values = args![name: SECOND_PERSON, value: value, changed_us: self.0.now_us()];
        tx.execute(PUT, values).await?;
        let (before, after) = (json!({ SECOND_PERSON: before }), json!({ SECOND_PERSON: on }));
        tx.note(self.0.now_us(), "settings.set", "settings".to_owned(), Some(before), Some(after));
        tx.commit().await
    }
}

fn is_on(found: Option<SettingValue>) -> bool {
    found.is_some_and(|found| found.value == "on")
}

/// Refuses that the present actor makes champion what it has made itself, where a second person is
/// asked for.
pub(crate) async fn check_promotion(
    tx: &mut Transaction,
    model: &str,
    alias: &str,
    number: i64,
) -> Result<()> {
    let actor = Actor::current();
    if alias != CHAMPION || actor.is_program() {
        return Ok(());
    }
    if !is_on(tx.optional(GET, args![name: SECOND_PERSON]).await?) {
        return Ok(());
    }
    let author: Option<SettingValue> =
        tx.optional(AUTHOR, args![model: model, number: number]).await?;
    match author.is_some_and(|author| author.value == actor.name) {
        false => Ok(()),
        true => Err(StoreError::Forbidden {
            message: format!(
                "version {model}/{number} was made by {}, and a second person is asked for to make \
                 it champion; let an approver do so",
                actor.name
            ),
        }),
    }
}
