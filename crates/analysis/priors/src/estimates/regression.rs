//! A published regression in the form of its file.

use std::collections::BTreeMap;

use serde::Deserialize;
use sistership_formula::{self as formula, Expr};
use sistership_model::FileError;
use sistership_model::source::Source;

/// A regression file; see `models/regressions/README.md`.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct RegressionFile {
    kind: RegressionKind,
    name: String,
    title: String,
    source: Source,
    note: String,
    #[serde(default)]
    values: BTreeMap<String, NumberOrFormula>,
    gives: BTreeMap<String, RegressionValueFile>,
}

#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "lowercase")]
enum RegressionKind {
    Regression,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(untagged)]
enum NumberOrFormula {
    Number(f64),
    Formula(String),
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct RegressionValueFile {
    formula: NumberOrFormula,
    scatter: NumberOrFormula,
}

impl NumberOrFormula {
    fn parse(&self) -> Result<Expr, String> {
        match self {
            Self::Number(number) => formula::parse(&number.to_string()),
            Self::Formula(text) => formula::parse(text),
        }
        .map_err(|error| error.to_string())
    }
}

/// A published regression.
#[derive(Debug, Clone)]
pub struct Regression {
    /// Name: author and year.
    pub name: String,
    /// Title in one line.
    pub title: String,
    /// Publication, and the text from which it was taken.
    pub source: Source,
    /// Choices where sources differ.
    pub note: String,
    values: BTreeMap<String, Expr>,
    gives: BTreeMap<String, (Expr, Expr)>,
}

/// One value of a regression for a ship.
#[derive(Debug, Clone, PartialEq)]
pub struct RegressionValue {
    /// Name of the regression.
    pub regression: String,
    /// Value, in the unit of the coefficient, parameter or particular.
    pub value: f64,
    /// Standard deviation of the residuals, in the same unit.
    pub scatter: f64,
}

impl Regression {
    /// Parses a file.
    ///
    /// # Errors
    /// Returns an error that names file and field.
    pub fn parse(file: &str, text: &str) -> Result<Self, FileError> {
        let wrong = |field: String, message: String| FileError {
            file: file.to_owned(),
            line: None,
            field,
            message,
            further: Vec::new(),
        };
        let raw: RegressionFile = sistership_model::yaml::read_document(text)
            .map_err(|error| wrong(String::new(), error.to_string()))?;
        // The only kind: the parser has rejected all others.
        let RegressionKind::Regression = raw.kind;
        let formula = |field: &str, name: &str, written: &NumberOrFormula| {
            written.parse().map_err(|message| wrong(format!("{field}.{name}"), message))
        };
        let values = raw.values.iter();
        let values =
            values.map(|(name, written)| Ok((name.clone(), formula("values", name, written)?)));
        let gives = raw.gives.iter().map(|(name, given)| {
            let value = formula("gives", name, &given.formula)?;
            Ok((name.clone(), (value, formula("gives", name, &given.scatter)?)))
        });
        Ok(Self {
            name: raw.name,
            title: raw.title,
            source: raw.source,
            note: raw.note,
            values: values.collect::<Result<_, FileError>>()?,
            gives: gives.collect::<Result<_, FileError>>()?,
        })
    }

    /// Names of its values.
    pub fn value_names(&self) -> impl Iterator<Item = &str> {
        self.gives.keys().map(String::as_str)
    }

    /// Value for a ship; none where the regression does not give it, or an input is unknown.
    pub fn value_for(
        &self,
        name: &str,
        known: &dyn Fn(&str) -> Option<f64>,
    ) -> Option<RegressionValue> {
        let (value, scatter) = self.gives.get(name)?;
        let lookup = |name: &str| self.lookup_name(name, known, 0);
        // A formula outside its range may have no finite value.
        let finite = |expr: &Expr| expr.value(&lookup).filter(|value| value.is_finite());
        Some(RegressionValue {
            regression: self.name.clone(),
            value: finite(value)?,
            scatter: finite(scatter)?,
        })
    }

    fn lookup_name(
        &self,
        name: &str,
        known: &dyn Fn(&str) -> Option<f64>,
        depth: usize,
    ) -> Option<f64> {
        // A value that refers to itself would recurse without end.
        if depth > self.values.len() {
            return None;
        }
        match self.values.get(name) {
            Some(expr) => expr.value(&|inner| self.lookup_name(inner, known, depth + 1)),
            None => known(name),
        }
    }
}
