//! Measures by which a prior weights changes of the coefficients.

use std::collections::BTreeMap;
use std::sync::Arc;

use nalgebra::{DMatrix, DVector};
use sistership_model::Model;
use sistership_model::law::Law;
use sistership_model::trial::Trial;

use super::across::{PlaneSource, SourceRegression};
use super::blocks::RegressionBlocks;
use super::envelope::{MemberRates, OperatingEnvelope};
use super::outcome::RefineError;
use super::population::PopulationRegression;
use sistership_numerics::{RegressionMoments, merge_trials};
use sistership_priors::transfer::TYPICAL_SOURCE;

/// The measure of a prior: the source of the sizes of the regressors.
pub(super) enum PriorMeasure {
    /// The trials (Kanazawa 2023, Eq. 5.11).
    Trials,
    /// The trials and the source's standard manoeuvres, where trials are held out part by part.
    /// Such parts resemble the fitted ones, so that errors on them do not reveal a cubic term that
    /// is wrong beyond the trials: in the sizes of the envelope it takes more to move it than a
    /// linear one. docs/decisions/0006 has the evidence.
    Envelope(OperatingEnvelope),
    /// Typical values of a law's coefficients, with their deviations over ships by name.
    Typical(BTreeMap<String, f64>),
    /// The accelerations of a mixture over the envelope, jointly; its model has its values already.
    Mixture(OperatingEnvelope),
    /// The accelerations of a source of another law over the envelope, jointly.
    Source(Arc<OperatingEnvelope>),
    /// The same for a source that does not roll, where the law does.
    Plane(PlaneSource),
    /// The accelerations of a population at the states of a source's envelope, by mean and scatter.
    Population(Arc<OperatingEnvelope>, Arc<Vec<MemberRates>>),
}

impl PriorMeasure {
    /// Returns the measure for a source of the law that is fitted. A source that cannot be
    /// simulated, and a law of several actuators, have no envelope.
    pub fn for_own_law(source: &Model, law: &Law, trials: &[&Trial], in_parts: bool) -> Self {
        let typical = typical_deviations(source);
        if !typical.is_empty() {
            return Self::Typical(typical);
        }
        // The states of an envelope have one helm and one number of revolutions, which do not tell
        // the inputs of several actuators.
        let has_states = in_parts && law.helm_inputs().next().is_none();
        let envelope =
            has_states.then(|| OperatingEnvelope::new(source, law, trials).ok()).flatten();
        envelope.map_or(Self::Trials, |envelope| {
            Self::Envelope(Arc::unwrap_or_clone(Arc::new(envelope).for_law(law)))
        })
    }

    /// Returns true if the prior is a source of another law, or a population.
    pub fn is_source(&self) -> bool {
        matches!(self, Self::Source(_) | Self::Plane(_) | Self::Population(..))
    }

    /// Gives a model's regressions their measure, and the model the coefficients that follow from a
    /// source of another law or a population.
    ///
    /// # Errors
    /// Returns an error if the law has an input that the trials do not record.
    pub fn apply_to(
        &self,
        blocks: &mut RegressionBlocks,
        model: &mut Model,
        trials: &[RegressionMoments],
    ) -> Result<(), RefineError> {
        match self {
            Self::Trials => {}
            Self::Typical(deviations) => set_precision_by_deviation(blocks, deviations, trials),
            Self::Envelope(envelope) => {
                set_precision_by_size(blocks, &envelope.group_moments(blocks)?, trials)
            }
            Self::Mixture(envelope) => {
                SourceRegression::new(envelope, blocks, model)?.set_precision(blocks, trials);
            }
            Self::Source(envelope) => {
                let imitation = SourceRegression::new(envelope, blocks, model)?;
                imitation.set_coefficients(blocks, model);
                imitation.set_precision(blocks, trials);
            }
            Self::Plane(source) => source.apply_to(blocks, model, trials)?,
            Self::Population(envelope, members) => {
                // The source's regression sets the states, the ridge and the metric; the population
                // then replaces values and precision.
                let states = SourceRegression::new(envelope, blocks, model)?;
                states.set_coefficients(blocks, model);
                states.set_precision(blocks, trials);
                PopulationRegression::new(envelope, members, states.ridge_strength())
                    .apply_to(blocks, model)?;
            }
        }
        Ok(())
    }

