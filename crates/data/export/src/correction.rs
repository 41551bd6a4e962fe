//! What a model has learned beside its law, as formulas that add to the accelerations as effects
//! do: so every format writes it as it writes the law.

use std::borrow::Cow;

use sistership_formula::Expr;
use sistership_model::coefficient::Axis;
use sistership_model::{Law, Model};
use sistership_simulation::Plant;
use sistership_simulation::PlantError;
use sistership_simulation::branch::{AdditionFormulas, LAW_RATES, attached};
use sistership_simulation::equations::{Coefficients, EquationsOfMotion};

use crate::error::ExportError;

/// The axes of the rates that a correction changes, and their places among those of a plant.
const CHANGED: [(Axis, usize); 3] = [(Axis::X, 0), (Axis::Y, 1), (Axis::N, 3)];
/// The axes of a plant.
const AXES: [Axis; 4] = [Axis::X, Axis::Y, Axis::K, Axis::N];

/// A law, in the dress of a model's effects, with what the model has learned beside it.
///
/// # Errors
/// The weights are not attached, or the correction is told accelerations that are only solved for
/// after all else.
pub fn corrected(model: &Model, law: Law) -> Result<Law, ExportError> {
    let Some(learned) = attached(model)? else { return Ok(law) };
    let AdditionFormulas { values, added } = learned.formulas();
    let mut told = told(model, &law, &values, &added)?;
    told.extend(values);
    let mut law = law;
    told.into_iter().for_each(|(name, expr)| law.add_value(name, expr));
    for ((axis, _), expr) in CHANGED.into_iter().zip(added) {
        law.dressing.accelerations.extend(expr.map(|expr| (axis, expr)));
    }
    Ok(law)
}

type Values = Vec<(String, Expr)>;

/// What a correction is told beside states and inputs: inputs that the law does not have are
/// nothing, and rates are those of the law.
fn told(
    model: &Model,
    law: &Law,
    values: &Values,
    added: &[Option<Expr>; 3],
) -> Result<Values, ExportError> {
    let names = |name: &str| {
        let formulas = values.iter().map(|(_, expr)| expr).chain(added.iter().flatten());
        formulas.into_iter().any(|expr| expr.names().contains(name))
    };
    let absent = |name: &&str| !law.inputs.contains_key(*name);
    let nothing = |name: &str| (name.to_owned(), Expr::Number(0.0));
    let mut told: Values = ["delta", "n"].into_iter().filter(absent).map(nothing).collect();
    if LAW_RATES.into_iter().any(names) {
        told.extend(law_rates(model, law)?);
    }
    Ok(told)
}

/// The rates that the law gives, as formulas: rows of the inverse mass matrix times forces.
fn law_rates(model: &Model, law: &Law) -> Result<Values, ExportError> {
    let equations = EquationsOfMotion::of_law(model, Cow::Borrowed(law));
    let plant = Plant::of(&equations, Coefficients::Names)?;
    let changing = || ExportError::Correction { model: model.name.clone(), law: law.name.clone() };
    let mobility = plant.listed().mobility.ok_or_else(changing)?;
    let mut rates = Values::new();
    for (name, (axis, row)) in LAW_RATES.into_iter().zip(CHANGED) {
        rates.push((name.to_owned(), law_rate(&equations, (axis, &mobility[row]))?));
    }
    Ok(rates)
}

fn law_rate(
    equations: &EquationsOfMotion<'_>,
    (axis, mobility): (Axis, &[f64; 4]),
) -> Result<Expr, PlantError> {
    let mut rate = equations.addition(axis).unwrap_or(Expr::Number(0.0));
    for (other, factor) in AXES.into_iter().zip(mobility) {
        if *factor != 0.0 && equations.axes().contains(&other) {
            let force = equations.force(other, Coefficients::Names)?;
            let part = Expr::Number(*factor).times(force);
            rate = Expr::Add(Box::new(rate), Box::new(part));
        }
    }
    Ok(rate)
}
