//! Variants of a refinement: one for each family of terms, with its regressions, statistics and
//! training sets.

use std::collections::BTreeMap;

use rayon::prelude::*;
use sistership_model::Model;
use sistership_model::coefficient::Axis;
use sistership_model::quantity::Quantity;
use sistership_model::trial::{Channel, Trial};

use super::blocks::RegressionBlocks;
use super::equations::EquationForm;
use super::errors::CoefficientErrors;
use super::family::TermFamily;
use super::measure::PriorMeasure;
use super::outcome::RefineError;
use super::parts::trial_slice;
use super::posterior::{SequenceTables, SequencedRows, posterior_errors, sequence_rows};
use super::problem::RefinementProblem;
use super::ridge::{FittedCoefficient, RegressionFold, RidgeChoices, most_likely, noise_strengths};
use super::settings::TuningRange;
use super::thresholds::SELECTION;
use crate::constraints::{CoefficientLimits, LimitError};
use sistership_numerics::{RegressionMoments, RidgeChoice, merge_trials};

/// A variant: one family of terms with its regressions.
pub(super) struct TermVariant {
    /// Family of terms.
    pub family: TermFamily,
    /// Transferred source with these terms.
    pub model: Model,
    /// Its regressions.
    pub blocks: RegressionBlocks,
    /// Method by which its rows were made.
    pub equations: EquationForm,
    /// Its statistics, by trial and regression.
    pub moments: Vec<Vec<RegressionMoments>>,
    /// Least strength of the prior by regression and target: more than zero for a typical ship,
    /// whose deviations are known.
    pub least_strengths: Vec<Vec<f64>>,
    /// Limits of its coefficients, if any.
    pub limits: Option<CoefficientLimits>,
}

impl TermVariant {
    /// Creates the variant of a family for a model with its terms.
    ///
    /// # Errors
    /// Returns an error if the trials lack a channel or have too few samples, or the constraints
    /// refer to a coefficient that the model does not have.
    fn new(
        problem: &RefinementProblem<'_>,
        equations: EquationForm,
        family: TermFamily,
        mut model: Model,
    ) -> Result<Self, RefineError> {
        let mut blocks = RegressionBlocks::new(&model, problem.law)?;
        let moments = training_moments(problem, equations, &blocks)?;
        // The prior may set coefficients of the model, so that the limits are built after it.
        let mut least_strengths = Vec::new();
        if let Some(all) = merge_trials(&moments, |_| true) {
            problem.measure.apply_to(&mut blocks, &mut model, &all)?;
            if matches!(problem.measure, PriorMeasure::Typical(_)) {
                let overlapping = equations.overlapping_rows();
                least_strengths = noise_strengths(&blocks, &all, &model, overlapping);
            }
        }
        let limits = coefficient_limits(problem, &model)?;
        Ok(Self { family, model, blocks, equations, moments, least_strengths, limits })
    }

    /// Returns the coefficients fitted on a training set, within the limits.
    ///
    /// # Errors
    /// Returns an error with the limits that cannot be kept together.
    pub fn solve(
        &self,
        fold: &RegressionFold<'_>,
        choices: &RidgeChoices,
    ) -> Result<BTreeMap<String, FittedCoefficient>, LimitError> {
        let mut fitted = fold.solve(choices);
        let Some(limits) = &self.limits else { return Ok(fitted) };
        let (names, curvature) = fold.solution_curvature(choices);
        let solution = fitted.iter().map(|(name, fitted)| (name.clone(), fitted.value)).collect();
        let prior = |name: &str| fitted.get(name).map_or(0.0, |fitted| fitted.prior_deviation);
        // Standard errors remain those of the unconstrained solution.
        let nearest = limits.nearest_coefficients(&solution, &names, &curvature, &prior)?;
        nearest.into_iter().for_each(|(name, value)| {
            fitted.get_mut(&name).into_iter().for_each(|fitted| fitted.value = value);
        });
        Ok(fitted)
    }

    /// Returns the statistics of some trials together, one set for each regression.
    ///
    /// # Errors
    /// Returns an error if the trials have no sample.
    pub fn merged_moments(
        &self,
        keep: impl Fn(usize) -> bool,
    ) -> Result<Vec<RegressionMoments>, RefineError> {
        merge_trials(&self.moments, keep)
            .ok_or_else(|| RefineError::Data("the trials have no samples that can be used".into()))
    }

