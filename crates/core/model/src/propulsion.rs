//! Propulsion outside the range covered by a model's trials: a surge balance of resistance and
//! open-water thrust in place of the law's extrapolation straight ahead.
//!
//! The formulas are data (`models/propulsion/open-water.yaml`). Within the speeds of the trials and
//! their orders to the engine (its revolutions at rest, by its response) the law is unchanged. At
//! other orders it is evaluated at the motion by a ratio that brings them to those of the trials,
//! and its forces by the square of that, as forces are alike at the same advance ratio. Beyond the
//! advance ratios of the trials its revolutions are limited to these, and its forces straight ahead
//! are replaced by the balance. With `F_s` for the law's force straight ahead, rudder amidships and
//! in still air, `P` for the balance, `n'` for the limited revolutions and `w` for the law's share,
//! surge becomes `F - (1 - w) F_s + P(u, n) - w P(u, n')`; sway, yaw and roll the same without `P`.
//! Terms that are linear in the coefficients remain so.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::LazyLock;

use indexmap::IndexMap;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::coefficient::Axis;
use crate::effect::qualified_name;
use crate::error::FileError;
use crate::law::{Law, LawInput, LawParameter, StraightAhead};
use crate::quantity::Quantity;
use crate::source::Source;
use sistership_formula::units::{Dimension, Unit};
use sistership_formula::{Expr, parse};

/// The surge balance of a model, by the parameters in its formulas.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Propulsion {
    /// Values of the parameters, SI.
    pub parameters: BTreeMap<String, Quantity>,
}

/// Formulas in the form of their file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct BalanceFile {
    #[serde(rename = "kind")]
    _kind: BalanceKind,
    #[serde(rename = "name")]
    _name: String,
    #[serde(rename = "title")]
    _title: String,
    #[serde(rename = "sources")]
    _sources: BTreeMap<String, Source>,
    #[serde(rename = "note")]
    _note: String,
    parameters: IndexMap<String, ParameterFile>,
    sees: BTreeMap<String, String>,
    values: IndexMap<String, String>,
    weight: String,
    surge: String,
}

#[derive(Debug, Deserialize)]
enum BalanceKind {
    #[serde(rename = "propulsion")]
    Propulsion,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct ParameterFile {
    unit: String,
    meaning: String,
}

/// Formulas of the balance, parsed.
#[derive(Debug)]
struct SurgeBalance {
    parameters: IndexMap<String, LawParameter>,
    sees: Vec<(String, Expr)>,
    values: IndexMap<String, Expr>,
    weight: Expr,
    surge: Expr,
}

static BALANCE: LazyLock<Result<SurgeBalance, FileError>> = LazyLock::new(|| {
    let text = include_str!("../../../../models/propulsion/open-water.yaml");
    SurgeBalance::parse("propulsion/open-water.yaml", text)
});

impl SurgeBalance {
    fn parse(file: &str, text: &str) -> Result<Self, FileError> {
        let raw: BalanceFile =
            crate::yaml::read_document(text).map_err(|error| FileError::from_yaml(file, error))?;
        let refused = |field: &str, message: String| FileError {
            file: file.to_owned(),
            field: field.to_owned(),
            message,
            ..FileError::default()
        };
        let formula =
            |field: &str, text: &str| parse(text).map_err(|e| refused(field, e.to_string()));
        let parameter = |(name, raw): (&String, &ParameterFile)| {
            let unit = Unit::parse(&raw.unit).map_err(|e| refused(name, e.to_string()))?;
            let (unit, dimension) = (raw.unit.clone(), unit.dimension);
            let meaning = raw.meaning.clone();
            let known = LawParameter {
                dimension,
                unit,
                meaning,
                from: None,
                is_approach_speed: false,
                prior: None,
            };
            Ok((name.clone(), known))
        };
        Ok(Self {
            parameters: raw.parameters.iter().map(parameter).collect::<Result<_, _>>()?,
            sees: parse_named(&raw.sees, &formula)?,
            values: parse_named(&raw.values, &formula)?,
            weight: formula("weight", &raw.weight)?,
            surge: formula("surge", &raw.surge)?,
        })
    }
}

fn parse_named<'a, C: FromIterator<(String, Expr)>>(
    raw: impl IntoIterator<Item = (&'a String, &'a String)>,
    formula: &dyn Fn(&str, &str) -> Result<Expr, FileError>,
) -> Result<C, FileError> {
    raw.into_iter().map(|(name, text)| Ok((name.clone(), formula(name, text)?))).collect()
}

