//! A container ship that heels as it turns.

use super::cross_flow::CrossFlow;
use super::dimensions::{Dimensions, Upright};
use super::propeller::Propeller;
use super::resistance::Resistance;
use super::rudder::Rudder;
use super::single_screw::{Form, Heeling, SingleScrew};

/// The ship. Main dimensions chosen between those of the SR108 and the KCS, with little stability
/// in roll.
pub fn container() -> SingleScrew {
    let dimensions = Dimensions {
        name: "cross-flow-container".into(),
        category: "dry-cargo",
        lpp_m: 205.0,
        beam_m: 30.2,
        draught_m: 10.0,
        block_coefficient: 0.60,
        x_g_m: -3.0,
        yaw_gyradius_ratio: 0.245,
        rudder_area_m2: 38.0,
        rudder_height_m: 8.4,
        propeller_diameter_m: 7.0,
        speed_m_s: 11.3,
        density_kg_m3: 1025.0,
        upright: Some(Upright { gm_m: 0.8, kg_m: 12.6 }),
    };
    SingleScrew::new(dimensions, form())
}

/// Chosen for a fine form; roll damping of the order of Ikeda's at speed, heel forces of the order
/// of the SR108's.
fn form() -> Form {
    Form {
        scatter: [1.0, 1.0, 0.95, 1.05],
        cross_flow: CrossFlow { drag: 0.75, ends: 0.6, bow: 0.15 },
        resistance: Resistance { form: 1.12, residuary: 0.0006 },
        propeller: Propeller {
            diameter_m: 7.0,
            thrust: [0.50, -0.40, -0.08],
            wake: 0.24,
            wake_by_drift: 4.0,
            deduction: 0.18,
        },
        rudder: Rudder {
            area_m2: 38.0,
            aspect_ratio: 1.86,
            x_m: -102.5,
            in_slipstream: 0.80,
            accelerated: 0.70,
            straightening: 0.50,
            hull_force: 0.25,
            hull_x_m: -92.0,
        },
        rudder_rate_deg_s: 2.5,
        heeling: Some(Heeling {
            gyradius_ratio: 0.42,
            damping: 0.06,
            quadratic: 0.4,
            y_phi: -0.0001,
            n_phi: -0.00015,
            rudder_height: 0.45,
        }),
    }
}
