//! A calibrated model: its coefficients moved, and the terms that it lacks added to its law.
//!
//! Residuals are linearised about this one. The columns of coefficients alone would not do: how a
//! lacked term answers to a sensor that errs would be left out.

use sistership_formula::Expr;
use sistership_model::Model;
use sistership_model::law::Law;

use super::nuisance::{Terms, regressor};
use sistership_filtering::{Nuisance, NuisanceKind, lacked_name};
use sistership_identification::refine::RefineError;

/// A model that has learned, with its law in the dress of the effects that the model carries.
#[derive(Debug, Clone)]
pub struct CalibratedModel {
    pub model: Model,
    pub law: Law,
    /// Whether instruments follow the rates that the filter expects: as on its own trials.
    pub expected_rates: bool,
    /// From one reading to the next at least, s, as on its own trials; by the samples that are used
    /// where absent.
    pub reading_interval_s: Option<f64>,
}

impl CalibratedModel {
    /// A model with coefficients moved by `shift`, by column, read by instruments that err as they
    /// did on its own trials.
    ///
    /// # Errors
    /// Names the field of an effect that the model carries.
    pub fn new(
        model: &Model,
        law: &Law,
        terms: &Terms,
        nuisance: &[Nuisance],
        shift: &[f64],
    ) -> Result<Self, RefineError> {
        let (mut model, mut law) = (model.clone(), law.clone());
        let systematic_errors = model
            .uncertainty
            .iter()
            .flat_map(|known| known.systematic_errors.clone())
            .collect::<Vec<_>>();
        model.effects.extend(systematic_errors);
        for (nuisance, shift) in nuisance.iter().zip(shift) {
            match nuisance.kind {
                NuisanceKind::Own(_) => {
                    if let Some(quantity) = model.coefficients.get_mut(&nuisance.name) {
                        quantity.value += shift;
                    }
                }
                NuisanceKind::Lacked(axis) => {
                    let Some((_, expr)) =
                        terms.get(&nuisance.name).and_then(|form| regressor(&model, form))
                    else {
                        continue;
                    };
                    let name = lacked_name(&nuisance.name);
                    if let Some(axis) = law.axes.get_mut(&axis).filter(|_| *shift != 0.0) {
                        let term = Expr::Name(name.clone()).times(Expr::Number(*shift));
                        axis.rest = Expr::Add(Box::new(axis.rest.clone()), Box::new(term));
                    }
                    law.add_value(name, expr);
                }
                NuisanceKind::Mass(..) => {}
            }
        }
        let law = law
            .with_effects(&model)
            .map_err(|(field, message)| RefineError::Law(format!("{field}: {message}")))?;
        let expected_rates = model.uncertainty.as_ref().is_some_and(|known| known.expected_rates);
        let reading_interval_s =
            model.uncertainty.as_ref().and_then(|known| known.reading_interval_s);
        Ok(Self { model, law, expected_rates, reading_interval_s })
    }
}
