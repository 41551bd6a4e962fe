//! Tables: columns with units, rows of cells with marks, written by one template.

use askama::Template;
use serde_json::Value;

use crate::numbers::{known, stated};

/// Table of a report.
#[derive(Debug, Template)]
#[template(path = "report_table.html")]
pub(crate) struct Table {
    pub columns: Vec<Column>,
    pub rows: Vec<Row>,
}

/// Heading of a column.
#[derive(Debug)]
pub(crate) struct Column {
    pub title: String,
    pub unit: String,
    pub class: &'static str,
}

impl Column {
    /// Creates a column of words.
    pub fn text(title: &str, unit: &str) -> Self {
        Self { title: title.into(), unit: unit.into(), class: "text" }
    }

    /// Creates a column of sentences, which may be broken into lines.
    pub fn prose(title: &str) -> Self {
        Self { title: title.into(), unit: String::new(), class: "prose" }
    }

    /// Creates a column of numbers, aligned at their ends.
    pub fn number(title: &str, unit: &str) -> Self {
        Self { title: title.into(), unit: unit.into(), class: "num" }
    }
}

/// Row: a heading over the rows that follow, or cells.
#[derive(Debug, Default)]
pub(crate) struct Row {
    pub heading: String,
    pub highlighted: bool,
    pub cells: Vec<Cell>,
}

impl Row {
    /// Creates a row of cells.
    pub fn of(cells: Vec<Cell>) -> Self {
        Self { cells, ..Self::default() }
    }

    /// Creates a heading.
    pub fn heading(text: impl Into<String>) -> Self {
        Self { heading: text.into(), ..Self::default() }
    }

    /// Returns the same row, highlighted or not.
    pub fn highlighted(self, highlighted: bool) -> Self {
        Self { highlighted, ..self }
    }
}

/// Cell: its text and a mark next to it.
#[derive(Debug, Default)]
pub(crate) struct Cell {
    pub text: String,
    pub mark: String,
    pub kind: &'static str,
    pub code: bool,
}

impl Cell {
    /// Creates a cell of text.
    pub fn new(text: impl Into<String>) -> Self {
        Self { text: text.into(), ..Self::default() }
    }

    /// Creates a cell with an identifier.
    pub fn code(text: impl Into<String>) -> Self {
        Self { text: text.into(), code: true, ..Self::default() }
    }

    /// Returns the same cell with a mark; `kind` is its style: `good`, `bad`, `open`, `chosen`,
    /// `note`.
    pub fn mark(self, mark: impl Into<String>, kind: &'static str) -> Self {
        Self { mark: mark.into(), kind, ..self }
    }
}

/// Formats the value of a setting for readers.
pub(crate) fn setting(value: &Value) -> String {
    match value {
        Value::Null => "–".into(),
        Value::Bool(yes) => if *yes { "yes" } else { "no" }.into(),
        Value::Number(number) => known(number.as_f64(), |number| stated(number, 4)),
        Value::String(text) => text.clone(),
        // An empty list is a setting, not an unknown value.
        Value::Array(values) if values.is_empty() => "none".into(),
        Value::Array(values) => values.iter().map(setting).collect::<Vec<_>>().join(", "),
        Value::Object(_) => value.to_string(),
    }
}
