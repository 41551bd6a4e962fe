//! The prior as a population: the accelerations of other ships, each transferred to this ship's
//! particulars and evaluated at the same states. Their mean is the mean of the prior, and their
//! differences are its covariance: that of a hierarchical model, from groups that are known (Gelman
//! et al. 2013, Bayesian Data Analysis, section 5.4, the means of whose groups are given here).
//!
//! Directions of coefficients are measured as for a source of another law (docs/decisions/0015):
//! with `R' R` the precision that this determines and `z = R b` a ship's coefficients, the prior's
//! covariance of `z` is `e 1 + (1 - e) p S`. `S` is the scatter of the ships about their mean, of
//! trace 1, `p` the number of coefficients, and `e` ([`POPULATION`]`.outside`) the share of the
//! variance in directions in which the ships do not differ.

use std::sync::Arc;

use nalgebra::DVector;
use rayon::prelude::*;
use sistership_model::law::Law;
use sistership_model::quantity::Quantity;
use sistership_model::trial::Trial;
use sistership_model::{Model, Vessel};
use sistership_numerics::{PriorMetric, RegressionMoments, RidgeChoice, RidgePath, RobustScatter};
use sistership_priors::transfer::{TrialApproach, transfer_model};

use super::blocks::{RegressionBlock, RegressionBlocks};
use super::envelope::{EnvelopeRates, MemberRates, OperatingEnvelope};
use super::outcome::RefineError;
use super::thresholds::POPULATION;

/// A ship of the population.
#[derive(Debug, Clone)]
pub struct PopulationShip {
    /// Its model, as published or as refined.
    pub model: Model,
    /// The model's law.
    pub law: Arc<Law>,
}

/// Returns the accelerations of each member that covers every state of an envelope. Members of the
/// target ship itself are excluded.
///
/// # Errors
/// Returns an error if there are fewer such members than a scatter needs.
pub(super) fn member_rates(
    members: &[PopulationShip],
    target: &Vessel,
    approach: Option<TrialApproach>,
    (envelope, trials): (&OperatingEnvelope, &[&Trial]),
) -> Result<Vec<MemberRates>, RefineError> {
    let one = |PopulationShip { model, law }: &PopulationShip| {
        let carried = transfer_model(model, law, target, approach);
        // A member that cannot be set up, or does not cover a state, is skipped.
        let rates = envelope.model_rates((&carried, law), trials).ok()?;
        Some(MemberRates { name: model.name.clone(), rates })
    };
    let others: Vec<&PopulationShip> =
        members.iter().filter(|member| member.model.ship != target.name()).collect();
    let known: Vec<MemberRates> = others.into_par_iter().filter_map(one).collect();
    if known.len() < POPULATION.least {
        let message = format!(
            "only {} ships of the population cover the trials; the prior `population` needs at \
             least {}",
            known.len(),
            POPULATION.least
        );
        return Err(RefineError::Data(message));
    }
    Ok(known)
}

/// Refuses laws for which a population cannot be the prior: the law of its source, and laws with
/// roll, on which few ships give information.
///
/// # Errors
/// Returns an error if the law is one of them.
pub(super) fn check_laws(law: &Law, source_law: Option<&Law>) -> Result<(), RefineError> {
    let is_across = source_law.is_some_and(|own| own.name != law.name);
    if is_across && !law.has_roll() {
        return Ok(());
    }
    let message = format!(
        "`population` is for laws without roll and a source of another law; it does not apply to \
         `{}`",
        law.name
    );
    Err(RefineError::Setting { field: "prior".into(), message })
}

/// The members' accelerations, for the regressions of a law.
pub(super) struct PopulationRegression<'a> {
    envelope: &'a OperatingEnvelope,
    members: &'a [MemberRates],
    ridge: f64,
}

impl<'a> PopulationRegression<'a> {
    /// Creates the regression with the strength of the ridge that a source at the same states has.
    pub fn new(envelope: &'a OperatingEnvelope, members: &'a [MemberRates], ridge: f64) -> Self {
        Self { envelope, members, ridge }
    }

