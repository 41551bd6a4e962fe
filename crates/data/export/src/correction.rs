//! Learned corrections as formulas that add to the accelerations in the same way as effects, so
//! that every format writes them like the law.

use std::borrow::Cow;

use sistership_formula::Expr;
use sistership_model::coefficient::Axis;
use sistership_model::{Law, Model};
use sistership_simulation::Plant;
use sistership_simulation::PlantError;
use sistership_simulation::branch::{AdditionFormulas, LAW_RATES, attached_correction};
use sistership_simulation::equations::{CoefficientBinding, EquationsOfMotion};

use crate::error::ExportError;

/// Axes of the rates that a correction changes, with their indices among those of a plant.
const CHANGED: [(Axis, usize); 3] = [(Axis::X, 0), (Axis::Y, 1), (Axis::N, 3)];
/// Axes of a plant.
const AXES: [Axis; 4] = [Axis::X, Axis::Y, Axis::K, Axis::N];

/// Returns a law with effects, with the formulas of the model's learned correction added.
///
/// # Errors
/// Returns an error if the weights are not attached, or if the correction depends on accelerations
/// that are only solved for after all other values.
pub fn with_correction(model: &Model, law: Law) -> Result<Law, ExportError> {
    let Some(learned) = attached_correction(model)? else { return Ok(law) };
    let AdditionFormulas { values, added } = learned.addition_formulas();
    let mut told = correction_inputs(model, &law, &values, &added)?;
    told.extend(values);
    let mut law = law;
    // Values are defined before the additions that use them.
    told.into_iter().for_each(|(name, expr)| law.add_value(name, expr));
    for ((axis, _), expr) in CHANGED.into_iter().zip(added) {
        law.dressing.accelerations.extend(expr.map(|expr| (axis, expr)));
    }
    Ok(law)
}

/// Named formulas, in the order of their definition.
type NamedFormulas = Vec<(String, Expr)>;

/// Formulas of the inputs of a correction other than states and inputs of the law: inputs that the
/// law does not have are zero, and rates are those of the law.
fn correction_inputs(
    model: &Model,
    law: &Law,
    values: &NamedFormulas,
    added: &[Option<Expr>; 3],
) -> Result<NamedFormulas, ExportError> {
    let names = |name: &str| {
        let formulas = values.iter().map(|(_, expr)| expr).chain(added.iter().flatten());
        formulas.into_iter().any(|expr| expr.mentioned_names().contains(name))
    };
    // The correction reads zero for a rudder or propeller that the law does not have.
    let absent = |name: &&str| !law.inputs.contains_key(*name);
    let nothing = |name: &str| (name.to_owned(), Expr::Number(0.0));
    let mut told: NamedFormulas = ["delta", "n"].into_iter().filter(absent).map(nothing).collect();
    if LAW_RATES.into_iter().any(names) {
        told.extend(law_rates(model, law)?);
    }
    Ok(told)
}

/// Rates of the law as formulas: rows of the inverse mass matrix times forces.
fn law_rates(model: &Model, law: &Law) -> Result<NamedFormulas, ExportError> {
    let equations = EquationsOfMotion::from_law(model, Cow::Borrowed(law));
    let plant = Plant::from_equations(&equations, CoefficientBinding::Names)?;
    let changing = || ExportError::Correction { model: model.name.clone(), law: law.name.clone() };
    // Only a constant mass matrix has been inverted when the formulas are written.
    let mobility = plant.to_listing().mobility.ok_or_else(changing)?;
    let mut rates = NamedFormulas::new();
    for (name, (axis, row)) in LAW_RATES.into_iter().zip(CHANGED) {
        rates.push((name.to_owned(), law_rate(&equations, (axis, &mobility[row]))?));
    }
    Ok(rates)
}

fn law_rate(
    equations: &EquationsOfMotion<'_>,
    (axis, mobility): (Axis, &[f64; 4]),
) -> Result<Expr, PlantError> {
    let mut rate = equations.added_acceleration(axis).unwrap_or(Expr::Number(0.0));
    for (other, factor) in AXES.into_iter().zip(mobility) {
        // An axis that the law lacks has no force.
        if *factor != 0.0 && equations.axes().contains(&other) {
            let force = equations.axis_force(other, CoefficientBinding::Names)?;
            let part = Expr::Number(*factor).times(force);
            rate = Expr::Add(Box::new(rate), Box::new(part));
        }
    }
    Ok(rate)
}
