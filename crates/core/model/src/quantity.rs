//! Numbers with their sources, as model files write them.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use sistership_formula::{self as formula, FormulaError};

/// A value, its source, and its uncertainty if known.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Quantity {
    /// The value, in the unit that its name or its law gives.
    pub value: f64,
    /// Key of the source it comes from; empty only while a section's default is not yet filled in.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub source: String,
    /// Standard error, if known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub standard_error: Option<f64>,
    /// A remark, such as a disagreement between sources.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
}

impl Quantity {
    /// Creates a value with its source.
    pub fn new(value: f64, source: impl Into<String>) -> Self {
        Self { value, source: source.into(), standard_error: None, note: None }
    }
}

/// A value in a file.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum ValueEntry {
    /// A number.
    Number(f64),
    /// A constant expression such as `"0.605/304.8"`.
    Expression(String),
    /// A value with its own source or remark.
    Full(ValueWithSource),
}

/// A value with its own source or remark.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ValueWithSource {
    value: NumberOrExpression,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    source: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    note: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    standard_error: Option<f64>,
}

#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(untagged)]
enum NumberOrExpression {
    Number(f64),
    Expression(String),
}

/// Values that share a source, unless one has its own.
#[derive(Debug, Clone, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Section {
    /// The source of every value without its own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub source: Option<String>,
    /// The values by name.
    #[serde(default)]
    pub values: BTreeMap<String, ValueEntry>,
}

impl Section {
    /// Resolves the values with their sources; `sources` are the keys that exist.
    ///
    /// # Errors
    /// Returns an error that names the value that is not a finite number, has no source, or cites
    /// one that the file does not list.
    pub fn resolve_values(
        &self,
        sources: &[&str],
    ) -> Result<BTreeMap<String, Quantity>, (String, String)> {
        let (values, refused) = self.resolve_all(sources);
        refused.into_iter().next().map_or(Ok(values), Err)
    }

    /// Resolves the values that can be read, and returns the faults of the others.
    pub fn resolve_all(
        &self,
        sources: &[&str],
    ) -> (BTreeMap<String, Quantity>, Vec<(String, String)>) {
        let (mut values, mut refused) = (BTreeMap::new(), Vec::new());
        for (name, written) in &self.values {
            match resolve_entry(written, self.source.as_deref(), sources) {
                Ok(quantity) => {
                    values.insert(name.clone(), quantity);
                }
                Err(error) => refused.push((name.clone(), error.to_string())),
            }
        }
        (values, refused)
    }
}

/// Reason for which a number of a file is refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
enum QuantityError {
    #[error(transparent)]
    Formula(#[from] FormulaError),
    #[error("{0} is not a finite number")]
    NotFinite(f64),
    #[error("has no source; give one for the section or the value")]
    NoSource,
    #[error("cites `{0}`, which is not listed under `sources`")]
    Unlisted(String),
}

fn resolve_entry(
    written: &ValueEntry,
    default_source: Option<&str>,
    sources: &[&str],
) -> Result<Quantity, QuantityError> {
    let (value, source, note, standard_error) = match written {
        ValueEntry::Number(number) => (*number, None, None, None),
        ValueEntry::Expression(text) => (formula::evaluate_constant(text)?, None, None, None),
        ValueEntry::Full(full) => {
            let value = match &full.value {
                NumberOrExpression::Number(number) => *number,
                NumberOrExpression::Expression(text) => formula::evaluate_constant(text)?,
            };
            (value, full.source.as_deref(), full.note.clone(), full.standard_error)
        }
    };
    if !value.is_finite() {
        return Err(QuantityError::NotFinite(value));
    }
    // A source of the value has precedence over that of the section.
    let source = source.or(default_source).ok_or(QuantityError::NoSource)?;
    if !sources.contains(&source) {
        return Err(QuantityError::Unlisted(source.to_owned()));
    }
    Ok(Quantity { value, source: source.to_owned(), standard_error, note })
}