    /// Sets a model's coefficients to the members' mean, and replaces the precision that a source
    /// determines by that of the members. Regressions without a precision keep the source's values.
    ///
    /// # Errors
    /// Returns an error if the law has an input that the states do not have.
    pub fn apply_to(
        &self,
        blocks: &mut RegressionBlocks,
        model: &mut Model,
    ) -> Result<(), RefineError> {
        let rates: Vec<&EnvelopeRates> = self.members.iter().map(|member| &member.rates).collect();
        let moments = self.envelope.model_moments(blocks, &rates)?;
        for (block, moments) in blocks.blocks.iter_mut().zip(&moments) {
            // The metric is the precision that the source's regression left in the block.
            let Some(metric) = block.precision.as_ref().and_then(PriorMetric::of_precision) else {
                continue;
            };
            let members = self.member_coordinates(block, &metric, moments);
            let scatter = RobustScatter::new(&members, POPULATION.rounds);
            block.precision = scatter.coefficient_precision(&metric, POPULATION.outside);
            set_means(block, &scatter.means, &metric, (model, self.members.len()));
        }
        Ok(())
    }

    /// The members' coefficients in the coordinates of a metric, by target.
    fn member_coordinates(
        &self,
        block: &RegressionBlock,
        metric: &PriorMetric,
        moments: &RegressionMoments,
    ) -> Vec<Vec<DVector<f64>>> {
        let (p, q) = (block.regressor_count(), block.axes.len());
        let zero = vec![0.0; p];
        let own = PriorMetric::of_regressors(moments, &block.shrinkage);
        let path = RidgePath::with_metric(moments, &vec![zero.clone(); moments.targets()], own);
        let choice = RidgeChoice { lambda: self.ridge, alpha: 0.0 };
        // Targets are ordered by member, then by axis.
        let of = |target: usize, member: usize| {
            metric.root_matrix()
                * DVector::from_vec(path.solve_target(member * q + target, choice, &zero))
        };
        let members = 0..self.members.len();
        (0..q).map(|t| members.clone().map(|member| of(t, member)).collect()).collect()
    }
}

/// Sets the coefficients of a regression to means by target.
fn set_means(
    block: &RegressionBlock,
    means: &[DVector<f64>],
    metric: &PriorMetric,
    of: (&mut Model, usize),
) {
    let (model, count) = of;
    let solved: Vec<DVector<f64>> = means.iter().map(|mean| metric.inverse_root() * mean).collect();
    for place in 0..block.regressor_count() {
        let seen = DVector::from_iterator(means.len(), solved.iter().map(|one| one[place]));
        // From the unknowns of the regression back to the coefficients of the axes.
        let own = &block.unmixing * seen;
        for (names, value) in block.names.iter().zip(&own) {
            let source = format!("mean over a population of {count} ships");
            model.coefficients.insert(names[place].clone(), Quantity::new(*value, source));
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_law_with_roll_or_of_the_source_itself_is_refused() {
        let zoo = sistership_model::Zoo::load_embedded().unwrap();
        let law = |name: &str| zoo.law(name).unwrap();
        assert!(check_laws(law("low-speed"), Some(law("mmg"))).is_ok());
        for refused in ["abkowitz-roll", "mmg"] {
            assert!(check_laws(law(refused), Some(law("mmg"))).is_err(), "{refused}");
        }
    }

    #[test]
    fn too_few_ships_are_out_and_no_fault_of_the_settings() {
        let (zoo, target) = (sistership_model::Zoo::load_embedded().unwrap(), "kcs");
        let (model, law) = crate::testing::mariner_model();
        let envelope = OperatingEnvelope::new(&model, &law, &[]).unwrap();
        let none = member_rates(&[], zoo.vessel(target).unwrap(), None, (&envelope, &[]));
        assert!(matches!(none, Err(RefineError::Data(_))), "a search goes on without it");
    }
}
