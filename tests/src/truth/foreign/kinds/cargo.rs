//! Slender cargo ships of 85 to 130 m with one propeller that turns clockwise seen from aft.

use super::ship_form;
use crate::truth::dimensions::GRAVITY;
use crate::truth::foreign::craft::{Parts, Steering};
use crate::truth::foreign::devices::{ScrewAndRudder, Unit};
use crate::truth::foreign::engine::{Engine, Limit};
use crate::truth::foreign::foil::Foil;
use crate::truth::foreign::hull::Hull;
use crate::truth::foreign::resistance::displacement;
use crate::truth::foreign::screw::Screw;
use crate::truth::foreign::size::Size;
use crate::truth::foreign::steerable::Draw;

const DENSITY: f64 = 1025.0;

/// Draws one.
pub fn parts(draw: &mut Draw) -> Parts {
    let (lpp_m, slender) = (draw.between(85.0, 130.0), draw.between(7.0, 8.0));
    let draught_m = lpp_m / slender / draw.between(2.4, 2.8);
    let rudder = rudder(draw, lpp_m * draught_m, draught_m);
    let size = size(draw, [lpp_m, lpp_m / slender, draught_m], &rudder);
    let form = ship_form(draw);
    let (around, wave) = (draw.between(1.15, 1.25), draw.between(0.003, 0.006));
    let hull = Hull::new(&size, form, displacement(&size, around, 0.0004, [wave, 0.38]));
    let mut unit = Unit::new(-0.49 * lpp_m, 0.0, 0, rudder);
    unit.hull_x_m = -draw.between(0.40, 0.46) * lpp_m;
    Parts {
        hulls: vec![hull],
        units: vec![unit],
        engine: Engine {
            limit: Limit::Torque,
            margin: draw.between(1.02, 1.12),
            order: 1.0,
            lag_s: 4.0,
            run_up_s: 4.0,
        },
        steering: Steering {
            rate_rad_s: draw.between(2.4, 3.5).to_radians(),
            stop_rad: 35_f64.to_radians(),
            difference: None,
        },
        roll: None,
        windage: None,
        size,
    }
}

fn rudder(draw: &mut Draw, lateral_m2: f64, draught_m: f64) -> ScrewAndRudder {
    ScrewAndRudder {
        screw: Screw {
            density_kg_m3: DENSITY,
            diameter_m: draught_m * draw.between(0.58, 0.68),
            pitch_ratio: draw.between(0.75, 0.95),
            area_ratio: draw.between(0.45, 0.6),
        },
        wake: draw.between(0.24, 0.34),
        deduction: draw.between(0.16, 0.22),
        walk: draw.between(0.02, 0.10),
        foil: Foil {
            density_kg_m3: DENSITY,
            area_m2: lateral_m2 / draw.between(42.0, 55.0),
            aspect_ratio: draw.between(1.4, 1.9),
            stall_rad: draw.between(24.0, 32.0).to_radians(),
        },
        in_slipstream: draw.between(0.7, 0.9),
        accelerated: draw.between(0.5, 0.7),
        straightening: [draw.between(0.35, 0.5), draw.between(0.1, 0.3)],
        on_hull: draw.between(0.2, 0.35),
    }
}

fn size(draw: &mut Draw, [lpp_m, beam_m, draught_m]: [f64; 3], unit: &ScrewAndRudder) -> Size {
    Size {
        name: format!("cargo-{}", draw.seed),
        category: "general-cargo",
        lpp_m,
        beam_m,
        draught_m,
        volume_m3: draw.between(0.64, 0.72) * lpp_m * beam_m * draught_m,
        x_g_m: lpp_m * draw.between(-0.015, 0.01),
        yaw_gyradius_ratio: draw.between(0.24, 0.26),
        speed_m_s: draw.between(0.18, 0.22) * (GRAVITY * lpp_m).sqrt(),
        density_kg_m3: DENSITY,
        further: vec![
            ("propeller_diameter_m", unit.screw.diameter_m),
            ("rudder_area_m2", unit.foil.area_m2),
            ("rudder_height_m", (unit.foil.area_m2 * unit.foil.aspect_ratio).sqrt()),
        ],
    }
}
