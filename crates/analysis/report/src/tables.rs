//! Tables: columns with units, rows of cells with marks, written by one template.

use askama::Template;
use serde_json::Value;

use crate::numbers::{known, stated};

/// A table.
#[derive(Debug, Template)]
#[template(path = "report_table.html")]
pub(crate) struct Table {
    pub columns: Vec<Column>,
    pub rows: Vec<Row>,
}

/// A column's heading.
#[derive(Debug)]
pub(crate) struct Column {
    pub title: String,
    pub unit: String,
    pub class: &'static str,
}

impl Column {
    /// A column of words.
    pub fn text(title: &str, unit: &str) -> Self {
        Self { title: title.into(), unit: unit.into(), class: "text" }
    }

    /// A column of sentences, which may be broken into lines.
    pub fn prose(title: &str) -> Self {
        Self { title: title.into(), unit: String::new(), class: "prose" }
    }

    /// A column of numbers, aligned at their ends.
    pub fn number(title: &str, unit: &str) -> Self {
        Self { title: title.into(), unit: unit.into(), class: "num" }
    }
}

/// A row: a heading over the rows that follow, or cells.
#[derive(Debug, Default)]
pub(crate) struct Row {
    pub heading: String,
    pub highlighted: bool,
    pub cells: Vec<Cell>,
}

impl Row {
    /// A row of cells.
    pub fn of(cells: Vec<Cell>) -> Self {
        Self { cells, ..Self::default() }
    }

    /// A heading.
    pub fn heading(text: impl Into<String>) -> Self {
        Self { heading: text.into(), ..Self::default() }
    }

    /// The same row, set off from the others or not.
    pub fn highlighted(self, highlighted: bool) -> Self {
        Self { highlighted, ..self }
    }
}

/// A cell: its text and a mark beside it.
#[derive(Debug, Default)]
pub(crate) struct Cell {
    pub text: String,
    pub mark: String,
    pub kind: &'static str,
    pub code: bool,
}

impl Cell {
    /// A cell of text.
    pub fn new(text: impl Into<String>) -> Self {
        Self { text: text.into(), ..Self::default() }
    }

    /// A cell with a name as the program spells it.
    pub fn code(text: impl Into<String>) -> Self {
        Self { text: text.into(), code: true, ..Self::default() }
    }

    /// The same cell with a mark; `kind` is its style: `good`, `bad`, `open`, `chosen`, `note`.
    pub fn mark(self, mark: impl Into<String>, kind: &'static str) -> Self {
        Self { mark: mark.into(), kind, ..self }
    }
}

/// A setting as people read it.
pub(crate) fn setting(value: &Value) -> String {
    match value {
        Value::Null => "–".into(),
        Value::Bool(yes) => if *yes { "yes" } else { "no" }.into(),
        Value::Number(number) => known(number.as_f64(), |number| stated(number, 4)),
        Value::String(text) => text.clone(),
        Value::Array(values) if values.is_empty() => "none".into(),
        Value::Array(values) => values.iter().map(setting).collect::<Vec<_>>().join(", "),
        Value::Object(_) => value.to_string(),
    }
}
