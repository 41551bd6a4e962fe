//! Ships of a made-up family: hulls between a container ship and a tanker, derivatives by
//! regression with scatter of their own, and interaction coefficients that differ from those which
//! every fitted model has.

use std::sync::Arc;

use rand::RngExt;
use rand_chacha::ChaCha12Rng;
use rand_distr::{Distribution, StandardNormal};
use sistership_fleet::statistics::{RegressionFrame, TrialStatistics};
use sistership_model::quantity::Quantity;
use sistership_model::trial::{Channel, Trial};
use sistership_model::{Law, Model, Zoo};
use sistership_simulation::Ship;
use sistership_simulation::manoeuvre::{ManoeuvreSettings, simulate_turn, simulate_zigzag};
use sistership_simulation::state::{RECORDED_CHANNELS, Trajectory, at};

use super::regressions::{Hull, derivatives};

/// Scatter of a ship's own derivatives about the regressions, and of its interaction coefficients.
const SCATTER: f64 = 0.1;
const INTERACTION: f64 = 0.05;
/// Instruments, by channel: velocities in m/s, the rate in rad/s.
const NOISE: [(Channel, f64); 3] = [(Channel::U, 0.02), (Channel::V, 0.02), (Channel::R, 2e-4)];

/// A ship: what it truly is, and what is known of it.
pub struct Sistership {
    pub name: String,
    pub hull: Hull,
    /// The foundation on its particulars.
    pub frame: Model,
    pub truth: Model,
}

/// The foundation of the family and its law.
pub fn foundation() -> (Model, Arc<Law>) {
    let zoo = Zoo::load_embedded().expect("the zoo");
    let model = zoo.find_model("kvlcc2").expect("the foundation");
    let law = zoo.law(&model.law).expect("its law").clone();
    (model, law)
}

fn hull(rng: &mut ChaCha12Rng) -> Hull {
    let lpp_m = rng.random_range(150.0..330.0);
    let beam_m = lpp_m / rng.random_range(5.2..6.6);
    Hull {
        lpp_m,
        beam_m,
        draught_m: beam_m / rng.random_range(2.5..3.1),
        block_coefficient: rng.random_range(0.62..0.84),
    }
}

/// Draws a ship.
pub fn draw(rng: &mut ChaCha12Rng, index: usize, foundation: &Model, law: &Law) -> Sistership {
    let (name, hull) = (format!("sister-{index:02}"), hull(rng));
    let frame = foundation.transfer_to(
        law,
        &name,
        &particulars(foundation, hull),
        Some(speed(foundation, hull)),
    );
    let frame = Model { revolutions_rps: scaled_revolutions(foundation, hull), ..frame };
    let mut normal = || -> f64 { StandardNormal.sample(rng) };
    let mut truth = frame.clone();
    let (m_x, m_y) = (truth.parameters["m_x"].value, truth.parameters["m_y"].value);
    for (name, value) in derivatives(hull, m_x, m_y) {
        truth
            .coefficients
            .insert(name.to_owned(), Quantity::new(value * (1.0 + SCATTER * normal()), "drawn"));
    }
    for name in ["a_H", "x_H", "gamma_R_plus", "gamma_R_minus", "w_P0", "t_R"] {
        let factor = 1.0 + INTERACTION * normal();
        truth.parameters.entry(name.to_owned()).and_modify(|quantity| quantity.value *= factor);
    }
    Sistership { name, hull, frame, truth }
}

fn particulars(foundation: &Model, hull: Hull) -> sistership_model::particulars::Particulars {
    let of = |name: &str| foundation.particulars[name].value;
    let (length, depth) = (hull.lpp_m / of("lpp_m"), hull.draught_m / of("draught_m"));
    let own = [
        ("lpp_m", hull.lpp_m),
        ("beam_m", hull.beam_m),
        ("draught_m", hull.draught_m),
        ("block_coefficient", hull.block_coefficient),
        ("displacement_m3", hull.block_coefficient * hull.lpp_m * hull.beam_m * hull.draught_m),
        ("x_g_m", of("x_g_m") * length),
        ("yaw_gyradius_ratio", of("yaw_gyradius_ratio")),
        ("rudder_area_m2", of("rudder_area_m2") * length * depth),
        ("rudder_height_m", of("rudder_height_m") * depth),
        ("propeller_diameter_m", of("propeller_diameter_m") * depth),
        ("water_density_kg_m3", of("water_density_kg_m3")),
    ];
    own.into_iter().map(|(name, value)| (name.to_owned(), Quantity::new(value, "drawn"))).collect()
}

/// By Froude's law.
fn speed(foundation: &Model, hull: Hull) -> f64 {
    foundation.speed_m_s.expect("a speed")
        * (hull.lpp_m / foundation.particulars["lpp_m"].value).sqrt()
}

fn scaled_revolutions(foundation: &Model, hull: Hull) -> Option<f64> {
    foundation
        .revolutions_rps
        .map(|n| n / (hull.lpp_m / foundation.particulars["lpp_m"].value).sqrt())
}

/// A manoeuvre.
#[derive(Debug, Clone, Copy)]
pub enum Sailed {
    Turn(f64),
    Zigzag(f64),
}

/// What a model makes of a manoeuvre, none where it diverges.
pub fn sail(model: &Model, law: &Law, what: Sailed, lengths: f64) -> Option<Trajectory> {
    let ship = Ship::new(model, law).ok()?;
    let step_s = 0.02 * ship.lpp_m() / ship.approach_speed_m_s();
    let duration_s = lengths * ship.lpp_m() / ship.approach_speed_m_s();
    let settings = ManoeuvreSettings {
        step_s: Some(step_s),
        duration_s: Some(duration_s),
        ..ManoeuvreSettings::default()
    };
    match what {
        Sailed::Turn(angle) => simulate_turn(&ship, angle, &settings).ok().map(|turn| turn.track),
        Sailed::Zigzag(angle) => {
            simulate_zigzag(&ship, angle, angle.abs(), &settings).ok().map(|zigzag| zigzag.track)
        }
    }
}

/// A ship's trials as statistics; none where the drawn ship does not sail.
pub fn statistics(
    ship: &Sistership,
    law: &Law,
    rng: &mut ChaCha12Rng,
    sailed: &[(Sailed, f64)],
) -> Option<Vec<TrialStatistics>> {
    let frame = RegressionFrame::new(&ship.frame, law, "law", None).expect("a frame");
    let mut one = |&(what, lengths): &(Sailed, f64)| {
        let track = sail(&ship.truth, law, what, lengths)?;
        Some(TrialStatistics::from_trial(&frame, &recorded(&track, rng)).expect("statistics"))
    };
    sailed.iter().map(&mut one).collect()
}

fn recorded(track: &Trajectory, rng: &mut ChaCha12Rng) -> Trial {
    let mut channels: std::collections::BTreeMap<Channel, Vec<f64>> = RECORDED_CHANNELS
        .iter()
        .map(|&(channel, index)| (channel, track.state_column(index)))
        .collect();
    channels.insert(Channel::Delta, track.state_column(at::DELTA));
    channels.insert(Channel::N, track.n_rps.clone());
    for (channel, deviation) in NOISE {
        let shaken = channels.get_mut(&channel).expect("a recorded channel");
        shaken
            .iter_mut()
            .zip(StandardNormal.sample_iter(&mut *rng))
            .for_each(|(value, normal): (_, f64)| *value += deviation * normal);
    }
    Trial { t_s: track.t_s.clone(), channels, ..Trial::default() }
}
