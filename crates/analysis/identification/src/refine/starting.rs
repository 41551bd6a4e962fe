//! The starting point of a refinement: the model of the prior's mean, and the measure of the prior.

use std::sync::Arc;

use sistership_model::Model;
use sistership_model::law::Law;
use sistership_model::trial::Trial;

use super::across::{self, PlaneSource, SourceEnvelopes, SourceRegression};
use super::blocks::Blocks;
use super::envelope::OperatingEnvelope;
use super::measure::PriorMeasure;
use super::mixture;
use super::outcome::RefineError;
use super::population;
use super::request::Request;
use super::settings::Prior;
use super::thresholds::{ESTIMATE_POSITION, LEARNED_POSITION};
use super::unrecorded;
use sistership_numerics::merged;
use sistership_priors::rolling::with_roll;
use sistership_priors::transfer::Approach;

/// The request and the trials by which it is refined.
pub(super) struct Starting<'a> {
    pub request: &'a Request<'a>,
    pub known: &'a SourceEnvelopes,
    /// The whole trials that are used.
    pub whole: &'a [&'a Trial],
    pub approach: Option<Approach>,
}

impl Starting<'_> {
    /// Returns the mean of the prior, which is the transferred source or its regression on another
    /// law, and the prior's measure.
    ///
    /// # Errors
    /// Returns an error if the prior does not suit the source or the law, or the source cannot be
    /// simulated.
    pub fn prior(&self, in_parts: bool) -> Result<(Model, PriorMeasure), RefineError> {
        let Request { target, source, source_law, law, settings, .. } = *self.request;
        match settings.prior {
            Prior::Mixture => mixture::check(source, target)?,
            Prior::Population => population::check(law, source_law)?,
            Prior::Source => {}
        }
        // Without a law of its own the source has the law that is fitted.
        let Some(own) = source_law.filter(|own| own.name != law.name) else {
            return self.of_same_law(in_parts);
        };
        // A law that agrees with the source's in the plane keeps the source's coefficients and adds
        // roll from hydrostatics; no regression is needed.
        if settings.prior == Prior::Source && settings.hydrostatic_roll {
            let carried = across::carried_over((source, own), target, self.approach);
            if let Some(rolling) = with_roll((&carried, own), law, target, self.approach) {
                let measure = PriorMeasure::own(&rolling, law, self.whole, in_parts);
                return Ok((rolling, measure));
            }
        }
        self.of_another_law(own)
    }

    /// The start from a source of the law that is fitted.
    fn of_same_law(&self, in_parts: bool) -> Result<(Model, PriorMeasure), RefineError> {
        let Request { target, source, law, settings, .. } = *self.request;
        let mut carried = across::carried_over((source, law), target, self.approach);
        if settings.recorded_terms {
            unrecorded::forget(&mut carried, law, self.whole);
        }
        if settings.prior == Prior::Mixture {
            return mixture::of_same_law(carried, law, target, (self.whole, self.position()));
        }
        let measure = PriorMeasure::own(&carried, law, self.whole, in_parts);
        Ok((carried, measure))
    }

    /// The start from a source of another law.
    fn of_another_law(&self, own: &Law) -> Result<(Model, PriorMeasure), RefineError> {
        let Request { law, settings, .. } = *self.request;
        let (mut model, envelope) = match settings.prior {
            Prior::Mixture => self.mixed(own)?,
            Prior::Source | Prior::Population => self.begun(own)?,
        };
        if settings.recorded_terms {
            unrecorded::forget(&mut model, law, self.whole);
        }
        if settings.prior == Prior::Population {
            return self.held_by_population(model, envelope);
        }
        if settings.plane_source && law.has_roll() && !envelope.roll {
            let source = PlaneSource::begin(envelope, &mut model, law, self.whole)?;
            return Ok((model, PriorMeasure::Plane(source)));
        }
        let blocks = Blocks::new(&model, law)?;
        SourceRegression::new(&envelope, &blocks, &model)?.fill(&blocks, &mut model);
        Ok((model, PriorMeasure::Source(envelope)))
    }

    /// A model without coefficients, and the envelope of the source.
    fn begun(&self, own: &Law) -> Result<(Model, Arc<OperatingEnvelope>), RefineError> {
        let Request { target, source, law, .. } = *self.request;
        across::begun((source, own), law, target, self.approach, (self.whole, self.known))
    }

    /// A model without coefficients, and the envelope of a mixture. At the end of the mixture it is
    /// the envelope of the estimate by the estimate's own manoeuvres, not those of the source.
    fn mixed(&self, own: &Law) -> Result<(Model, Arc<OperatingEnvelope>), RefineError> {
        let Request { target, law, settings, .. } = *self.request;
        let (model, envelope) = self.begun(own)?;
        if self.position() != ESTIMATE_POSITION {
            let by = (self.whole, self.position());
            let mixed = mixture::mixed(&envelope, target, model.speed_m_s, by)?;
            return Ok((model, Arc::new(mixed)));
        }
        let (mut estimated, own) = mixture::estimated(target, model.speed_m_s)?;
        if let Some(n_rps) = self.approach.and_then(|approach| approach.n_rps)
            && settings.recorded_revolutions
        {
            mixture::turn_at(&mut estimated, n_rps);
        }
        // The estimate's envelope is not shared: it depends on the ship's approach, not on a
        // source.
        let of = (self.whole, &SourceEnvelopes::default());
        let (model, envelope) = across::begun((&estimated, own), law, target, self.approach, of)?;
        Ok((model, Arc::new(mixture::alone(Arc::unwrap_or_clone(envelope)))))
    }

    /// The start from a population at the states of a source's envelope, in place of that source.
    fn held_by_population(
        &self,
        mut model: Model,
        envelope: Arc<OperatingEnvelope>,
    ) -> Result<(Model, PriorMeasure), RefineError> {
        let Request { target, law, population, .. } = *self.request;
        let at = (&*envelope, self.whole);
        let ask = || population::rates_of(population, target, self.approach, at);
        let members = self.known.population(&envelope, ask)?;
        let mut blocks = Blocks::new(&model, law)?;
        let sizes = merged(&envelope.moments(&blocks)?, |_| true).unwrap_or_default();
        let measure = PriorMeasure::Population(envelope.clone(), members);
        measure.hold(&mut blocks, &mut model, &sizes)?;
        model.note = Some("held by what a population of ships says".to_owned());
        Ok((model, measure))
    }

    /// Position of a mixture between source and estimate.
    fn position(&self) -> f64 {
        let asked = &self.request.settings.mixture_positions;
        asked.first().copied().unwrap_or(LEARNED_POSITION)
    }
}
