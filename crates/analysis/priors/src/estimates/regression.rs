//! A published regression as its file writes it.

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
    gives: BTreeMap<String, GivenFile>,
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
struct GivenFile {
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
    /// Its name: author and year.
    pub name: String,
    /// One line for people.
    pub title: String,
    /// Where it is published, and where it was read.
    pub source: Source,
    /// What was chosen where sources disagree.
    pub note: String,
    values: BTreeMap<String, Expr>,
    gives: BTreeMap<String, (Expr, Expr)>,
}

/// One value that a regression gives for a ship.
#[derive(Debug, Clone, PartialEq)]
pub struct Given {
    /// The regression.
    pub regression: String,
    /// The value, in the unit of the coefficient, parameter or particular.
    pub value: f64,
    /// The standard deviation of what it leaves open, in the same unit.
    pub scatter: f64,
}

impl Regression {
    /// Reads a file.
    ///
    /// # Errors
    /// Names file and field.
    pub fn parse(file: &str, text: &str) -> Result<Self, FileError> {
        let wrong = |field: String, message: String| FileError {
            file: file.to_owned(),
            line: None,
            field,
            message,
            further: Vec::new(),
        };
        let raw: RegressionFile = sistership_model::yaml::read(text)
            .map_err(|error| wrong(String::new(), error.to_string()))?;
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

    /// What it gives.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.gives.keys().map(String::as_str)
    }

    /// A value for a ship; none where it does not give that, or needs what is not known.
    pub fn given(&self, name: &str, known: &dyn Fn(&str) -> Option<f64>) -> Option<Given> {
        let (value, scatter) = self.gives.get(name)?;
        let lookup = |name: &str| self.lookup(name, known, 0);
        let finite = |expr: &Expr| expr.value(&lookup).filter(|value| value.is_finite());
        Some(Given {
            regression: self.name.clone(),
            value: finite(value)?,
            scatter: finite(scatter)?,
        })
    }

    fn lookup(&self, name: &str, known: &dyn Fn(&str) -> Option<f64>, depth: usize) -> Option<f64> {
        // A value that names itself would go round for ever.
        if depth > self.values.len() {
            return None;
        }
        match self.values.get(name) {
            Some(expr) => expr.value(&|inner| self.lookup(inner, known, depth + 1)),
            None => known(name),
        }
    }
}
