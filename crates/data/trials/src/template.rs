//! Templates of imports: the readings of the columns of a form of file, kept by name.

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};
use sistership_columns::{GivenColumn, Role};

use crate::guess::ColumnGuess;

/// Readings of the columns of a form of file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ImportTemplate {
    kind: TemplateKind,
    /// Name by which it is used.
    pub name: String,
    columns: Vec<TemplateColumn>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
enum TemplateKind {
    #[serde(rename = "import template")]
    ImportTemplate,
}

/// Reading of a column.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct TemplateColumn {
    /// Header; `#3` for the third column of a file without a header.
    column: String,
    /// Channel; absent for a column that is not read.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    channel: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    unit: Option<String>,
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    reversed: bool,
}

impl ImportTemplate {
    /// Makes a template of the readings of an import, each header once.
    pub fn from_guesses(name: &str, guesses: &[ColumnGuess]) -> Self {
        // Files of one set repeat their headers.
        let mut known = BTreeSet::new();
        let first = guesses.iter().filter(|guess| known.insert(&guess.column));
        let columns = first.map(|guess| TemplateColumn {
            column: guess.column.clone(),
            channel: guess.channel.clone(),
            unit: guess.unit.clone(),
            reversed: guess.reversed,
        });
        let columns = columns.collect();
        Self { kind: TemplateKind::ImportTemplate, name: name.to_owned(), columns }
    }

    /// Returns its readings as those that a user gives.
    ///
    /// # Errors
    /// Returns a message that names the column whose channel is not known.
    pub fn given_columns(&self) -> Result<Vec<GivenColumn>, String> {
        let given = |one: &TemplateColumn| {
            let role = match one.channel.as_deref() {
                None => None,
                Some(name) => Some(Role::from_name(name).ok_or_else(|| {
                    let (template, column) = (&self.name, &one.column);
                    format!(
                        "template `{template}`, column `{column}`: `{name}` is not a channel; \
                         correct the column and keep the template again"
                    )
                })?),
            };
            Ok(GivenColumn {
                header: one.column.clone(),
                role,
                unit: one.unit.clone(),
                is_reversed: Some(one.reversed),
            })
        };
        self.columns.iter().map(given).collect()
    }

    /// Returns the first file whose columns are those of the template, and no others.
    pub fn matching_file<'a>(&self, guesses: &'a [ColumnGuess]) -> Option<&'a str> {
        let own: BTreeSet<&str> = self.columns.iter().map(|one| one.column.as_str()).collect();
        let columns_of = |file: &str| -> BTreeSet<&str> {
            let of_file = guesses.iter().filter(|guess| guess.file == file);
            of_file.map(|guess| guess.column.as_str()).collect()
        };
        // The order of the columns is left to the logger: names decide.
        let files: BTreeSet<&str> = guesses.iter().map(|guess| guess.file.as_str()).collect();
        files.into_iter().find(|file| columns_of(file) == own)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn guess(column: &str, channel: Option<&str>, reversed: bool) -> ColumnGuess {
        ColumnGuess {
            file: "a.csv".into(),
            column: column.into(),
            channel: channel.map(Into::into),
            unit: channel.map(|_| "deg".into()),
            reversed,
            probability: 1.0,
            why: String::new(),
            certain: true,
            question: None,
        }
    }

    #[test]
    fn a_template_gives_the_columns_of_a_file_with_the_same_header() {
        let guesses = [guess("Azi", Some("delta"), true), guess("note", None, false)];
        let template = ImportTemplate::from_guesses("yard-x", &guesses);
        let given = template.given_columns().unwrap();
        assert_eq!(given[0].role, Some(Role::Delta));
        assert_eq!((given[0].is_reversed, given[1].role), (Some(true), None));
        assert_eq!(template.matching_file(&guesses), Some("a.csv"));
        assert_eq!(template.matching_file(&guesses[..1]), None);
    }

    #[test]
    fn a_channel_that_is_not_known_is_named_with_its_column() {
        let template = ImportTemplate::from_guesses("yard-x", &[guess("Azi", Some("q"), false)]);
        let refused = template.given_columns().unwrap_err();
        assert!(refused.contains("column `Azi`: `q` is not a channel"), "{refused}");
    }
}
