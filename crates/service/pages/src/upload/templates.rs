//! Templates of readings: kept by name for a ship or the server, and offered for files of the same
//! shape.

use sistership_store::ImportTemplateRow;
use sistership_trials::{ColumnGuess, ImportTemplate};

use super::proposed::UploadProposal;
use crate::error::{PageError, Result};
use crate::form::FormFields;
use crate::language::say;

/// Prefixes of the values of the form's list: a template of the ship, or of the server.
const OF_SHIP: &str = "ship:";
const OF_SERVER: &str = "server:";

/// A template that the page offers.
pub(super) struct TemplateOffer {
    /// Value of the form's list.
    pub value: String,
    /// Name, with the word server where it belongs to that.
    pub label: String,
    /// File that has the same columns.
    pub file: Option<String>,
}

impl TemplateOffer {
    /// Returns the offers for the columns of an upload; a template that cannot be read is not
    /// offered.
    pub fn from_rows(rows: &[ImportTemplateRow], guesses: &[ColumnGuess]) -> Vec<Self> {
        let offer = |row: &ImportTemplateRow| {
            let template: ImportTemplate = serde_json::from_str(&row.document).ok()?;
            let file = template.matching_file(guesses).map(str::to_owned);
            let (prefix, label) = match row.ship.is_empty() {
                true => (OF_SERVER, say("templates-of-server").with("name", &row.name).into()),
                false => (OF_SHIP, row.name.clone()),
            };
            Some(Self { value: format!("{prefix}{}", row.name), label, file })
        };
        rows.iter().filter_map(offer).collect()
    }
}

/// A template that a form names: its ship, empty for the server, and its name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TemplatePlace {
    /// Ship; empty for the server.
    pub ship: String,
    /// Name.
    pub name: String,
}

impl TemplatePlace {
    /// Reads the template that the form's list names.
    ///
    /// # Errors
    /// Returns an error if none is chosen.
    pub fn from_list(ship: &str, fields: &FormFields) -> Result<Self> {
        let text = fields.required_text("template")?;
        let found = [(OF_SHIP, ship), (OF_SERVER, "")].into_iter().find_map(|(prefix, ship)| {
            let name = text.strip_prefix(prefix)?.to_owned();
            Some(Self { ship: ship.to_owned(), name })
        });
        found.ok_or_else(|| PageError::invalid_field("template", say("upload-choose-template")))
    }

    /// Reads the name under which a template is to be kept.
    ///
    /// # Errors
    /// Returns an error if the name is absent.
    pub fn from_name(ship: &str, fields: &FormFields) -> Result<Self> {
        let name = fields.required_text("template_name")?.to_owned();
        let on_server = fields.get_text("template_scope") == Some("server");
        Ok(Self { ship: if on_server { String::new() } else { ship.to_owned() }, name })
    }
}

impl UploadProposal {
    /// Returns the readings of the columns as a template, in JSON.
    ///
    /// # Errors
    /// No error is known: the content is plain text.
    pub fn template_document(&self, name: &str) -> Result<String> {
        Ok(serde_json::to_string(&ImportTemplate::from_guesses(name, &self.guesses))?)
    }
}
