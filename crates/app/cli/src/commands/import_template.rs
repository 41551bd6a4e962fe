//! Templates of imports: the readings of the columns of a form of file, kept by name for each user.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use sistership_trials::{ColumnGuess, GivenColumn, Role};

use crate::failure::{Failure, about_file};
use crate::zoo::read_text_file;

/// Readings of the columns of a form of file.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ImportTemplate {
    kind: TemplateKind,
    /// Name by which it is used.
    name: String,
    columns: Vec<TemplateColumn>,
}

#[derive(Debug, PartialEq, Serialize, Deserialize)]
enum TemplateKind {
    #[serde(rename = "import template")]
    ImportTemplate,
}

/// Reading of a column.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
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
    pub(super) fn from_guesses(name: &str, guesses: &[ColumnGuess]) -> Self {
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
    /// Returns an error that names the column whose channel is not known.
    pub(super) fn given_columns(&self) -> Result<Vec<GivenColumn>, Failure> {
        let given = |one: &TemplateColumn| {
            let role = match one.channel.as_deref() {
                None => None,
                Some(name) => Some(Role::from_name(name).ok_or_else(|| {
                    let TemplateColumn { column, .. } = one;
                    let file = format!("template `{}`, column `{column}`", self.name);
                    Failure::Refused(format!("{file}: `{name}` is not a channel"))
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

    /// Returns true if a file has these columns and no others.
    fn fits_columns(&self, columns: &BTreeSet<&str>) -> bool {
        let own: BTreeSet<&str> = self.columns.iter().map(|one| one.column.as_str()).collect();
        own == *columns
    }
}

/// Folder of the templates of a user.
pub(super) struct TemplateFolder(PathBuf);

impl TemplateFolder {
    /// Returns the folder: `SISTERSHIP_TEMPLATES`, or `sistership/templates` in the user's folder of
    /// settings.
    ///
    /// # Errors
    /// Returns an error if the system names no such folder.
    pub(super) fn of_user() -> Result<Self, Failure> {
        let set = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty());
        if let Some(folder) = set("SISTERSHIP_TEMPLATES") {
            return Ok(Self(folder.into()));
        }
        let settings = set("XDG_CONFIG_HOME")
            .or_else(|| set("APPDATA"))
            .map(PathBuf::from)
            .or_else(|| set("HOME").map(|home| Path::new(&home).join(".config")));
        let missing = "there is no folder for templates; set SISTERSHIP_TEMPLATES to one";
        let settings = settings.ok_or_else(|| Failure::Refused(missing.into()))?;
        Ok(Self(settings.join("sistership").join("templates")))
    }

    fn file_of(&self, name: &str) -> PathBuf {
        self.0.join(format!("{name}.yaml"))
    }

    /// Reads a template.
    ///
    /// # Errors
    /// Returns an error if there is none of that name, which lists those that are there, or if its
    /// file is damaged.
    pub(super) fn read_template(&self, name: &str) -> Result<ImportTemplate, Failure> {
        let file = self.file_of(name);
        if !file.exists() {
            let names = self.template_names().join(", ");
            let known = if names.is_empty() { "none".to_owned() } else { names };
            let message = format!(
                "there is no template `{name}` in {}, which has {known}; write one with \
                 --save-template",
                self.0.display()
            );
            return Err(Failure::Refused(message));
        }
        let text = read_text_file(&file)?;
        serde_yaml::from_str(&text).map_err(|error| about_file(&file, error))
    }

    /// Writes a template in place of one of the same name, and returns its file.
    ///
    /// # Errors
    /// Returns an error if the folder cannot be written.
    pub(super) fn write_template(&self, template: &ImportTemplate) -> Result<PathBuf, Failure> {
        let file = self.file_of(&template.name);
        let text = serde_yaml::to_string(template).map_err(|error| about_file(&file, error))?;
        std::fs::create_dir_all(&self.0).map_err(|error| about_file(&self.0, error))?;
        std::fs::write(&file, text).map_err(|error| about_file(&file, error))?;
        Ok(file)
    }

    fn template_names(&self) -> Vec<String> {
        let entries = std::fs::read_dir(&self.0).into_iter().flatten().flatten();
        let stem = |path: PathBuf| {
            let is_yaml = path.extension().is_some_and(|ending| ending == "yaml");
            path.file_stem().filter(|_| is_yaml).map(|stem| stem.to_string_lossy().into_owned())
        };
        let mut names: Vec<String> = entries.filter_map(|entry| stem(entry.path())).collect();
        names.sort_unstable();
        names
    }

    /// Returns a note for each template that has the columns of a file.
    pub(super) fn matching_notes(&self, guesses: &[ColumnGuess]) -> Vec<String> {
        let files: BTreeSet<&str> = guesses.iter().map(|guess| guess.file.as_str()).collect();
        let columns_of = |file: &str| -> BTreeSet<&str> {
            let own = guesses.iter().filter(|guess| guess.file == file);
            own.map(|guess| guess.column.as_str()).collect()
        };
        // A template whose file is damaged is no reason to refuse an import without it.
        let names = self.template_names().into_iter();
        let known = names.filter_map(|name| self.read_template(&name).ok());
        let note = |template: ImportTemplate| {
            let name = template.name.clone();
            let file = files.iter().find(|file| template.fits_columns(&columns_of(file)))?;
            Some(format!("{file} has the same columns as template `{name}`: use --template {name}"))
        };
        known.filter_map(note).collect()
    }
}

/// Parses the name of a template, which is the name of a file.
pub(super) fn template_name(text: &str) -> Result<String, String> {
    let fits = |letter: char| letter.is_alphanumeric() || matches!(letter, '-' | '_' | '.');
    match !text.is_empty() && text.chars().all(fits) && !text.starts_with('.') {
        true => Ok(text.to_owned()),
        false => Err("use letters, digits, `-`, `_` and `.`, not `.` first".into()),
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
            why: String::new(),
            certain: true,
            question: None,
        }
    }

    #[test]
    fn a_template_is_kept_found_by_its_columns_and_gives_them() {
        let folder = tempfile::tempdir().unwrap();
        let templates = TemplateFolder(folder.path().join("templates"));
        let guesses = [guess("Azi", Some("delta"), true), guess("note", None, false)];
        let template = ImportTemplate::from_guesses("yard-x", &guesses);
        templates.write_template(&template).unwrap();
        assert_eq!(templates.read_template("yard-x").unwrap(), template);
        let given = template.given_columns().unwrap();
        assert_eq!(given[0].role, Some(Role::Delta));
        assert_eq!((given[0].is_reversed, given[1].role), (Some(true), None));
        assert!(templates.matching_notes(&guesses)[0].contains("use --template yard-x"));
        assert!(templates.matching_notes(&guesses[..1]).is_empty());
        let missing = templates.read_template("yard-y").unwrap_err();
        assert!(missing.message().unwrap().contains("which has yard-x"));
    }

    #[test]
    fn a_name_is_that_of_a_file() {
        assert!(template_name("yard-x").is_ok() && template_name("werft_ü.2").is_ok());
        for name in ["", "../a", ".hidden", "a/b"] {
            assert!(template_name(name).is_err(), "{name}");
        }
    }
}
