//! Extension of a 3-DOF source model to a 4-DOF law.
//!
//! A 3-DOF source has no information on roll, and a fit without a prior on roll determines the
//! terms of heel only within the few degrees of the trials: at larger heel the ship capsizes. The
//! hydrostatic terms follow from the ship's particulars; with them the source model simulates the
//! standard manoeuvres, where each term is evaluated.

use sistership_model::coefficient::Axis;
use sistership_model::law::{AxisLaw, Law};
use sistership_model::quantity::Quantity;
use sistership_model::{Model, Vessel, particulars};

use crate::transfer::{TrialApproach, blank_from_source};

/// `zeta`: damping in roll by the critical damping, dimensionless. Source: chosen; trials correct
/// it, and `docs/evidence/plain.md` has half and double.
const DAMPING: f64 = 0.1;
/// Acceleration of gravity, m/s2.
const GRAVITY: f64 = 9.806_65;
/// Names of the coefficients of the roll moment by `phi g L/U^2` and by `p L/U` in laws with roll.
const STIFFNESS_AND_DAMPING: [&str; 2] = ["K_heel", "K_p"];

/// Source of the two in quantities.
pub const HYDROSTATICS: &str = "hydrostatics";

/// Extends a source model that was transferred to a ship to a law with the same terms in surge,
/// sway and yaw, with the stiffness by the ship's metacentric height and a usual damping. Returns
/// `None` where the source has roll itself, the laws differ in the plane, or the ship's particulars
/// do not give the stiffness.
pub fn with_roll(
    (carried, own): (&Model, &Law),
    law: &Law,
    target: &Vessel,
    approach: Option<TrialApproach>,
) -> Option<Model> {
    if own.has_roll() || !law.has_roll() || !has_same_meaning(own, law, carried) {
        return None;
    }
    let mut rolling = Model {
        name: format!("{}/{}", target.name(), law.name),
        law: law.name.clone(),
        parameters: blank_from_source(law, target, carried, approach).ok()?.parameters,
        ..carried.clone()
    };
    let roll = hydrostatic_coefficients(&rolling, law)?;
    rolling.coefficients.extend(roll);
    Some(rolling)
}

/// Coefficients of roll by the stiffness of a ship's metacentric height and a usual damping. `None`
/// where its particulars do not give the stiffness, or the law does not have the two coefficients.
pub fn hydrostatic_coefficients(model: &Model, law: &Law) -> Option<[(String, Quantity); 2]> {
    let [stiffness, damping] = stiffness_and_damping(model, law)?;
    let named = |(name, value): (&str, f64)| (name.to_owned(), Quantity::new(value, HYDROSTATICS));
    let [by_heel, by_rate] = STIFFNESS_AND_DAMPING;
    Some([(by_heel, stiffness), (by_rate, damping)].map(named))
}

/// Returns true if all coefficients of a model have the same meaning in another law.
fn has_same_meaning(own: &Law, law: &Law, model: &Model) -> bool {
    let is_kept = |(name, value): (&String, _)| law.values.get(name) == Some(value);
    let as_before = |axis: &Axis, of: &AxisLaw| {
        law.axes.get(axis).is_some_and(|other| other.scale == of.scale && other.rest == of.rest)
    };
    // Both laws have the coefficient, on the same axis with the same regressor.
    let spelled = |name: &String| {
        own.unscaled_regressor(name).is_ok()
            && own.unscaled_regressor(name) == law.unscaled_regressor(name)
    };
    own.values.iter().all(is_kept)
        && own.axes.iter().all(|(axis, of)| as_before(axis, of))
        && model.coefficients.keys().all(spelled)
}

/// Values of [`STIFFNESS_AND_DAMPING`] by `0.5 rho L^3 U^2`: a metacentric height `GM` of a volume
/// `V` gives the righting moment `rho g V GM phi`.
fn stiffness_and_damping(model: &Model, law: &Law) -> Option<[f64; 2]> {
    let is_open = law.axes.get(&Axis::K)?.open;
    let is_spelled = STIFFNESS_AND_DAMPING.iter().all(|name| law.unscaled_regressor(name).is_ok());
    let of_ship = |name: &str| particulars::particular_value(&model.particulars, name);
    let stable = of_ship("gm_m").filter(|gm_m| is_open && is_spelled && *gm_m > 0.0)?;
    let (volume, length) = (of_ship("displacement_m3")?, of_ship("lpp_m")?);
    let speed = model.speed_m_s.filter(|speed| *speed > 0.0)?;
    let parameter = |name: &str| Some(model.parameters.get(name)?.value);
    let inertia = parameter("I_x")? - parameter("K_pdot")?;
    let stiffness = 2.0 * volume * stable / length.powi(4);
    // The critical damping of a harmonic oscillator, 2 sqrt(stiffness inertia), in the same units.
    let critical = 2.0 * (stiffness * GRAVITY * length / speed.powi(2) * inertia).sqrt();
    Some([-stiffness, -DAMPING * critical]).filter(|both| both.iter().all(|one| one.is_finite()))
}

