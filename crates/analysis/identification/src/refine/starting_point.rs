//! The starting point of a refinement: the model of the prior's mean, and the measure of the prior.

use std::sync::Arc;

use sistership_model::Model;
use sistership_model::law::Law;
use sistership_model::trial::Trial;

use super::across::{self, PlaneSource, SourceEnvelopes, SourceRegression};
use super::blocks::RegressionBlocks;
use super::envelope::OperatingEnvelope;
use super::measure::PriorMeasure;
use super::mixture;
use super::outcome::RefineError;
use super::population;
use super::request::RefinementSpec;
use super::settings::Prior;
use super::thresholds::{ESTIMATE_POSITION, LEARNED_POSITION};
use super::unrecorded;
use sistership_numerics::merge_trials;
use sistership_priors::rolling::with_roll;
use sistership_priors::transfer::TrialApproach;
use sistership_propulsion::needs_balance;

/// The request and the trials by which it is refined.
pub(super) struct StartingPoint<'s, 'a> {
    pub request: &'s RefinementSpec<'a>,
    pub known: &'s SourceEnvelopes,
    /// The whole trials that are used.
    pub whole: &'s [&'a Trial],
    pub approach: Option<TrialApproach>,
}

impl<'a> StartingPoint<'_, 'a> {
    /// Returns the source as it is transferred by its own law, if it is the prior and that law has
    /// a propeller of its own.
    pub fn source_propeller(&self) -> Option<(Model, &'a Law)> {
        let RefinementSpec { target, source, source_law, law, settings, .. } = *self.request;
        let own = source_law.unwrap_or(law);
        (settings.prior == Prior::Source && !needs_balance(own))
            .then(|| (across::transfer_source((source, own), target, self.approach), own))
    }

    /// Returns the mean of the prior, which is the transferred source or its regression on another
    /// law, and the prior's measure.
    ///
    /// # Errors
    /// Returns an error if the prior does not suit the source or the law, or the source cannot be
    /// simulated.
    pub fn starting_prior(&self, in_parts: bool) -> Result<(Model, PriorMeasure), RefineError> {
        let RefinementSpec { target, source, source_law, law, settings, .. } = *self.request;
        match settings.prior {
            Prior::Mixture => mixture::check_source(source, target)?,
            Prior::Population => population::check_laws(law, source_law)?,
            Prior::Source => {}
        }
        // Without a law of its own the source has the law that is fitted.
        let Some(own) = source_law.filter(|own| own.name != law.name) else {
            return self.start_same_law(in_parts);
        };
        // A law that agrees with the source's in the plane keeps the source's coefficients and adds
        // roll from hydrostatics; no regression is needed.
        if settings.prior == Prior::Source {
            let carried = across::transfer_source((source, own), target, self.approach);
            if let Some(rolling) = with_roll((&carried, own), law, target, self.approach) {
                let measure = PriorMeasure::for_own_law(&rolling, law, self.whole, in_parts);
                return Ok((rolling, measure));
            }
        }
        self.start_another_law(own)
    }

    /// The start from a source of the law that is fitted.
    fn start_same_law(&self, in_parts: bool) -> Result<(Model, PriorMeasure), RefineError> {
        let RefinementSpec { target, source, law, settings, .. } = *self.request;
        let mut carried = across::transfer_source((source, law), target, self.approach);
        unrecorded::remove_unrecorded_terms(&mut carried, law, self.whole);
        if settings.prior == Prior::Mixture {
            return mixture::mix_same_law(
                carried,
                law,
                target,
                (self.whole, self.mixture_position()),
            );
        }
        let measure = PriorMeasure::for_own_law(&carried, law, self.whole, in_parts);
        Ok((carried, measure))
    }

    /// The start from a source of another law.
    fn start_another_law(&self, own: &Law) -> Result<(Model, PriorMeasure), RefineError> {
        let RefinementSpec { law, settings, .. } = *self.request;
        let (mut model, envelope) = match settings.prior {
            Prior::Mixture => self.mixed_start(own)?,
            Prior::Source | Prior::Population => self.blank_start(own)?,
        };
        unrecorded::remove_unrecorded_terms(&mut model, law, self.whole);
        if settings.prior == Prior::Population {
            return self.population_start(model, envelope);
        }
        if law.has_roll() && !envelope.roll {
            let source = PlaneSource::from_upright(envelope, &mut model, law, self.whole)?;
            return Ok((model, PriorMeasure::Plane(source)));
        }
        let blocks = RegressionBlocks::new(&model, law)?;
        SourceRegression::new(&envelope, &blocks, &model)?.set_coefficients(&blocks, &mut model);
        Ok((model, PriorMeasure::Source(envelope)))
    }

    /// A model without coefficients, and the envelope of the source.
    fn blank_start(&self, own: &Law) -> Result<(Model, Arc<OperatingEnvelope>), RefineError> {
        let RefinementSpec { target, source, law, .. } = *self.request;
        across::blank_with_envelope(
            (source, own),
            law,
            target,
            self.approach,
            (self.whole, self.known),
        )
    }

    /// A model without coefficients, and the envelope of a mixture. At the end of the mixture it is
    /// the envelope of the estimate by the estimate's own manoeuvres, not those of the source.
    fn mixed_start(&self, own: &Law) -> Result<(Model, Arc<OperatingEnvelope>), RefineError> {
        let RefinementSpec { target, law, .. } = *self.request;
        let (model, envelope) = self.blank_start(own)?;
        if self.mixture_position() != ESTIMATE_POSITION {
            let by = (self.whole, self.mixture_position());
            let mixed = mixture::mixed_envelope(&envelope, target, model.speed_m_s, by)?;
            return Ok((model, Arc::new(mixed)));
        }
        let (mut estimated, own) = mixture::particulars_estimate(target, model.speed_m_s)?;
        // The trials' revolutions give the approach speed, not those that the estimate's own
        // propeller would need.
        if let Some(n_rps) = self.approach.and_then(|approach| approach.n_rps) {
            mixture::set_revolutions(&mut estimated, n_rps);
        }
        // The estimate's envelope is not shared: it depends on the ship's approach, not on a
        // source.
        let of = (self.whole, &SourceEnvelopes::default());
        let (model, envelope) =
            across::blank_with_envelope((&estimated, own), law, target, self.approach, of)?;
        Ok((model, Arc::new(mixture::estimate_only(Arc::unwrap_or_clone(envelope)))))
    }

    /// The start from a population at the states of a source's envelope, in place of that source.
    fn population_start(
        &self,
        mut model: Model,
        envelope: Arc<OperatingEnvelope>,
    ) -> Result<(Model, PriorMeasure), RefineError> {
        let RefinementSpec { target, law, population, .. } = *self.request;
        let at = (&*envelope, self.whole);
        let ask = || population::member_rates(population, target, self.approach, at);
        let members = self.known.population_rates(&envelope, ask)?;
        let mut blocks = RegressionBlocks::new(&model, law)?;
        let sizes = merge_trials(&envelope.group_moments(&blocks)?, |_| true).unwrap_or_default();
        let measure = PriorMeasure::Population(envelope.clone(), members);
        measure.apply_to(&mut blocks, &mut model, &sizes)?;
        model.note = Some("prior from a population of ships".to_owned());
        Ok((model, measure))
    }

    /// Position of a mixture between source and estimate.
    fn mixture_position(&self) -> f64 {
        let asked = &self.request.settings.mixture_positions;
        asked.first().copied().unwrap_or(LEARNED_POSITION)
    }
}