    /// Description for reports; `None` for the measure of the published method.
    pub fn describe_prior(&self, model: &Model, law: &Law) -> Option<String> {
        match self {
            Self::Trials => None,
            Self::Typical(deviations) => Some(format!(
                "no ship is the source: the prior is the typical value and spread of {} coefficients \
                 of law `{}`",
                deviations.len(),
                law.name
            )),
            Self::Envelope(_) => Some(
                "there are few trials for a law with roll: parts of trials were held out, and the \
                 prior scales each term also by its size in the standard manoeuvres of the source"
                    .to_owned(),
            ),
            Self::Mixture(envelope) => envelope.mixed.clone(),
            Self::Population(envelope, members) => {
                let names: Vec<&str> = members.iter().map(|of| of.name.as_str()).collect();
                Some(format!(
                    "the prior is the mean and covariance of the accelerations of {} ships in the \
                     states of the trials and of the standard manoeuvres of `{}` ({})",
                    names.len(),
                    envelope.source,
                    names.join(", ")
                ))
            }
            Self::Source(envelope) => {
                let blocks = RegressionBlocks::new(model, law).ok()?;
                let regression = SourceRegression::new(envelope, &blocks, model).ok()?;
                Some(regression.describe_source(&blocks, &law.name))
            }
            Self::Plane(source) => {
                let blocks = RegressionBlocks::new(model, law).ok()?;
                source.describe_source(&blocks, model, law)
            }
        }
    }
}

/// Deviations over ships of the coefficients that have the typical values of their law.
fn typical_deviations(source: &Model) -> BTreeMap<String, f64> {
    let typical = source.coefficients.iter().filter(|(_, one)| one.source == TYPICAL_SOURCE);
    typical.filter_map(|(name, one)| Some((name.clone(), one.standard_error?))).collect()
}

/// Measures each coefficient by its deviation over ships: one deviation of an unknown weighs as much
/// as the mean square of its target. Coefficients without one are measured by their regressors.
fn set_precision_by_deviation(
    blocks: &mut RegressionBlocks,
    deviations: &BTreeMap<String, f64>,
    trials: &[RegressionMoments],
) {
    for (block, trials) in blocks.blocks.iter_mut().zip(trials) {
        let targets = block.axes.len();
        let one = |j: usize| {
            let spread = |target: usize| {
                let of_axis = |(axis, names): (usize, &Vec<String>)| {
                    Some(block.mixing[(target, axis)] * deviations.get(&names[j])?)
                };
                let parts: Option<Vec<f64>> = block.names.iter().enumerate().map(of_axis).collect();
                Some(parts?.iter().map(|part| part * part).sum::<f64>())
            };
            let by_target = |target: usize| {
                let weight = trials.target_variance(target) / spread(target)?;
                weight.is_finite().then_some(weight)
            };
            let all: Option<Vec<f64>> = (0..targets).map(by_target).collect();
            all.map_or(block.shrinkage[j] * trials.regressor_variance(j), |all| {
                all.iter().sum::<f64>() / targets as f64
            })
        };
        let diagonal = DVector::from_fn(block.regressor_count(), |j, _| one(j));
        // One deviation over ships costs as much as the mean square of the target, whatever the scale
        // of the regressor.
        block.precision = Some(DMatrix::from_diagonal(&diagonal));
    }
}

/// Measures each coefficient by the deviation of its regressor over the envelope, or over the
/// trials where that is larger.
fn set_precision_by_size(
    blocks: &mut RegressionBlocks,
    envelope: &[Vec<RegressionMoments>],
    trials: &[RegressionMoments],
) {
    let Some(all) = merge_trials(envelope, |_| true) else { return };
    for ((block, envelope), trials) in blocks.blocks.iter_mut().zip(&all).zip(trials) {
        block.precision = Some(DMatrix::from_diagonal(&block.regressor_sizes(envelope, trials)));
    }
}
