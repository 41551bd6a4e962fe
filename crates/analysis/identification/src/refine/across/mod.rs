//! A source of one law as the prior of another.
//!
//! A source's information on a ship of another law is not its coefficients but its accelerations.
//! They are regressed on the terms of the fitted law over the envelope in which the model will be
//! used ([`OperatingEnvelope`]): mean and covariance of that regression are the prior
//! ([`SourceRegression`]). docs/decisions/0015 has the reasons.

mod plane_source;
mod source_envelopes;
mod source_regression;

use std::sync::Arc;

use sistership_model::law::Law;
use sistership_model::trial::Trial;
use sistership_model::{Model, Vessel};

use super::envelope::OperatingEnvelope;
use super::outcome::RefineError;
pub(super) use plane_source::PlaneSource;
use sistership_priors::transfer::{TrialApproach, blank_from_source, transfer_model};
pub use source_envelopes::SourceEnvelopes;
pub(super) use source_regression::SourceRegression;

/// Returns a source transferred to a ship by its own law; unchanged if it is a model of that ship.
pub(super) fn transfer_source(
    (source, own): (&Model, &Law),
    target: &Vessel,
    approach: Option<TrialApproach>,
) -> Model {
    if source.ship == target.name() {
        return source.clone();
    }
    transfer_model(source, own, target, approach)
}

/// Returns a model of the fitted law without coefficients, and the envelope of a source that is
/// transferred to the target by its own law.
pub(super) fn blank_with_envelope(
    (source, own): (&Model, &Law),
    law: &Law,
    target: &Vessel,
    approach: Option<TrialApproach>,
    (trials, known): (&[&Trial], &SourceEnvelopes),
) -> Result<(Model, Arc<OperatingEnvelope>), RefineError> {
    let carried = transfer_source((source, own), target, approach);
    let envelope = known.source_envelope((source, own), || {
        let envelope = OperatingEnvelope::new(&carried, own, trials)?;
        Ok(OperatingEnvelope { source: source.name.clone(), ..envelope })
    })?;
    let mut model = blank_from_source(law, target, &carried, approach)?;
    // Approach and steering gear are properties of the ship, whatever the law.
    (model.speed_m_s, model.revolutions_rps) = (carried.speed_m_s, carried.revolutions_rps);
    model.steering = carried.steering;
    model.note = Some(format!("regressed on the accelerations of {}", source.name));
    Ok((model, envelope.for_law(law)))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use sistership_model::Zoo;

    use crate::refine::{EstimationMethod, Refinement, RefinementSettings, RefinementSpec, refine};
    use crate::testing::simulated_trials;

    /// The Mariner, which does not roll, as the source of a container ship that does.
    fn by_the_mariner() -> Refinement {
        by("mariner", RefinementSettings::default())
    }

    fn by(source: &str, settings: RefinementSettings) -> Refinement {
        let zoo = Zoo::load_embedded().unwrap();
        let [truth, source] = ["sr108", source].map(|name| zoo.find_model(name).unwrap());
        let law = |name: &str| zoo.law(name).unwrap();
        let trials = simulated_trials(&truth, law(&truth.law), 0.001);
        let settings = RefinementSettings {
            method: EstimationMethod::Weak,
            strengths: vec![1e-3, 1e-4],
            ..settings
        };
        let request = RefinementSpec {
            target: zoo.vessel("sr108").unwrap(),
            source: &source,
            source_law: Some(law(&source.law)),
            law: law("abkowitz-roll"),
            trials: &trials.iter().collect::<Vec<_>>(),
            population: &[],
            settings: &settings,
        };
        refine(&request, &|_, _| true).unwrap()
    }

    #[test]
    fn a_source_of_the_plane_turns_the_ship_and_hydrostatics_roll_it() {
        let made = by("kcs", RefinementSettings::default());
        let begun = &made.transferred;
        assert!(begun.coefficient("Y_v") < 0.0 && begun.coefficient("N_delta") != 0.0);
        assert!(begun.coefficient("K_heel") < 0.0 && !begun.coefficients.contains_key("K_v"));
        assert!(made.remarks.iter().any(|remark| remark.contains("its own revolutions")));
        let of = |errors: &std::collections::BTreeMap<_, f64>| errors["psi"];
        assert!(of(&made.held_out.refined) < 0.2 * of(&made.held_out.source));
        assert!(of(&made.held_out.source) < 1.0, "it turns as ships do, rad");
    }

    #[test]
    fn what_the_plane_does_not_say_is_held_where_it_is() {
        let weak = RefinementSettings::default();
        let strong = RefinementSettings { roll_strength: Some(1e12), ..weak.clone() };
        let moved = |settings| {
            let made = by("kcs", settings);
            let rolls = made.model.coefficients.keys().filter(|name| name.starts_with("K_"));
            let squares = rolls.map(|name| {
                (made.model.coefficient(name) - made.transferred.coefficient(name)).powi(2)
            });
            squares.sum::<f64>()
        };
        let (free, held) = (moved(weak), moved(strong));
        assert!(held < 1e-3 * free, "{held} of {free}");
    }

    #[test]
    fn roll_begins_with_hydrostatics() {
        let made = by_the_mariner();
        assert!(made.model.coefficients.contains_key("Y_phi"), "third order");
        assert!(made.transferred.coefficient("K_heel") < 0.0);
        assert!(made.remarks.iter().any(|remark| remark.contains("metacentric height")));
        let of = |errors: &std::collections::BTreeMap<_, f64>| {
            errors[&sistership_model::trial::Channel::Psi.name().to_owned()]
        };
        assert!(of(&made.held_out.refined) < 0.2 * of(&made.held_out.source));
    }
}
