//! The prior as a mixture of the source and the estimate from particulars. Each gives the ship's
//! accelerations with a Gaussian error whose covariance was learned by leaving ships out.

use std::sync::LazyLock;

use sistership_model::coefficient::Axis;
use sistership_model::law::Law;
use sistership_model::trial::Trial;
use sistership_model::{FileError, Model, Vessel};
use sistership_priors::estimates::{LAW, RegressionLibrary, estimate_ship};

use super::across::SourceRegression;
use super::blocks::RegressionBlocks;
use super::envelope::OperatingEnvelope;
use super::measure::PriorMeasure;
use super::outcome::RefineError;
use super::thresholds::{ErrorCovariance, LEARNED_POSITION, MIXTURE};

/// The regressions of estimates, and the law that they estimate.
struct EstimateRegressions {
    library: RegressionLibrary,
    law: Law,
}

static REGRESSIONS: LazyLock<Result<EstimateRegressions, FileError>> = LazyLock::new(|| {
    let text = include_str!("../../../../../models/laws/mmg.yaml");
    Ok(EstimateRegressions {
        library: RegressionLibrary::parse_embedded()?,
        law: Law::parse(LAW, text)?,
    })
});

fn embedded_regressions() -> Result<&'static EstimateRegressions, RefineError> {
    REGRESSIONS.as_ref().map_err(|error| RefineError::Law(error.to_string()))
}

/// Returns the hash of the regressions that a mixture uses, so that a version records them.
///
/// # Errors
/// Returns an error if the requested regressions are not those of this program.
pub(super) fn regressions_sha256(asked: Option<&str>) -> Result<String, RefineError> {
    let own = &embedded_regressions()?.library.sha256;
    match asked {
        Some(asked) if asked != own => Err(RefineError::Setting {
            field: "regressions_sha256".into(),
            message: format!(
                "this program has the regressions {own}; use the version of \
                              sistership that made these settings"
            ),
        }),
        _ => Ok(own.clone()),
    }
}

/// Refuses a source that is the ship's own model: the covariance of errors was learned from models
/// of other ships.
///
/// # Errors
/// Returns an error if the source is a model of the target.
pub(super) fn check_source(source: &Model, target: &Vessel) -> Result<(), RefineError> {
    if source.ship != target.name() {
        return Ok(());
    }
    let message = format!("`mixture` needs a source model of another ship than {}", target.name());
    Err(RefineError::Setting { field: "prior".into(), message })
}

/// Returns a transferred model of the law that is fitted, shifted towards the estimate, and the
/// measure of the mixture.
///
/// # Errors
/// Returns an error if the ship's particulars do not suffice for an estimate, or the model cannot
/// be simulated.
pub(super) fn mix_same_law(
    mut model: Model,
    law: &Law,
    target: &Vessel,
    (trials, position): (&[&Trial], f64),
) -> Result<(Model, PriorMeasure), RefineError> {
    let envelope = OperatingEnvelope::new(&model, law, trials)?;
    let mixed = mixed_envelope(&envelope, target, model.speed_m_s, (trials, position))?;
    shift_coefficients(&mut model, law, &envelope, &mixed)?;
    Ok((model, PriorMeasure::Mixture(mixed)))
}

/// Returns the envelope of a source, shifted towards the estimate by its shares at a position of
/// the mixture (0 the source, 1 the estimate).
///
/// # Errors
/// Returns an error if the ship's particulars do not suffice for an estimate.
pub(super) fn mixed_envelope(
    envelope: &OperatingEnvelope,
    target: &Vessel,
    speed_m_s: Option<f64>,
    (trials, position): (&[&Trial], f64),
) -> Result<OperatingEnvelope, RefineError> {
    let (estimated, law) = particulars_estimate(target, speed_m_s)?;
    // An axis without a known covariance keeps the source.
    let shares =
        MIXTURE.misfit.map(|misfit| misfit.map_or(0.0, |misfit| share_at(position, misfit)));
    let moved = envelope.shifted_towards((&estimated, law), &shares, trials)?;
    Ok(OperatingEnvelope { mixed: Some(describe_shares(&shares)), ..moved })
}

