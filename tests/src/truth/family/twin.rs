//! Ships with two propellers and two rudders.

use rand::RngExt;
use rand_chacha::ChaCha12Rng;

use super::steerable;
use crate::truth::cross_flow::CrossFlow;
use crate::truth::dimensions::{Dimensions, GRAVITY};
use crate::truth::propeller::Propeller;
use crate::truth::resistance::Resistance;
use crate::truth::rudder::Rudder;
use crate::truth::twin_screw::{TwinForm, TwinScrew};

/// The ship of a seed.
pub fn twin_screw(seed: u64) -> TwinScrew {
    steerable(seed, |rng| {
        let dimensions = dimensions(seed, rng);
        let form = form(&dimensions, rng);
        TwinScrew::new(dimensions, form)
    })
}

/// Particulars in the ranges of ferries, cruise ships and twin-screw freighters; speed by a Froude
/// number of 0.22 to 0.30; rudder area by the rule `L T / 100 (1 + 25 (B/L)^2)` of Det Norske
/// Veritas, 0.9 to 1.3 times.
fn dimensions(seed: u64, rng: &mut ChaCha12Rng) -> Dimensions {
    let lpp_m: f64 = rng.random_range(80.0..260.0);
    let beam_m: f64 = lpp_m / rng.random_range(5.8..7.8);
    let draught_m = beam_m / rng.random_range(3.2..4.4);
    let froude = rng.random_range(0.22..0.30);
    let rule = lpp_m * draught_m / 100.0 * (1.0 + 25.0 * (beam_m / lpp_m).powi(2));
    let rudder_area_m2 = rule * rng.random_range(0.9..1.3);
    let aspect_ratio = rng.random_range(1.2..1.8);
    Dimensions {
        name: format!("twin-{seed}"),
        category: "dry-cargo",
        lpp_m,
        beam_m,
        draught_m,
        block_coefficient: rng.random_range(0.54..0.68),
        x_g_m: -lpp_m * rng.random_range(0.005..0.03),
        yaw_gyradius_ratio: rng.random_range(0.235..0.26),
        rudder_area_m2,
        rudder_height_m: (0.5 * rudder_area_m2 * aspect_ratio).sqrt(),
        propeller_diameter_m: draught_m * rng.random_range(0.55..0.75),
        speed_m_s: froude * (GRAVITY * lpp_m).sqrt(),
        density_kg_m3: 1025.0,
        upright: None,
    }
}

/// The form: shares of the flow drawn about those of `ferry`, drag 0.55 to 1.
fn form(ship: &Dimensions, rng: &mut ChaCha12Rng) -> TwinForm {
    TwinForm {
        shaft_m: ship.beam_m * rng.random_range(0.18..0.28),
        section: rng.random_range(0.75..0.95),
        trailing_edge: rng.random_range(0.75..1.05),
        wake_shelter: rng.random_range(0.15..0.55),
        rudder_shelter: rng.random_range(0.1..0.4),
        shelter_rad: rng.random_range(0.1..0.25),
        cross_flow: CrossFlow {
            drag: rng.random_range(0.55..1.0),
            ends: rng.random_range(0.0..0.8),
            bow: rng.random_range(-0.1..0.3),
        },
        resistance: Resistance {
            form: rng.random_range(1.1..1.25),
            residuary: rng.random_range(0.0005..0.0015),
        },
        propeller: propeller(ship, rng),
        rudder: rudder(ship, rng),
        rudder_rate_deg_s: rng.random_range(2.5..4.5),
    }
}

fn propeller(ship: &Dimensions, rng: &mut ChaCha12Rng) -> Propeller {
    Propeller {
        diameter_m: ship.propeller_diameter_m,
        thrust: [rng.random_range(0.40..0.60), -0.38, -0.06],
        wake: rng.random_range(0.04..0.16),
        wake_by_drift: 0.0,
        deduction: rng.random_range(0.10..0.20),
    }
}

fn rudder(ship: &Dimensions, rng: &mut ChaCha12Rng) -> Rudder {
    let half = 0.5 * ship.lpp_m;
    Rudder {
        area_m2: 0.5 * ship.rudder_area_m2,
        aspect_ratio: 2.0 * ship.rudder_height_m.powi(2) / ship.rudder_area_m2,
        x_m: -half * rng.random_range(0.95..1.0),
        in_slipstream: (ship.propeller_diameter_m / ship.rudder_height_m).min(0.95),
        accelerated: rng.random_range(0.6..0.85),
        straightening: rng.random_range(0.45..0.75),
        hull_force: rng.random_range(0.1..0.25),
        hull_x_m: -half * rng.random_range(0.78..0.9),
    }
}
