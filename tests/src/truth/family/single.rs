//! Ships with one propeller and one rudder.

use rand::RngExt;
use rand_chacha::ChaCha12Rng;
use rand_distr::StandardNormal;

use super::steerable;
use crate::truth::cross_flow::CrossFlow;
use crate::truth::dimensions::{Dimensions, GRAVITY};
use crate::truth::propeller::Propeller;
use crate::truth::resistance::Resistance;
use crate::truth::rudder::Rudder;
use crate::truth::single_screw::{Form, SingleScrew};

/// Block coefficient from which on a ship is a tanker.
const FULL: f64 = 0.74;

/// The ship of a seed.
pub fn single_screw(seed: u64) -> SingleScrew {
    steerable(seed, |rng| {
        let dimensions = dimensions(seed, rng);
        let form = form(&dimensions, rng);
        SingleScrew::new(dimensions, form)
    })
}

/// Particulars in the ranges of merchant ships; speed by a Froude number that falls with fullness,
/// from 0.26 to 0.14; rudder area by the rule `L T / 100 (1 + 25 (B/L)^2)` of Det Norske Veritas,
/// 0.9 to 1.3 times.
fn dimensions(seed: u64, rng: &mut ChaCha12Rng) -> Dimensions {
    let lpp_m: f64 = rng.random_range(100.0..320.0);
    let beam_m: f64 = lpp_m / rng.random_range(5.6..7.4);
    let draught_m = beam_m / rng.random_range(2.4..3.3);
    let block_coefficient = rng.random_range(0.56..0.84);
    let fullness = (block_coefficient - 0.56) / 0.28;
    let froude = (0.26 - 0.12 * fullness) * rng.random_range(0.92..1.08);
    let rule = lpp_m * draught_m / 100.0 * (1.0 + 25.0 * (beam_m / lpp_m).powi(2));
    let rudder_area_m2 = rule * rng.random_range(0.9..1.3);
    let aspect_ratio = rng.random_range(1.3..1.9);
    Dimensions {
        name: format!("synthetic-{seed}"),
        category: if block_coefficient < FULL { "dry-cargo" } else { "tanker" },
        lpp_m,
        beam_m,
        draught_m,
        block_coefficient,
        x_g_m: lpp_m * (-0.015 + 0.045 * fullness),
        yaw_gyradius_ratio: rng.random_range(0.235..0.26),
        rudder_area_m2,
        rudder_height_m: (rudder_area_m2 * aspect_ratio).sqrt(),
        propeller_diameter_m: draught_m * rng.random_range(0.50..0.70),
        speed_m_s: froude * (GRAVITY * lpp_m).sqrt(),
        density_kg_m3: 1025.0,
        upright: None,
    }
}

/// The form: the regression's scatter about measured derivatives is some 15 to 25 % (Clarke 1983),
/// drag 0.55 to 1.
fn form(ship: &Dimensions, rng: &mut ChaCha12Rng) -> Form {
    let scatter = [0.12, 0.15, 0.12, 0.12]
        .map(|deviation: f64| 1.0 + deviation * rng.sample::<f64, _>(StandardNormal));
    Form {
        scatter: scatter.map(|factor| factor.clamp(0.6, 1.4)),
        cross_flow: CrossFlow {
            drag: rng.random_range(0.55..1.0),
            ends: rng.random_range(0.0..1.0),
            bow: rng.random_range(-0.2..0.3),
        },
        resistance: Resistance {
            form: rng.random_range(1.1..1.3),
            residuary: rng.random_range(0.0003..0.0012),
        },
        propeller: propeller(ship, rng),
        rudder: rudder(ship, rng),
        rudder_rate_deg_s: rng.random_range(2.3..4.0),
        heeling: None,
    }
}

/// Wake by Taylor's formula `0.5 C_B - 0.05`, thrust deduction six tenths of it.
fn propeller(ship: &Dimensions, rng: &mut ChaCha12Rng) -> Propeller {
    let wake = (0.5 * ship.block_coefficient - 0.05) * rng.random_range(0.85..1.15);
    Propeller {
        diameter_m: ship.propeller_diameter_m,
        thrust: [rng.random_range(0.30..0.50), -0.32, -0.10],
        wake,
        wake_by_drift: rng.random_range(2.0..5.0),
        deduction: 0.6 * wake,
    }
}

fn rudder(ship: &Dimensions, rng: &mut ChaCha12Rng) -> Rudder {
    let half = 0.5 * ship.lpp_m;
    Rudder {
        area_m2: ship.rudder_area_m2,
        aspect_ratio: ship.rudder_height_m.powi(2) / ship.rudder_area_m2,
        x_m: -half,
        in_slipstream: (ship.propeller_diameter_m / ship.rudder_height_m).min(0.95),
        accelerated: rng.random_range(0.45..0.65),
        straightening: rng.random_range(0.35..0.6),
        hull_force: rng.random_range(0.15..0.40),
        hull_x_m: -half * rng.random_range(0.82..0.95),
    }
}
