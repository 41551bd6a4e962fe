//! The weak form on the same manoeuvres: velocities with the paper's noise and nothing else of the
//! plane, roll with a like noise where it is used. Terms and strength of the prior are chosen by
//! manoeuvres left out, the turns of the table never seen.

use rand_chacha::ChaCha8Rng;
use sistership_identification::refine::{
    EstimationMethod, RefinementSettings, RefinementSpec, TermFamily, refine,
};
use sistership_model::law::Law;
use sistership_model::quantity::Quantity;
use sistership_model::trial::{Channel, Trial};
use sistership_model::{Model, Zoo, particulars};
use sistership_simulation::state::at;

use super::refined::{NOISE, TURNS, ZIGZAGS, noisy};
use super::truth::{FITTED, Truth, recorded};

/// Noise of roll: the yaw rate's, on the angle (rad) and its rate (rad/s).
const ROLL: [(Channel, usize, f64); 2] =
    [(Channel::Phi, at::PHI, NOISE[2].2), (Channel::P, at::P, NOISE[2].2)];

/// A source refined by the weak form on some zigzags and the turns to both sides.
pub fn refined(
    zoo: &Zoo,
    law: &Law,
    source: &Model,
    truth: &Truth,
    zigzags: &[(f64, f64)],
    rng: &mut ChaCha8Rng,
) -> Model {
    let mut tracks: Vec<_> = zigzags
        .iter()
        .map(|&(rudder_deg, heading_deg)| truth.zigzag(rudder_deg, heading_deg))
        .collect();
    tracks.extend(TURNS.map(|rudder_deg| truth.turn(rudder_deg)));
    let trials: Vec<Trial> = tracks.iter().map(|track| measured(track, rng)).collect();
    let trials: Vec<&Trial> = trials.iter().collect();
    // Of roll the source says nothing, so that its own terms are no choice.
    let families = if law.has_roll() { vec![TermFamily::ThirdOrder] } else { Vec::new() };
    let settings = RefinementSettings {
        method: EstimationMethod::Weak,
        families,
        ..RefinementSettings::default()
    };
    let target = zoo.vessel("sr108").expect("a ship of the zoo");
    let request = RefinementSpec {
        target,
        source,
        source_law: None,
        law,
        trials: &trials,
        population: &[],
        settings: &settings,
    };
    refine(&request, &|_, _| true).unwrap_or_else(|error| panic!("{error}")).model
}

/// The zigzags of each single data set, and all of them in one.
pub fn single() -> Vec<Vec<(f64, f64)>> {
    ZIGZAGS.iter().map(|zigzag| vec![*zigzag]).collect()
}

/// All zigzags in one data set.
pub fn pooled() -> Vec<Vec<(f64, f64)>> {
    vec![ZIGZAGS.to_vec()]
}

/// A track with the paper's noise, and a like noise of roll; nothing of the plane but velocities.
pub fn measured(track: &sistership_simulation::Trajectory, rng: &mut ChaCha8Rng) -> Trial {
    let mut trial = recorded(track, FITTED);
    for (channel, index, deviation) in ROLL.into_iter().chain(NOISE) {
        trial.channels.insert(channel, noisy(track, index, deviation, rng));
    }
    [Channel::X, Channel::Y, Channel::Psi]
        .iter()
        .for_each(|channel| drop(trial.channels.remove(channel)));
    trial
}

/// Share of the critical damping that roll starts with; a judgement that the trials correct.
const DAMPING: f64 = 0.1;

/// The source in the plane, carried over to the law with roll: the true ship's inertia and
/// hydrostatic stiffness, a usual damping, and no other coefficient of roll.
pub fn with_roll(source: &Model, law: &Law, truth: &Truth) -> Model {
    let own = |name: &str| truth.model.parameters[name].value;
    let coupling = own("m_y") * own("l_y");
    let masses =
        [("I_x", own("I_x")), ("K_pdot", -own("J_x")), ("Y_pdot", coupling), ("K_vdot", coupling)];
    let mut model = source.clone();
    model.law.clone_from(&law.name);
    model.parameters.extend(
        masses.map(|(name, value)| {
            (name.to_owned(), Quantity::new(value, truth.model.name.as_str()))
        }),
    );
    let of_ship = |name: &str| {
        particulars::particular_value(&truth.model.particulars, name)
            .expect("a particular of the true ship")
    };
    let length = of_ship("lpp_m");
    let stiffness = 2.0 * of_ship("displacement_m3") * of_ship("gm_m") / length.powi(4);
    // By 0.5 rho L^5 and the time L/U, as the law scales them; gravity by its own.
    let gravity = 9.806_65 * length / truth.speed_m_s.powi(2);
    let damping = 2.0 * DAMPING * (stiffness * gravity * (own("I_x") + own("J_x"))).sqrt();
    for (name, value) in [("K_heel", -stiffness), ("K_p", -damping)] {
        model.coefficients.insert(name.to_owned(), Quantity::new(value, "hydrostatics"));
    }
    model
}
