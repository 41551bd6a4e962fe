//! Unknowns of a design: coefficients by the model's posterior, and parameters of effects by the
//! library's priors, all in deviations that are independent before any new trial.

use nalgebra::DMatrix;
use sistership_filtering::EffectCandidate;
use sistership_model::Model;

use crate::error::PlanError;
use crate::thresholds::THRESHOLDS;

/// Unknowns `x = R z` about the values of the model, `z` being independent with unit variances.
pub(crate) struct UnknownDeviations {
    /// Names of the coefficients.
    pub coefficients: Vec<String>,
    /// Effects, in their order after the coefficients.
    pub effects: Vec<EffectCandidate>,
    /// `R`, unknowns by deviations, lower triangular.
    pub root: DMatrix<f64>,
    /// Remark on their origin.
    pub remark: Option<String>,
}

impl UnknownDeviations {
    /// Creates the unknowns from the posterior of a model; without one, each coefficient is
    /// independent within a share of its value.
    ///
    /// # Errors
    /// Returns an error if the posterior cannot be read.
    pub fn new(model: &Model, effects: Vec<EffectCandidate>) -> Result<Self, PlanError> {
        let (coefficients, rows, remark) = match model.valid_posterior() {
            Some(posterior) => {
                // The filter knows coefficients only. They come first, so that their rows are the
                // root of their own covariance.
                let is_coefficient = |name: &&String| model.coefficients.contains_key(*name);
                let names: Vec<String> =
                    posterior.names.iter().take_while(is_coefficient).cloned().collect();
                let mut rows = posterior.covariance_root()?;
                rows.truncate(names.len());
                (names, rows, None)
            }
            None => share_prior(model),
        };
        let own: usize = effects.iter().map(|effect| effect.at.len()).sum();
        let count = coefficients.len();
        let mut root = DMatrix::zeros(count + own, count + own);
        for (i, row) in rows.iter().enumerate() {
            row.iter().enumerate().for_each(|(j, value)| root[(i, j)] = *value);
        }
        // Parameters of effects are independent, with the deviations of the library's priors.
        let deviations =
            effects.iter().flat_map(|e| e.form.parameters.values().map(|p| p.prior_deviation));
        deviations.enumerate().for_each(|(k, d)| root[(count + k, count + k)] = d);
        Ok(Self { coefficients, effects, root, remark })
    }

    /// Transforms information on the unknowns to information on the deviations: `R' F R`.
    pub fn on_deviations(&self, information: &DMatrix<f64>) -> DMatrix<f64> {
        self.root.transpose() * information * &self.root
    }

    /// Model with its coefficients moved by `by` times one deviation.
    pub fn move_coefficients(&self, model: &Model, deviation: usize, by: f64) -> Model {
        let mut moved = Model { posterior: None, uncertainty: None, ..model.clone() };
        // The moved model is no fit of trials: their validity range does not apply.
        moved.validity = None;
        for (place, name) in self.coefficients.iter().enumerate() {
            if let Some(quantity) = moved.coefficients.get_mut(name) {
                quantity.value += by * self.root[(place, deviation)];
            }
        }
        moved
    }
}

type SharePrior = (Vec<String>, Vec<Vec<f64>>, Option<String>);

fn share_prior(model: &Model) -> SharePrior {
    let share = THRESHOLDS.unknown_share;
    let names: Vec<String> = model.coefficients.keys().cloned().collect();
    let row = |(place, name): (usize, &String)| {
        let mut row = vec![0.0; place + 1];
        row[place] = share * model.coefficient(name).abs();
        row
    };
    let rows = names.iter().enumerate().map(row).collect();
    let remark = format!(
        "{} has no posterior: an independent standard deviation of {:.0} % of the value is \
         assumed for each coefficient",
        model.name,
        100.0 * share
    );
    (names, rows, Some(remark))
}