/// Input of the revolutions in a law.
const REVOLUTIONS_INPUT: &str = "n";
/// States that are zero straight ahead.
const LATERAL_STATES: [&str; 4] = ["v", "r", "p", "phi"];
/// Inputs that are zero in still air, and the prefix of those that are zero with the rudder
/// amidships.
const WIND_INPUTS: [&str; 2] = ["wind_speed", "apparent_wind_speed"];
const RUDDER_PREFIX: &str = "delta";
/// States that the law sees by the ratio. Roll is not among them.
const SCALED_STATES: [&str; 3] = ["u", "v", "r"];
/// Name of the value by which the law's motion is scaled.
const RATIO_VALUE: &str = "ratio";
/// Name of the value that is the share of the balance.
const SHARE_VALUE: &str = "beyond";

/// Returns the name in a law of a name of the balance.
fn qualified_own_name(name: &str) -> String {
    qualified_name("propulsion", "open-water", name)
}

fn surge_balance() -> Result<&'static SurgeBalance, (String, String)> {
    BALANCE.as_ref().map_err(|error| ("propulsion".to_owned(), error.to_string()))
}

impl Propulsion {
    /// Value of a parameter; `None` if it is not given.
    pub fn value(&self, name: &str) -> Option<f64> {
        self.parameters.get(name).map(|quantity| quantity.value)
    }

    /// Checks that exactly the parameters of the formulas are given, with finite values.
    ///
    /// # Errors
    /// Returns the field at fault and the reason.
    pub fn check_parameters(&self) -> Result<(), (String, String)> {
        let field = |name: &str| format!("propulsion.parameters.{name}");
        let known = &surge_balance()?.parameters;
        if let Some(name) = self.parameters.keys().find(|name| !known.contains_key(*name)) {
            return Err((field(name), "the balance has no such parameter".into()));
        }
        let is_given = |name: &str| self.value(name).is_some_and(f64::is_finite);
        match known.keys().find(|name| !is_given(name)) {
            Some(name) => Err((field(name), "give it a finite value".into())),
            None => Ok(()),
        }
    }
}

impl Law {
    /// Returns this law with the balance outside the range covered by a model's trials.
    ///
    /// # Errors
    /// Returns the field of the model at fault and the reason.
    pub fn with_propulsion(&self, propulsion: &Propulsion) -> Result<Self, (String, String)> {
        propulsion.check_parameters()?;
        let balance = surge_balance()?;
        let mut law = self.clone();
        add_inputs(&mut law, balance, propulsion);
        scale_forces(&mut law, balance);
        // The values straight ahead are copied after the scaling, so that they are of scaled motions.
        let renamed = add_straight_values(&mut law);
        law.add_value(qualified_own_name("weight"), qualify_names(&balance.weight, balance));
        let one = Box::new(Expr::Number(1.0));
        let beyond = Expr::Subtract(one, Box::new(Expr::Name(qualified_own_name("weight"))));
        law.add_value(qualified_own_name(SHARE_VALUE), beyond);
        let straight = StraightAhead { renamed, beyond: qualified_own_name(SHARE_VALUE) };
        for axis in law.axes.values_mut() {
            axis.rest = straight.subtract_share(axis.rest.clone(), &Expr::Number(1.0));
        }
        // Only surge receives the balance in exchange for the removed forces.
        if let Some(axis) = law.axes.get_mut(&Axis::X) {
            let surge = Box::new(qualify_names(&balance.surge, balance));
            axis.rest = Expr::Add(Box::new(axis.rest.clone()), surge);
        }
        law.dressing.straight = Some(straight);
        Ok(law)
    }
}

