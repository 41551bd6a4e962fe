//! What a prior measures a change of coefficients by.

use std::sync::Arc;

use nalgebra::DMatrix;
use sistership_model::Model;
use sistership_model::law::Law;
use sistership_model::trial::Trial;

use super::across::{PlaneSource, SourceRegression};
use super::blocks::Blocks;
use super::envelope::{MemberRates, OperatingEnvelope};
use super::outcome::RefineError;
use super::population::PopulationRegression;
use sistership_numerics::{Moments, merged};

/// Where the sizes of the regressors come from.
pub(super) enum PriorMeasure {
    /// The trials (Kanazawa 2023, Eq. 5.11).
    Trials,
    /// The trials and the source's standard manoeuvres, where trials are left out part by part.
    /// Such parts resemble what is fitted, so that errors on them do not tell a cubic term that is
    /// wrong beyond the trials: in the sizes of the envelope it takes more to move it than a linear
    /// one. docs/decisions/0006 has the evidence.
    Envelope(OperatingEnvelope),
    /// What a mixture says over the envelope, jointly; its model has its values already.
    Mixture(OperatingEnvelope),
    /// What a source of another law says over the envelope, jointly.
    Source(Arc<OperatingEnvelope>),
    /// The same of one that does not roll, where the law does.
    Plane(PlaneSource),
    /// What a population says at the states of a source's, in its mean and scatter.
    Population(Arc<OperatingEnvelope>, Arc<Vec<MemberRates>>),
}

impl PriorMeasure {
    /// Of a source by the law that is fitted. One that cannot sail has no envelope.
    pub fn own(source: &Model, law: &Law, trials: &[&Trial], in_parts: bool) -> Self {
        let envelope = in_parts.then(|| OperatingEnvelope::new(source, law, trials).ok()).flatten();
        envelope.map_or(Self::Trials, Self::Envelope)
    }

    /// Whether the prior is what a source of another law says, or a population.
    pub fn is_source(&self) -> bool {
        matches!(self, Self::Source(_) | Self::Plane(_) | Self::Population(..))
    }

    /// Gives a model's regressions their measure, and the model what a source of another law says.
    ///
    /// # Errors
    /// The law takes something that the trials do not record.
    pub fn hold(
        &self,
        blocks: &mut Blocks,
        model: &mut Model,
        trials: &[Moments],
    ) -> Result<(), RefineError> {
        match self {
            Self::Trials => {}
            Self::Envelope(envelope) => sized(blocks, &envelope.moments(blocks)?, trials),
            Self::Mixture(envelope) => {
                SourceRegression::new(envelope, blocks, model)?.hold(blocks, trials);
            }
            Self::Source(envelope) => {
                let imitation = SourceRegression::new(envelope, blocks, model)?;
                imitation.fill(blocks, model);
                imitation.hold(blocks, trials);
            }
            Self::Plane(source) => source.hold(blocks, model, trials)?,
            Self::Population(envelope, members) => {
                let states = SourceRegression::new(envelope, blocks, model)?;
                states.fill(blocks, model);
                states.hold(blocks, trials);
                PopulationRegression::new(envelope, members, states.ridge()).hold(blocks, model)?;
            }
        }
        Ok(())
    }

    /// What it is, for people; nothing where it is as published.
    pub fn words(&self, model: &Model, law: &Law) -> Option<String> {
        match self {
            Self::Trials => None,
            Self::Envelope(_) => Some(
                "few trials of a ship that rolls: they were left out part by part, and the prior \
                 measures each term by its size in the source's standard manoeuvres too"
                    .to_owned(),
            ),
            Self::Mixture(envelope) => envelope.mixed.clone(),
            Self::Population(envelope, members) => {
                let names: Vec<&str> = members.iter().map(|of| of.name.as_str()).collect();
                Some(format!(
                    "the prior is what {} ships say at the states of the trials and of the \
                     standard manoeuvres of `{}`: their mean, and how they differ ({})",
                    names.len(),
                    envelope.source,
                    names.join(", ")
                ))
            }
            Self::Source(envelope) => {
                let blocks = Blocks::new(model, law).ok()?;
                let regression = SourceRegression::new(envelope, &blocks, model).ok()?;
                Some(regression.words(&blocks, &law.name))
            }
            Self::Plane(source) => {
                let blocks = Blocks::new(model, law).ok()?;
                source.words(&blocks, model, law)
            }
        }
    }
}

/// Measures each coefficient by its regressor's deviation over the envelope, or over the trials
/// where that is more.
fn sized(blocks: &mut Blocks, envelope: &[Vec<Moments>], trials: &[Moments]) {
    let Some(all) = merged(envelope, |_| true) else { return };
    for ((block, envelope), trials) in blocks.blocks.iter_mut().zip(&all).zip(trials) {
        block.precision = Some(DMatrix::from_diagonal(&block.sizes(envelope, trials)));
    }
}