    /// The model with other values of some coefficients and parameters.
    pub fn model_at(&self, values: &BTreeMap<String, f64>) -> Model {
        let mut model = self.model.clone();
        for (name, value) in values {
            let refined = Quantity::new(*value, "refined");
            match model.parameters.get_mut(name) {
                Some(parameter) => *parameter = refined,
                None => drop(model.coefficients.insert(name.clone(), refined)),
            }
        }
        model
    }

    /// Joint errors of a ridge's coefficients on all trials.
    pub fn ridge_errors(
        &self,
        training: &[&Trial],
        choices: &RidgeChoices,
    ) -> Result<Option<CoefficientErrors>, RefineError> {
        let Some(all) = merge_trials(&self.moments, |_| true) else { return Ok(None) };
        posterior_errors(&self.blocks, &all, &self.sequenced_rows(training)?, &self.model, choices)
            .map(Some)
    }

    /// The rows behind the statistics. Differences of neighbouring samples share most of their
    /// information: they are merged over the time of a difference.
    fn sequenced_rows(&self, training: &[&Trial]) -> Result<SequencedRows, RefineError> {
        let parts = |trial: &&Trial| {
            trial.segments().into_iter().map(|part| trial_slice(trial, part)).collect::<Vec<_>>()
        };
        let parts: Vec<Trial> =
            training.iter().flat_map(parts).filter(|part| part.len() > 1).collect();
        // Trials may differ in their sampling interval, and so in their dependent rows.
        let one = |part: &Trial| -> Result<SequenceTables, RefineError> {
            let tables = self.equations.regression_tables(&self.blocks, part)?;
            let dependent = self.equations.dependent_rows(part.interval_s());
            Ok(SequenceTables { tables, dependent })
        };
        let tables: Vec<SequenceTables> = parts.par_iter().map(one).collect::<Result<_, _>>()?;
        Ok(sequence_rows(&self.blocks, &tables, self.equations.are_differences()))
    }

    /// Returns the training set of each fold, with its trials held out; a single trial is fitted
    /// and judged at once.
    ///
    /// # Errors
    /// Returns an error if a fold has no sample.
    pub fn training_folds(
        &self,
        problem: &RefinementProblem<'_>,
    ) -> Result<Vec<RegressionFold<'_>>, RefineError> {
        let nothing =
            || RefineError::Data("a fold has no samples; give more or longer trials".into());
        let one = |fold: usize| {
            let training = merge_trials(&self.moments, |trial| problem.is_fitted(trial, fold))
                .ok_or_else(nothing)?;
            let left_out = merge_trials(&self.moments, |trial| problem.fold_of(trial) == fold)
                .ok_or_else(nothing)?;
            Ok(RegressionFold::new(&self.blocks, &self.model, &training, &left_out))
        };
        (0..problem.fold_count()).into_par_iter().map(one).collect()
    }

    /// Returns the same strength for every acceleration but that of roll. A source of the plane
    /// gives no information on roll, so that its strength is the one with the greatest marginal
    /// likelihood on all training samples; held-out windows could choose it only if every fold kept
    /// something that excites roll. `roll` multiplies this strength.
    pub fn common_choices(&self, lambda: f64, roll: f64) -> Result<RidgeChoices, RefineError> {
        let blocks = &self.blocks.blocks;
        let [lambda_min, lambda_max] = SELECTION.roll_strengths;
        let free = TuningRange { lambda_min, lambda_max, alpha_max: 0.0 };
        // `tuned` is read for roll only, so that it may be empty for laws without roll.
        let tuned = if blocks.iter().any(|block| block.axes.contains(&Axis::K)) {
            most_likely(
                &self.blocks,
                &self.merged_moments(|_| true)?,
                &self.model,
                &free,
                SELECTION.roll_strength_count,
            )
        } else {
            RidgeChoices::new()
        };
        let of_axis = |b: usize, (target, axis): (usize, &Axis)| match axis {
            Axis::K => RidgeChoice { lambda: roll * tuned[b][target].lambda, alpha: 0.0 },
            _ => {
                let least = self.least_strengths.get(b).and_then(|of| of.get(target));
                RidgeChoice { lambda: least.map_or(lambda, |least| lambda.max(*least)), alpha: 0.0 }
            }
        };
        let of_block =
            |b: usize| blocks[b].axes.iter().enumerate().map(|axis| of_axis(b, axis)).collect();
        Ok((0..blocks.len()).map(of_block).collect())
    }
}