/// Adds the revolutions as an input, with those of self-propulsion as the default, and the
/// parameters.
fn add_inputs(law: &mut Law, balance: &SurgeBalance, propulsion: &Propulsion) {
    let default = propulsion.value("revolutions");
    let revolutions = LawInput { dimension: Dimension::RATE, default, helm: None };
    law.inputs.entry(REVOLUTIONS_INPUT.to_owned()).or_insert(revolutions);
    for (name, parameter) in &balance.parameters {
        law.parameters.insert(qualified_own_name(name), parameter.clone());
        let value = propulsion.value(name).unwrap_or(0.0);
        law.dressing.parameters.insert(qualified_own_name(name), value);
    }
}

/// Replaces the law's forces by those of the scaled motion, times the square of the ratio.
fn scale_forces(law: &mut Law, balance: &SurgeBalance) {
    let ratio = Expr::Name(qualified_own_name(RATIO_VALUE));
    let seen = seen_motion(law, balance, &ratio);
    for name in seen.keys() {
        law.rename_in_forces(name, &seen_name(name));
    }
    for axis in law.axes.values_mut() {
        for expr in [&mut axis.scale, &mut axis.rest] {
            *expr = expr.clone().times(ratio.clone()).times(ratio.clone());
        }
    }
    // Names propagate in the order of the values, in which those of the law come last.
    let own = std::mem::take(&mut law.values);
    for (name, expr) in &balance.values {
        // Heel has a righting moment of its own, which does not go with the square of the speed.
        let is_unscaled = name == RATIO_VALUE && law.has_roll();
        let expr = if is_unscaled { Expr::Number(1.0) } else { qualify_names(expr, balance) };
        law.add_value(qualified_own_name(name), expr);
    }
    seen.into_iter().for_each(|(name, expr)| law.add_value(seen_name(&name), expr));
    law.values.extend(own);
}

/// States and inputs at which the law is evaluated, by the names that they replace.
fn seen_motion(law: &Law, balance: &SurgeBalance, ratio: &Expr) -> IndexMap<String, Expr> {
    let by_ratio = |name: &str| {
        let own = Box::new(Expr::Name(name.to_owned()));
        (name.to_owned(), Expr::Divide(own, Box::new(ratio.clone())))
    };
    let wind = WIND_INPUTS.into_iter().filter(|name| law.inputs.contains_key(*name));
    let limited = balance.sees.iter();
    SCALED_STATES
        .into_iter()
        .chain(wind)
        .map(by_ratio)
        .chain(limited.map(|(name, expr)| (name.clone(), qualify_names(expr, balance))))
        .collect()
}

/// Name of the value of a state or input at which the law is evaluated.
fn seen_name(name: &str) -> String {
    qualified_own_name(&format!("seen.{name}"))
}

/// Returns a formula of the balance with its names in a law.
fn qualify_names(expr: &Expr, balance: &SurgeBalance) -> Expr {
    let is_own = |name: &str| {
        balance.parameters.contains_key(name)
            || balance.values.contains_key(name)
            || name == "weight"
    };
    expr.replace_names(&|name| is_own(name).then(|| Expr::Name(qualified_own_name(name))))
}

/// Adds the values straight ahead that differ from the original ones; returns the replacements of
/// names.
fn add_straight_values(law: &mut Law) -> BTreeMap<String, Expr> {
    let is_still =
        |name: &&String| name.starts_with(RUDDER_PREFIX) || WIND_INPUTS.contains(&name.as_str());
    let inputs = law.inputs.keys().filter(is_still).cloned();
    let still = LATERAL_STATES.iter().map(|name| (*name).to_owned()).chain(inputs);
    let mut renamed: BTreeMap<String, Expr> = still.map(|name| (name, Expr::Number(0.0))).collect();
    let values: Vec<(String, Expr)> =
        law.values.iter().map(|(name, expr)| (name.clone(), expr.clone())).collect();
    for (name, expr) in values {
        // Values are in the order of dependence, so that replaced names propagate in one pass.
        let names: BTreeSet<&str> = expr.mentioned_names();
        if names.iter().any(|name| renamed.contains_key(*name)) {
            let straight = qualified_own_name(&format!("straight.{name}"));
            law.add_value(straight.clone(), expr.replace_names(&|name| renamed.get(name).cloned()));
            renamed.insert(name, Expr::Name(straight));
        }
    }
    renamed
}