/// Returns the envelope of the estimate alone, described as such.
pub(super) fn estimate_only(envelope: OperatingEnvelope) -> OperatingEnvelope {
    OperatingEnvelope { mixed: Some(describe_shares(&[1.0; 4])), ..envelope }
}

/// Returns the estimate from the ship's particulars, and its law.
///
/// # Errors
/// Returns an error if the particulars do not suffice, or the speed is not known.
pub(super) fn particulars_estimate(
    target: &Vessel,
    speed_m_s: Option<f64>,
) -> Result<(Model, &'static Law), RefineError> {
    let EstimateRegressions { library, law } = embedded_regressions()?;
    let speed_m_s = speed_m_s.ok_or_else(|| {
        RefineError::Data(format!(
            "{}: the estimate needs an approach speed; give the ship's \
                                   service speed or trials with speed",
            target.name()
        ))
    })?;
    let estimate = estimate_ship(library, target, law, speed_m_s).map_err(|error| {
        RefineError::Data(format!("the estimate for the mixture failed: {error}"))
    })?;
    Ok((estimate.model, law))
}

/// Lets an estimate reach its approach speed at other revolutions. With `s` the ratio of the
/// revolutions, `k_0/s^2`, `k_1/s` and `k_2` give the same thrust `k_0 (nD)^2 + k_1 u_P nD + k_2
/// u_P^2` as before, at every speed and at `s` times the revolutions: the pitch is estimated, the
/// revolutions are read from the trials.
pub(super) fn set_revolutions(estimate: &mut Model, n_rps: f64) {
    let Some(own) = estimate.revolutions_rps.replace(n_rps) else { return };
    let ratio = n_rps / own;
    for (name, by) in [("k_0", ratio.powi(2)), ("k_1", ratio)] {
        if let Some(quantity) = estimate.parameters.get_mut(name) {
            quantity.value /= by;
            quantity.note = Some("for the revolutions of the trials".to_owned());
        }
    }
}

/// The estimate's share at a position: 0 at the source, that of least variance at a half, 1 at the
/// estimate, linear between them.
fn share_at(position: f64, misfit: ErrorCovariance) -> f64 {
    let learned = minimum_variance_share(misfit);
    match position <= LEARNED_POSITION {
        true => learned * position / LEARNED_POSITION,
        false => {
            learned + (1.0 - learned) * (position - LEARNED_POSITION) / (1.0 - LEARNED_POSITION)
        }
    }
}

/// The estimate's share in the mean of least variance: with `C` the covariance of both errors,
/// `C^-1 1 / (1' C^-1 1)` (Bates and Granger 1969, Eq. 2).
fn minimum_variance_share(misfit: ErrorCovariance) -> f64 {
    let ErrorCovariance { source, estimate, common } = misfit;
    ((source - common) / (source + estimate - 2.0 * common)).clamp(0.0, 1.0)
}

/// Shifts a model's coefficients by the difference of the mixture and the source, both regressed on
/// the law's terms alike: where the estimate has no share, the source stays as it is.
fn shift_coefficients(
    model: &mut Model,
    law: &Law,
    own: &OperatingEnvelope,
    mixed: &OperatingEnvelope,
) -> Result<(), RefineError> {
    let blocks = RegressionBlocks::new(model, law)?;
    let towards = SourceRegression::new(mixed, &blocks, model)?;
    // The same ridge for both, so that the difference is not one of regularisation.
    let from = towards.for_envelope(own, &blocks)?;
    let (mut before, mut after) = (model.clone(), model.clone());
    from.set_coefficients(&blocks, &mut before);
    towards.set_coefficients(&blocks, &mut after);
    for (name, quantity) in &mut model.coefficients {
        quantity.value += after.coefficient(name) - before.coefficient(name);
        quantity.source = format!("{}, shifted towards the estimate", quantity.source);
    }
    Ok(())
}

