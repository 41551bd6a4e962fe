//! Settings that apply to all processes of a store.

use serde_json::{Value, json};

use crate::actor::Actor;
use crate::arguments::args;
use crate::checks;
use crate::database::AuditedTransaction;
use crate::error::{Result, StoreError};
use crate::record::record;
use crate::statements::{same, statements};
use crate::store::Store;

/// The alias that may need the approval of a second person.
const CHAMPION: &str = "champion";
/// Name of the setting that requires it.
const SECOND_PERSON: &str = "second-person";
/// Name of the setting with the URL of the server.
const PUBLIC_URL: &str = "public-url";

statements! {
    GET = same("SELECT value FROM settings WHERE name = $1");
    PUT = same("INSERT INTO settings (name, value, changed_us) VALUES ($1, $2, $3) \
        ON CONFLICT (name) DO UPDATE SET value = excluded.value, changed_us = excluded.changed_us");
    AUTHOR = same("SELECT author AS value FROM versions WHERE model = $1 AND number = $2");
}

record! {
    /// The value of a setting.
    pub struct SettingValue {
        /// The value.
        pub value: String,
    }
}

/// Repository of settings.
#[derive(Debug, Clone, Copy)]
pub struct StoreSettings<'a>(pub(crate) &'a Store);

impl Store {
    /// Returns the settings that apply to all processes of the store.
    pub fn settings(&self) -> StoreSettings<'_> {
        StoreSettings(self)
    }
}

impl StoreSettings<'_> {
    /// Returns true if only another person than its author may promote a version to champion.
    pub async fn requires_second_person(&self) -> Result<bool> {
        let found: Option<SettingValue> =
            self.0.database().fetch_optional(GET, args![name: SECOND_PERSON]).await?;
        Ok(is_on(found))
    }

    /// Switches the approval by a second person on or off.
    pub async fn set_second_person(&self, on: bool) -> Result<()> {
        let mut tx = self.0.begin().await?;
        let before = is_on(tx.fetch_optional(GET, args![name: SECOND_PERSON]).await?);
        let value = if on { "on" } else { "off" };
        let states = (json!({ SECOND_PERSON: before }), json!({ SECOND_PERSON: on }));
        self.put(tx, (SECOND_PERSON, value), states).await
    }

    /// Returns the URL under which people reach the server, for links in messages.
    pub async fn public_url(&self) -> Result<Option<String>> {
        let found: Option<SettingValue> =
            self.0.database().fetch_optional(GET, args![name: PUBLIC_URL]).await?;
        Ok(found.map(|found| found.value).filter(|value| !value.is_empty()))
    }

    /// Sets the URL under which people reach the server; empty for none.
    pub async fn set_public_url(&self, url: &str) -> Result<()> {
        checks::check_text("url", url)?;
        let mut tx = self.0.begin().await?;
        let before: Option<SettingValue> = tx.fetch_optional(GET, args![name: PUBLIC_URL]).await?;
        let before = before.map(|before| before.value);
        let states = (json!({ PUBLIC_URL: before }), json!({ PUBLIC_URL: url }));
        self.put(tx, (PUBLIC_URL, url), states).await
    }

    /// Writes a setting with its audit entry, and commits.
    async fn put(
        &self,
        mut tx: AuditedTransaction,
        (name, value): (&str, &str),
        (before, after): (Value, Value),
    ) -> Result<()> {
        let now = self.0.now_us();
        tx.execute(PUT, args![name: name, value: value, changed_us: now]).await?;
        let subject = "settings".to_owned();
        tx.record_audit_event(now, "settings.set", subject, Some(before), Some(after));
        tx.commit().await
    }
}

fn is_on(found: Option<SettingValue>) -> bool {
    found.is_some_and(|found| found.value == "on")
}

/// Checks a promotion: where a second person is required, authors cannot promote their own versions
/// to champion.
pub(crate) async fn check_promotion(
    tx: &mut AuditedTransaction,
    model: &str,
    alias: &str,
    number: i64,
) -> Result<()> {
    let actor = Actor::current();
    // The program promotes by its own rules, and a command on the archive's files has every right.
    if alias != CHAMPION || actor.is_program() {
        return Ok(());
    }
    if !is_on(tx.fetch_optional(GET, args![name: SECOND_PERSON]).await?) {
        return Ok(());
    }
    let author: Option<SettingValue> =
        tx.fetch_optional(AUTHOR, args![model: model, number: number]).await?;
    match author.is_some_and(|author| author.value == actor.name) {
        false => Ok(()),
        true => Err(StoreError::Forbidden {
            message: format!(
                "version {model}/{number} was made by {}, and champions need approval by a second \
                 person; ask an approver",
                actor.name
            ),
        }),
    }
}
