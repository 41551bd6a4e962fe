//! Templates of imports: how the columns of a form of file are read, kept by name for a ship or for
//! the whole server.

use serde_json::{Value, json};

use crate::arguments::args;
use crate::checks;
use crate::database::AuditedTransaction;
use crate::error::{Result, StoreError};
use crate::objects::sha256_hex;
use crate::record::{RowCount, record};
use crate::ships;
use crate::statements::{same, statements};
use crate::store::Store;

/// Maximum number of templates of a ship, and of the server; two that are saved at once may exceed
/// it by one.
pub const MAX_TEMPLATES: usize = 100;

statements! {
    PUT = same("INSERT INTO import_templates (ship, name, document, changed_us) VALUES ($1, $2, \
        $3, $4) ON CONFLICT (ship, name) DO UPDATE SET document = excluded.document, changed_us = \
        excluded.changed_us");
    REMOVE = same("DELETE FROM import_templates WHERE ship = $1 AND name = $2");
    GET = same("SELECT ship, name, document, changed_us FROM import_templates WHERE ship = $1 AND \
        name = $2");
    // Templates of the ship before those of the server.
    FOR_SHIP = same("SELECT ship, name, document, changed_us FROM import_templates WHERE ship = $1 \
        OR ship = '' ORDER BY ship DESC, name");
    COUNT = same("SELECT COUNT(*) AS rows FROM import_templates WHERE ship = $1");
}

record! {
    /// A template.
    pub struct ImportTemplateRow {
        /// Ship; empty for a template of the whole server.
        pub ship: String,
        /// Name, unique for the ship or the server.
        pub name: String,
        /// Readings of the columns as JSON.
        pub document: String,
        /// Time of the last change, microseconds since 1970.
        pub changed_us: i64,
    }
}

/// Repository of templates.
#[derive(Debug, Clone, Copy)]
pub struct TemplateRepository<'a>(pub(crate) &'a Store);

impl Store {
    /// Returns the repository of templates of imports.
    pub fn templates(&self) -> TemplateRepository<'_> {
        TemplateRepository(self)
    }
}

impl TemplateRepository<'_> {
    /// Returns the templates of a ship, then those of the server, by name.
    pub async fn list_for_ship(&self, ship: &str) -> Result<Vec<ImportTemplateRow>> {
        self.0.database().fetch_all(FOR_SHIP, args![ship: ship]).await
    }

    /// Keeps a template of a ship, or of the server if the ship is empty, in place of one of the
    /// same name. There may be at most [`MAX_TEMPLATES`] of each.
    pub async fn save(&self, ship: &str, name: &str, document: &str) -> Result<()> {
        checks::check_name("name", name)?;
        checks::check_json("document", document)?;
        let mut tx = self.0.begin().await?;
        // The server's templates belong to no ship that could be missing.
        if !ship.is_empty() {
            ships::find_ship(&mut tx, ship).await?;
        }
        // The audit has what was replaced, by its hash.
        let before = find_template(&mut tx, ship, name).await?;
        let now_us = self.0.now_us();
        let values = args![ship: ship, name: name, document: document, changed_us: now_us];
        tx.execute(PUT, values).await?;
        // Counted after the statement: replacing one of a hundred is no addition.
        check_count(&mut tx, ship).await?;
        let before = before.as_ref().map(|row| audit_state(&row.document));
        let after = Some(audit_state(document));
        tx.record_audit_event(now_us, "template.save", audit_subject(ship, name), before, after);
        tx.commit().await
    }

    /// Removes a template of a ship, or of the server if the ship is empty.
    pub async fn remove(&self, ship: &str, name: &str) -> Result<()> {
        let mut tx = self.0.begin().await?;
        let Some(row) = find_template(&mut tx, ship, name).await? else {
            return Err(StoreError::not_found("template", audit_subject(ship, name)));
        };
        tx.execute(REMOVE, args![ship: ship, name: name]).await?;
        let before = Some(audit_state(&row.document));
        let subject = audit_subject(ship, name);
        tx.record_audit_event(self.0.now_us(), "template.remove", subject, before, None);
        tx.commit().await
    }
}

async fn find_template(
    tx: &mut AuditedTransaction,
    ship: &str,
    name: &str,
) -> Result<Option<ImportTemplateRow>> {
    tx.fetch_optional(GET, args![ship: ship, name: name]).await
}

fn audit_subject(ship: &str, name: &str) -> String {
    format!("template:{ship}/{name}")
}

fn audit_state(document: &str) -> Value {
    json!({ "sha256": sha256_hex(document.as_bytes()) })
}

async fn check_count(tx: &mut AuditedTransaction, ship: &str) -> Result<()> {
    let count: RowCount = tx.fetch_one(COUNT, args![ship: ship]).await?;
    let owner = if ship.is_empty() { "the server" } else { ship };
    match usize::try_from(count.rows).is_ok_and(|rows| rows <= MAX_TEMPLATES) {
        true => Ok(()),
        false => Err(StoreError::conflict(
            "template",
            owner,
            format!("has {MAX_TEMPLATES} templates already, which is the limit; remove one"),
        )),
    }
}
