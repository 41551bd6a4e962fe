//! Templates of imports, kept by name for each user.

use std::path::{Path, PathBuf};

use sistership_trials::{ColumnGuess, ImportTemplate};

use crate::failure::{Failure, about_file};
use crate::zoo::read_text_file;

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
        // A template whose file is damaged is no reason to refuse an import without it.
        let names = self.template_names().into_iter();
        let known = names.filter_map(|name| self.read_template(&name).ok());
        let note = |template: ImportTemplate| {
            let name = template.name.clone();
            let file = template.matching_file(guesses)?;
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
            probability: 1.0,
            why: String::new(),
            certain: true,
            question: None,
        }
    }

    #[test]
    fn a_template_is_kept_and_found_by_its_columns() {
        let folder = tempfile::tempdir().unwrap();
        let templates = TemplateFolder(folder.path().join("templates"));
        let guesses = [guess("Azi", Some("delta"), true), guess("note", None, false)];
        let template = ImportTemplate::from_guesses("yard-x", &guesses);
        templates.write_template(&template).unwrap();
        assert_eq!(templates.read_template("yard-x").unwrap(), template);
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