/// Description of the shares for reports.
fn describe_shares(shares: &[f64; 4]) -> String {
    if shares.iter().all(|share| *share == 1.0) {
        return "the prior is the estimate from particulars instead of the source".to_owned();
    }
    let one = |axis: Axis| format!("{axis} {:.2}", shares[axis as usize]);
    let shares = [Axis::X, Axis::Y, Axis::N].map(one).join(", ");
    format!(
        "the prior is a mixture of the source and the estimate from particulars; the shares of \
         the estimate in the accelerations are {shares}"
    )
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use sistership_model::Zoo;
    use sistership_priors::transfer::transfer_model;
    use sistership_simulation::Ship;
    use sistership_simulation::plant::PlantWorkspace;
    use sistership_simulation::state::{StateVector, at};

    #[test]
    fn shares_are_those_of_the_least_variance() {
        let of = |source, estimate, common| {
            minimum_variance_share(ErrorCovariance { source, estimate, common })
        };
        assert_eq!(of(1.0, 1.0, 0.0), 0.5);
        assert_eq!(of(4.0, 1.0, 0.0), 0.8);
        assert_eq!(of(1.0, 9.0, 2.0), 0.0);
        let misfit = ErrorCovariance { source: 4.0, estimate: 1.0, common: 0.0 };
        assert_eq!(
            [0.0, 0.25, 0.5, 0.75, 1.0].map(|p| share_at(p, misfit)),
            [0.0, 0.4, 0.8, 0.9, 1.0]
        );
        // The mean square of the mean by its share is least there.
        let square = |w: f64| (1.0 - w).powi(2) * 2.0 + w * w * 3.0 + 2.0 * w * (1.0 - w) * 0.5;
        let best = of(2.0, 3.0, 0.5);
        assert!(square(best) < square(best + 0.05) && square(best) < square(best - 0.05));
    }

    #[test]
    fn coefficients_say_what_the_mixture_says() {
        let zoo = Zoo::load_embedded().unwrap();
        let source = zoo.find_model("kvlcc2").unwrap();
        let (target, law) = (zoo.vessel("kcs").unwrap(), zoo.law(&source.law).unwrap());
        let carried = transfer_model(&source, law, target, None);
        let own = OperatingEnvelope::new(&carried, law, &[]).unwrap();
        let (model, measure) =
            mix_same_law(carried.clone(), law, target, (&[], LEARNED_POSITION)).unwrap();
        let PriorMeasure::Mixture(mixed) = measure else { panic!("another measure") };
        let said = own.shifted_towards((&model, law), &[1.0; 4], &[]).unwrap();
        for axis in [Axis::X, Axis::Y, Axis::N] {
            let before = own.distance(&mixed, axis);
            assert!(before > 0.0, "{axis}: the estimate says the same");
            assert!(said.distance(&mixed, axis) < 0.3 * before, "{axis}");
        }
    }

    #[test]
    fn an_estimate_makes_its_speed_at_the_revolutions_of_the_trials() {
        let zoo = Zoo::load_embedded().unwrap();
        let (mut model, law) =
            particulars_estimate(zoo.vessel("kcs").unwrap(), Some(12.0)).unwrap();
        let gained = |model: &Model, n_rps: f64| {
            let ship = Ship::new(model, law).unwrap();
            let state = StateVector::from_fn(|place, _| if place == at::U { 12.0 } else { 0.0 });
            ship.rate_with(&state, &ship.inputs_for(0.0, n_rps), &mut PlantWorkspace::default())
                [at::U]
        };
        let own = model.revolutions_rps.unwrap();
        let before = gained(&model, 0.9 * own);
        set_revolutions(&mut model, 1.3 * own);
        assert_eq!(model.revolutions_rps, Some(1.3 * own));
        assert!(gained(&model, 1.3 * own).abs() < 1e-6 && before < -1e-3);
        assert!((gained(&model, 1.3 * 0.9 * own) - before).abs() < 1e-9);
    }

    #[test]
    fn a_ships_own_model_and_other_regressions_are_refused() {
        let zoo = Zoo::load_embedded().unwrap();
        let target = zoo.vessel("kvlcc2").unwrap();
        assert!(check_source(&zoo.find_model("kvlcc2").unwrap(), target).is_err());
        assert!(check_source(&zoo.find_model("mariner").unwrap(), target).is_ok());
        let own = regressions_sha256(None).unwrap();
        assert_eq!(regressions_sha256(Some(&own)).unwrap(), own);
        assert!(regressions_sha256(Some("0")).unwrap_err().to_string().contains(&own));
    }
}
