//! A ferry with two propellers and two rudders.

use super::cross_flow::CrossFlow;
use super::dimensions::Dimensions;
use super::propeller::Propeller;
use super::resistance::Resistance;
use super::rudder::Rudder;
use super::twin_screw::{TwinForm, TwinScrew};

/// The ship. Main dimensions chosen as those of a day ferry; drag and propellers chosen for a fine
/// form with open shafts.
pub fn ferry() -> TwinScrew {
    let dimensions = Dimensions {
        name: "twin-screw-ferry".into(),
        category: "dry-cargo",
        lpp_m: 160.0,
        beam_m: 24.5,
        draught_m: 6.8,
        block_coefficient: 0.58,
        x_g_m: -2.6,
        yaw_gyradius_ratio: 0.25,
        rudder_area_m2: 34.0,
        rudder_height_m: 5.0,
        propeller_diameter_m: 4.6,
        speed_m_s: 10.3,
        density_kg_m3: 1025.0,
        upright: None,
    };
    TwinScrew::new(dimensions, form())
}

/// Chosen: sections of fullness 0.9, open shafts with brackets.
fn form() -> TwinForm {
    TwinForm {
        shaft_m: 5.6,
        section: 0.85,
        trailing_edge: 0.90,
        wake_shelter: 0.35,
        rudder_shelter: 0.25,
        shelter_rad: 0.15,
        cross_flow: CrossFlow { drag: 0.70, ends: 0.4, bow: 0.1 },
        resistance: Resistance { form: 1.15, residuary: 0.0009 },
        propeller: Propeller {
            diameter_m: 4.6,
            thrust: [0.52, -0.38, -0.06],
            wake: 0.10,
            wake_by_drift: 0.0,
            deduction: 0.14,
        },
        rudder: Rudder {
            area_m2: 17.0,
            aspect_ratio: 1.47,
            x_m: -78.0,
            in_slipstream: 0.85,
            accelerated: 0.75,
            straightening: 0.60,
            hull_force: 0.15,
            hull_x_m: -66.0,
        },
        rudder_rate_deg_s: 3.5,
    }
}
