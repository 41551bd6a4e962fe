//! Errors of model files, with their place.

use std::fmt;

use schemars::JsonSchema;
use serde::de::DeserializeOwned;

use crate::yaml::MAX_FAULTS;

/// Error of a model file: file, line and field, and the reason.
#[derive(Debug, Clone, Default, PartialEq, Eq, thiserror::Error)]
pub struct FileError {
    /// Name of the file, or of the text that was sent.
    pub file: String,
    /// Line, counted from 1, if known.
    pub line: Option<usize>,
    /// Dotted path of the field; empty if the error concerns the whole file.
    pub field: String,
    /// The fault and its remedy.
    pub message: String,
    /// Further faults of the file.
    pub further: Vec<FileError>,
}

impl fmt::Display for FileError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(&self.file)?;
        if let Some(line) = self.line {
            write!(out, ":{line}")?;
        }
        if self.field.is_empty() {
            write!(out, ": {}", self.message)?;
        } else {
            write!(out, ": {}: {}", self.field, self.message)?;
        }
        self.further.iter().try_for_each(|further| write!(out, "\n{further}"))
    }
}

impl FileError {
    /// Converts an error of the YAML reader.
    pub fn from_yaml(file: &str, error: crate::yaml::YamlError) -> Self {
        Self {
            file: file.to_owned(),
            line: error.line,
            field: String::new(),
            message: error.message,
            further: Vec::new(),
        }
    }

    /// Combines several errors into one, at most [`MOST_FAULTS`] of them; `None` if there are none.
    pub fn from_faults(all: impl Iterator<Item = Self>) -> Option<Self> {
        let mut all = all.take(MAX_FAULTS);
        let first = all.next()?;
        Some(Self { further: all.collect(), ..first })
    }
}

/// Context that turns messages about fields into errors with file and line.
pub(crate) struct ErrorContext<'a> {
    file: &'a str,
    text: &'a str,
}

impl<'a> ErrorContext<'a> {
    pub(crate) fn new(file: &'a str, text: &'a str) -> Self {
        Self { file, text }
    }

    /// Deserialises the text. If its shape is wrong, the error lists all faults that the schema
    /// finds, otherwise the fault of the parser with its line and column.
    pub(crate) fn deserialize<T: DeserializeOwned + JsonSchema>(&self) -> Result<T, FileError> {
        crate::yaml::read_document(self.text).map_err(|error| {
            let of_parser = FileError::from_yaml(self.file, error);
            let faults = crate::yaml::find_faults::<T>(self.text).into_iter();
            FileError::from_faults(faults.map(|(field, message)| self.field_error(&field, message)))
                .unwrap_or(of_parser)
        })
    }

    /// Creates an error at a dotted field; the line is that of the path's keys, each searched below
    /// the one before.
    pub(crate) fn field_error(&self, field: &str, message: impl ToString) -> FileError {
        FileError {
            file: self.file.to_owned(),
            line: self.field_line(field),
            field: field.to_owned(),
            message: message.to_string(),
            further: Vec::new(),
        }
    }

    fn field_line(&self, field: &str) -> Option<usize> {
        let mut found = None;
        for key in field.split('.') {
            // A key may be on the line of the one before, in braces.
            let start = found.map_or(0, |line: usize| line - 1);
            match self.text.lines().enumerate().skip(start).find(|(_, line)| names_key(line, key)) {
                Some((index, _)) => found = Some(index + 1),
                None => break,
            }
        }
        found
    }
}

/// Returns true if the line has `key:` as a whole word (quoted or not), or lists it as `- key` or
/// in brackets.
fn names_key(line: &str, key: &str) -> bool {
    line.match_indices(key).any(|(at, _)| {
        let before = line[..at].chars().next_back();
        let after = line[at + key.len()..].chars().next();
        let boundary =
            |c: Option<char>| c.is_none_or(|c| !c.is_alphanumeric() && c != '_' && c != '|');
        boundary(before) && boundary(after) && !line[..at].contains('#')
    })
}
