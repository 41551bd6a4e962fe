//! A tanker of 150,000 t that does not keep a straight line by itself.

use super::cross_flow::CrossFlow;
use super::dimensions::Dimensions;
use super::propeller::Propeller;
use super::resistance::Resistance;
use super::rudder::Rudder;
use super::single_screw::{Form, SingleScrew};

/// The ship. Main dimensions chosen as those of a Suezmax tanker; the full form makes Clarke's
/// regression unstable.
pub fn tanker() -> SingleScrew {
    let dimensions = Dimensions {
        name: "cross-flow-tanker".into(),
        category: "tanker",
        lpp_m: 264.0,
        beam_m: 48.0,
        draught_m: 16.2,
        block_coefficient: 0.83,
        x_g_m: 6.6,
        yaw_gyradius_ratio: 0.24,
        rudder_area_m2: 73.0,
        rudder_height_m: 11.4,
        propeller_diameter_m: 8.2,
        speed_m_s: 7.7,
        density_kg_m3: 1025.0,
        upright: None,
    };
    SingleScrew::new(dimensions, form())
}

/// Chosen for a full form: high wake, drag across the ends, a rudder area of 1/58.6 of the lateral
/// area.
fn form() -> Form {
    Form {
        scatter: [1.0, 1.0, 1.05, 1.0],
        cross_flow: CrossFlow { drag: 0.70, ends: 0.7, bow: 0.1 },
        resistance: Resistance { form: 1.25, residuary: 0.0004 },
        propeller: Propeller {
            diameter_m: 8.2,
            thrust: [0.32, -0.27, -0.13],
            wake: 0.38,
            wake_by_drift: 4.0,
            deduction: 0.21,
        },
        rudder: Rudder {
            area_m2: 73.0,
            aspect_ratio: 1.78,
            x_m: -132.0,
            in_slipstream: 0.70,
            accelerated: 0.50,
            straightening: 0.45,
            hull_force: 0.30,
            hull_x_m: -118.0,
        },
        rudder_rate_deg_s: 2.32,
        heeling: None,
    }
}
