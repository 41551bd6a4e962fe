//! A calibrated model: its coefficients shifted, and the terms that it lacks added to its law.
//!
//! Residuals are linearised about this model. The columns of coefficients alone would not suffice:
//! the response of a missing term to the error of a sensor would be ignored.

use sistership_formula::Expr;
use sistership_model::Model;
use sistership_model::law::Law;

use super::nuisance::{TermForms, term_regressor};
use sistership_filtering::{NuisanceColumn, NuisanceKind, missing_term_name};
use sistership_identification::refine::RefineError;

/// A model with learned coefficients, and its law with the effects that the model carries.
#[derive(Debug, Clone)]
pub struct CalibratedModel {
    pub model: Model,
    pub law: Law,
    /// True if instruments depend on the rates that the filter expects, as on the trials of the
    /// calibration; without one, they depend on the rates on the recorded path.
    pub expected_rates: bool,
    /// Least interval between readings, s, as on the model's own trials; determined from the
    /// samples that are used where absent.
    pub reading_interval_s: Option<f64>,
}

impl CalibratedModel {
    /// Creates a model with coefficients moved by `shift`, by column, and with the systematic
    /// errors of the instruments on its own trials.
    ///
    /// # Errors
    /// Returns an error that names the field of an effect that the model carries.
    pub fn new(
        model: &Model,
        law: &Law,
        terms: &TermForms,
        nuisance: &[NuisanceColumn],
        shift: &[f64],
    ) -> Result<Self, RefineError> {
        let (mut model, mut law) = (model.clone(), law.clone());
        // Known errors of the instruments act on the readings like any other effect.
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
                        terms.get(&nuisance.name).and_then(|form| term_regressor(&model, form))
                    else {
                        continue;
                    };
                    let name = missing_term_name(&nuisance.name);
                    // A term without a shift is only named, so that its regressor has a column.
                    if let Some(axis) = law.axes.get_mut(&axis).filter(|_| *shift != 0.0) {
                        let term = Expr::Name(name.clone()).times(Expr::Number(*shift));
                        axis.rest = Expr::Add(Box::new(axis.rest.clone()), Box::new(term));
                    }
                    law.add_value(name, expr);
                }
                // Masses keep their values; their prior fixes them.
                NuisanceKind::Mass(..) => {}
            }
        }
        let law = law
            .with_effects(&model)
            .map_err(|(field, message)| RefineError::Law(format!("{field}: {message}")))?;
        let expected_rates = model.uncertainty.is_some();
        let reading_interval_s = model.uncertainty.as_ref().map(|known| known.reading_interval_s);
        Ok(Self { model, law, expected_rates, reading_interval_s })
    }
}