/// Remark on the prior of roll for a source without roll.
pub fn roll_remark(carried: &Model) -> Option<String> {
    let is_hydrostatic = |quantity: &&Quantity| quantity.source == HYDROSTATICS;
    carried.coefficients.values().find(is_hydrostatic)?;
    let what = "the source has no roll: the prior of roll is the restoring moment of the ship's \
                metacentric height and a tenth of the critical damping";
    Some(what.to_owned())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use sistership_model::Zoo;
    use sistership_simulation::Ship;
    use sistership_simulation::manoeuvre::{
        ManoeuvreSettings, STANDARD_MANOEUVRES, simulate_manoeuvre_batch,
    };

    use super::*;
    use crate::transfer::transfer_model;

    fn carried(source: &str, law: &str, ship: &str) -> Option<Model> {
        let zoo = Zoo::load_embedded().unwrap();
        let source = zoo.find_model(source).unwrap();
        let approach = TrialApproach { speed_m_s: 8.377, n_rps: None };
        let own = zoo.law(&source.law).unwrap();
        let target = zoo.vessel(ship).unwrap();
        let carried = transfer_model(&source, own, target, Some(approach));
        with_roll((&carried, own), zoo.law(law).unwrap(), target, Some(approach))
    }

    #[test]
    fn the_mariner_rolls_by_the_container_ship_s_hydrostatics() {
        let zoo = Zoo::load_embedded().unwrap();
        let model = carried("mariner", "abkowitz-roll", "sr108").unwrap();
        let mariner = zoo.find_model("mariner").unwrap();
        assert_eq!(model.coefficient("N_vvr"), mariner.coefficient("N_vvr"));
        // Son and Nomoto: GM 0.3 m, 21222 m3, 175 m.
        let stiffness = 2.0 * 21_222.0 * 0.3 / 175_f64.powi(4);
        assert!((model.coefficient("K_heel") / -stiffness - 1.0).abs() < 1e-12);
        assert!(model.coefficient("K_p") < 0.0);
        let ship = Ship::new(&model, zoo.law("abkowitz-roll").unwrap()).unwrap();
        let standard = STANDARD_MANOEUVRES.map(|manoeuvre| (manoeuvre, &[][..]));
        let sailed = simulate_manoeuvre_batch(&ship, &standard, &ManoeuvreSettings::default());
        assert!(sailed.iter().all(Result::is_ok), "sails every standard manoeuvre");
    }

    #[test]
    fn free_decay_has_the_period_and_the_damping_that_hydrostatics_give() {
        let model = carried("mariner", "abkowitz-roll", "sr108").unwrap();
        let of = |name: &str| model.parameters[name].value;
        let (length, speed) = (175.0, 8.377);
        let inertia = of("I_x") - of("K_pdot");
        // phi'' inertia = K_p phi' + K_heel g L/U^2 phi, in the time L/U.
        let frequency = (-model.coefficient("K_heel") * GRAVITY * length / speed / speed / inertia)
            .sqrt()
            * speed
            / length;
        let share = -model.coefficient("K_p") / (2.0 * inertia * frequency * length / speed);
        assert!((share - DAMPING).abs() < 1e-12);
        // 2 pi k/sqrt(g GM) with k = 0.38 B.
        let period = std::f64::consts::TAU * 0.38 * 25.4 / (GRAVITY * 0.3_f64).sqrt();
        assert!((std::f64::consts::TAU / frequency / period - 1.0).abs() < 1e-9);
    }

    #[test]
    fn what_says_something_else_or_rolls_itself_is_left_alone() {
        assert!(carried("kcs", "abkowitz-roll", "sr108").is_none(), "mmg scales otherwise");
        assert!(carried("mariner", "abkowitz", "sr108").is_none());
        assert!(carried("wpcc", "abkowitz-roll", "sr108").is_none());
        assert!(carried("mariner", "abkowitz-roll", "kvlcc2").is_none(), "no metacentric height");
    }
}
