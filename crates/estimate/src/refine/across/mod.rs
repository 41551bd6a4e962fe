//! A source of one law as the prior of another.
//!
//! What a source says of a ship is not its coefficients but its accelerations. Where they are to
//! hold another law, they are regressed on its terms over the envelope in which the model will be
//! used ([`OperatingEnvelope`]): mean and covariance of that regression are the prior
//! ([`SourceRegression`]). docs/decisions/0015 has the reasons.

mod source_regression;

use sistership_model::law::Law;
use sistership_model::trial::Trial;
use sistership_model::{Model, Vessel};

use super::envelope::OperatingEnvelope;
use super::outcome::RefineError;
use crate::transfer::{Approach, blank_of, transfer};
pub(super) use source_regression::SourceRegression;

/// A source carried over to the target by its own law, and a model of the law to be fitted that
/// knows nothing yet.
pub(super) fn begun(
    (source, own): (&Model, &Law),
    law: &Law,
    target: &Vessel,
    approach: Option<Approach>,
    trials: &[&Trial],
) -> Result<(Model, OperatingEnvelope), RefineError> {
    let carried = if source.ship == target.name() {
        source.clone()
    } else {
        transfer(source, own, target, approach)
    };
    let envelope = OperatingEnvelope {
        source: source.name.clone(),
        ..OperatingEnvelope::new(&carried, own, trials)?
    };
    let mut model = blank_of(law, target, &carried, approach)?;
    (model.speed_m_s, model.revolutions_rps) = (carried.speed_m_s, carried.revolutions_rps);
    model.steering = carried.steering;
    model.note = Some(format!("regressed on what {} says", source.name));
    Ok((model, envelope))
}