/// Returns the variants of the families in the settings that differ from each other. A family with
/// too few samples, or without a coefficient of a blank law, is omitted.
///
/// # Errors
/// Returns the error of the first omitted family if none remains.
pub(super) fn family_variants(
    problem: &RefinementProblem<'_>,
    equations: EquationForm,
) -> Result<Vec<TermVariant>, RefineError> {
    let families = &problem.settings.families;
    let families = if families.is_empty() { &[TermFamily::Own][..] } else { families };
    let (mut variants, mut lacking) = (Vec::new(), None);
    for &family in families {
        let Some(model) = family.extend_model(&problem.transferred, problem.law) else { continue };
        match TermVariant::new(problem, equations, family, model) {
            Ok(variant) => variants.push(variant),
            // Too little data for one family is no error as long as another one can be fitted.
            Err(error @ RefineError::Data(_)) => drop(lacking.get_or_insert(error)),
            Err(error) => return Err(error),
        }
    }
    lacking.filter(|_| variants.is_empty()).map_or(Ok(variants), Err)
}

/// The limits that the settings set on a model's coefficients, over the speeds of the whole trials.
fn coefficient_limits(
    problem: &RefinementProblem<'_>,
    model: &Model,
) -> Result<Option<CoefficientLimits>, RefineError> {
    let asked = &problem.settings.constraints;
    if asked.is_empty() {
        return Ok(None);
    }
    let speeds =
        problem.whole.iter().flat_map(|trial| trial.channel(Channel::U).into_iter().flatten());
    let speeds = speeds
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], u| [low.min(*u), high.max(*u)]);
    let limits = CoefficientLimits::new(asked, model, problem.law, speeds);
    limits.map(Some).map_err(|error| RefineError::Setting {
        field: "constraints".into(),
        message: error.to_string(),
    })
}

/// Statistics by trial and regression.
fn training_moments(
    problem: &RefinementProblem<'_>,
    equations: EquationForm,
    blocks: &RegressionBlocks,
) -> Result<Vec<Vec<RegressionMoments>>, RefineError> {
    let one = |trial: &&Trial| equations.regression_moments(blocks, trial);
    let moments: Vec<Vec<RegressionMoments>> =
        problem.training.par_iter().map(one).collect::<Result<_, _>>()?;
    let samples: f64 = moments.iter().map(|m| m.first().map_or(0.0, |m| m.count)).sum();
    let widest =
        blocks.blocks.iter().map(super::RegressionBlock::regressor_count).max().unwrap_or(0) as f64;
    // With the prior of a source of another law, or of a population, rows may be fewer than
    // coefficients.
    let least = if problem.measure.is_source() { 1.0 } else { equations.least_samples(widest) };
    if samples < least {
        let message = format!(
            "the trials give {samples:.0} {} for {widest} coefficients an axis, at least {least} \
             are needed: give more or longer trials",
            equations.describe_rows()
        );
        return Err(RefineError::Data(message));
    }
    Ok(moments)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::settings::RefinementSettings;
    use super::*;
    use crate::testing::{mariner_model, simulated_trials};

    /// Every second sample of a trial.
    fn thinned(trial: &Trial) -> Trial {
        let of = |column: &[f64]| column.iter().step_by(2).copied().collect::<Vec<f64>>();
        let channels = trial.channels.iter().map(|(channel, column)| (*channel, of(column)));
        Trial { t_s: of(&trial.t_s), channels: channels.collect(), ..trial.clone() }
    }

    #[test]
    fn rows_are_merged_over_the_same_time_at_every_sampling_interval() {
        let (model, law) = mariner_model();
        let trials = simulated_trials(&model, &law, 0.0);
        let (fine, coarse) = (&trials[0], &thinned(&trials[1]));
        let counts = |training: &[&Trial]| -> Vec<usize> {
            let settings = RefinementSettings::default();
            let problem = RefinementProblem::from_model(&model, &law, training, settings);
            let over = EquationForm::Differences(Some(4.0));
            let variant = TermVariant::new(&problem, over, TermFamily::Own, model.clone()).unwrap();
            let rows = variant.sequenced_rows(training).unwrap();
            rows.blocks[0].iter().map(|sequence| sequence.regressors.nrows()).collect()
        };
        // A difference spans four samples at 1 s and two at 2 s.
        let (of_fine, of_coarse) = ((fine.len() - 4) / 4, (coarse.len() - 2) / 2);
        assert_eq!(counts(&[fine, coarse]), [of_fine, of_coarse]);
        assert_eq!(counts(&[coarse, fine]), [of_coarse, of_fine]);
    }
}
