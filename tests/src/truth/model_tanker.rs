//! A free-running tanker model of 3 m in fresh water.

use super::cross_flow::CrossFlow;
use super::dimensions::Dimensions;
use super::propeller::Propeller;
use super::resistance::Resistance;
use super::rudder::Rudder;
use super::single_screw::{Form, SingleScrew};

/// The model. Chosen as a VLCC at a scale of 1/107, with a rudder somewhat larger than to scale.
pub fn model_tanker() -> SingleScrew {
    let dimensions = Dimensions {
        name: "cross-flow-model".into(),
        category: "tanker",
        lpp_m: 3.0,
        beam_m: 0.54,
        draught_m: 0.19,
        block_coefficient: 0.81,
        x_g_m: 0.09,
        yaw_gyradius_ratio: 0.25,
        rudder_area_m2: 0.0105,
        rudder_height_m: 0.135,
        propeller_diameter_m: 0.090,
        speed_m_s: 0.76,
        density_kg_m3: 1000.0,
        upright: None,
    };
    SingleScrew::new(dimensions, form())
}

/// Chosen for model scale: more wake and friction, a higher load and so a faster slipstream than at
/// full scale.
fn form() -> Form {
    Form {
        scatter: [1.05, 0.95, 1.0, 1.1],
        cross_flow: CrossFlow { drag: 0.95, ends: 0.8, bow: 0.0 },
        resistance: Resistance { form: 1.20, residuary: 0.0005 },
        propeller: Propeller {
            diameter_m: 0.090,
            thrust: [0.31, -0.27, -0.11],
            wake: 0.42,
            wake_by_drift: 4.0,
            deduction: 0.20,
        },
        rudder: Rudder {
            area_m2: 0.0105,
            aspect_ratio: 1.74,
            x_m: -1.5,
            in_slipstream: 0.66,
            accelerated: 0.60,
            straightening: 0.40,
            hull_force: 0.35,
            hull_x_m: -1.36,
        },
        rudder_rate_deg_s: 20.0,
        heeling: None,
    }
}
