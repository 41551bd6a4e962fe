//! Tables: columns with units, rows of cells with marks, written by one template.

use askama::Template;
use serde_json::Value;

use crate::numbers::{format_known, format_stated};

/// Table of a report.
#[derive(Debug, Template)]
#[template(path = "report_table.html")]
pub(crate) struct ReportTable {
    pub columns: Vec<TableColumn>,
    pub rows: Vec<TableRow>,
}

/// Heading of a column.
#[derive(Debug)]
pub(crate) struct TableColumn {
    pub title: String,
    pub unit: String,
    pub class: &'static str,
}

impl TableColumn {
    /// Creates a column of words.
    pub fn text_column(title: &str, unit: &str) -> Self {
        Self { title: title.into(), unit: unit.into(), class: "text" }
    }

    /// Creates a column of sentences, which may be broken into lines.
    pub fn prose_column(title: &str) -> Self {
        Self { title: title.into(), unit: String::new(), class: "prose" }
    }

    /// Creates a column of numbers, aligned at their ends.
    pub fn number_column(title: &str, unit: &str) -> Self {
        Self { title: title.into(), unit: unit.into(), class: "num" }
    }
}

/// Row: a heading over the rows that follow, or cells.
#[derive(Debug, Default)]
pub(crate) struct TableRow {
    pub heading: String,
    pub highlighted: bool,
    pub cells: Vec<TableCell>,
}

impl TableRow {
    /// Creates a row of cells.
    pub fn from_cells(cells: Vec<TableCell>) -> Self {
        Self { cells, ..Self::default() }
    }

    /// Creates a heading.
    pub fn heading_row(text: impl Into<String>) -> Self {
        Self { heading: text.into(), ..Self::default() }
    }

    /// Returns the same row, highlighted or not.
    pub fn with_highlight(self, highlighted: bool) -> Self {
        Self { highlighted, ..self }
    }
}

/// Cell: its text and a mark next to it.
#[derive(Debug, Default)]
pub(crate) struct TableCell {
    pub text: String,
    pub mark: String,
    pub kind: &'static str,
    pub code: bool,
}

impl TableCell {
    /// Creates a cell of text.
    pub fn new(text: impl Into<String>) -> Self {
        Self { text: text.into(), ..Self::default() }
    }

    /// Creates a cell with an identifier.
    pub fn code_cell(text: impl Into<String>) -> Self {
        Self { text: text.into(), code: true, ..Self::default() }
    }

    /// Returns the same cell with a mark; `kind` is its style: `good`, `bad`, `open`, `chosen`,
    /// `note`.
    pub fn with_mark(self, mark: impl Into<String>, kind: &'static str) -> Self {
        Self { mark: mark.into(), kind, ..self }
    }
}

/// Formats the value of a setting for readers.
pub(crate) fn format_setting(value: &Value) -> String {
    match value {
        Value::Null => "–".into(),
        Value::Bool(yes) => if *yes { "yes" } else { "no" }.into(),
        Value::Number(number) => format_known(number.as_f64(), |number| format_stated(number, 4)),
        Value::String(text) => text.clone(),
        // An empty list is a setting, not an unknown value.
        Value::Array(values) if values.is_empty() => "none".into(),
        Value::Array(values) => values.iter().map(format_setting).collect::<Vec<_>>().join(", "),
        Value::Object(_) => value.to_string(),
    }
}
