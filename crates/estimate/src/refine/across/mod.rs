//! A source of one law as the prior of another.
//!
//! What a source says of a ship is not its coefficients but its accelerations. Where they are to
//! hold another law, they are regressed on its terms over the envelope in which the model will be
//! used ([`OperatingEnvelope`]): mean and covariance of that regression are the prior
//! ([`SourceRegression`]). docs/decisions/0015 has the reasons.

mod source_envelopes;
mod source_regression;

use std::sync::Arc;

use sistership_model::law::Law;
use sistership_model::trial::Trial;
use sistership_model::{Model, Vessel};

use super::envelope::OperatingEnvelope;
use super::outcome::RefineError;
use sistership_sources::transfer::{Approach, blank_of, transfer};
pub use source_envelopes::SourceEnvelopes;
pub(super) use source_regression::SourceRegression;

/// A source carried over to the target by its own law, and a model of the law to be fitted that
/// knows nothing yet.
pub(super) fn begun(
    (source, own): (&Model, &Law),
    law: &Law,
    target: &Vessel,
    approach: Option<Approach>,
    (trials, known): (&[&Trial], &SourceEnvelopes),
) -> Result<(Model, Arc<OperatingEnvelope>), RefineError> {
    let carried = if source.ship == target.name() {
        source.clone()
    } else {
        transfer(source, own, target, approach)
    };
    let envelope = known.of((source, own), || {
        let envelope = OperatingEnvelope::new(&carried, own, trials)?;
        Ok(OperatingEnvelope { source: source.name.clone(), ..envelope })
    })?;
    let mut model = blank_of(law, target, &carried, approach)?;
    (model.speed_m_s, model.revolutions_rps) = (carried.speed_m_s, carried.revolutions_rps);
    model.steering = carried.steering;
    model.note = Some(format!("regressed on what {} says", source.name));
    Ok((model, envelope))
}
