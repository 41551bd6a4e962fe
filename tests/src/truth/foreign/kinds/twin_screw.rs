//! Ferries of 90 to 150 m with two propellers and two rudders: one engine order, but an engine for
//! each shaft, which loses revolutions as the flow on its side changes in a turn.

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
    let (lpp_m, slender) = (draw.between(90.0, 150.0), draw.between(5.6, 6.6));
    let draught_m = lpp_m / slender / draw.between(3.4, 4.2);
    let rudder = rudder(draw, lpp_m * draught_m, draught_m);
    let size = size(draw, [lpp_m, lpp_m / slender, draught_m], &rudder);
    let form = ship_form(draw);
    let (around, wave) = (draw.between(1.12, 1.2), draw.between(0.004, 0.007));
    let hull = Hull::new(&size, form, displacement(&size, around, 0.0005, [wave, 0.40]));
    let (x_m, y_m) = (-0.47 * lpp_m, draw.between(0.2, 0.27) * size.beam_m);
    let hull_x_m = -draw.between(0.38, 0.44) * lpp_m;
    let unit =
        |side: f64, shaft: usize| Unit { hull_x_m, ..Unit::new(x_m, side * y_m, shaft, rudder) };
    Parts {
        hulls: vec![hull],
        units: vec![unit(-1.0, 0), unit(1.0, 1)],
        engine: Engine {
            limit: Limit::Torque,
            margin: draw.between(1.0, 1.06),
            order: 1.0,
            lag_s: 3.0,
            run_up_s: 4.0,
        },
        steering: Steering {
            rate_rad_s: draw.between(2.5, 4.5).to_radians(),
            stop_rad: 35_f64.to_radians(),
            difference: None,
        },
        roll: None,
        windage: None,
        size,
    }
}

/// Two rudders of together 1/40 to 1/30 of the lateral area.
fn rudder(draw: &mut Draw, lateral_m2: f64, draught_m: f64) -> ScrewAndRudder {
    ScrewAndRudder {
        screw: Screw {
            density_kg_m3: DENSITY,
            diameter_m: draught_m * draw.between(0.6, 0.72),
            pitch_ratio: draw.between(0.95, 1.25),
            area_ratio: draw.between(0.6, 0.75),
        },
        wake: draw.between(0.04, 0.14),
        deduction: draw.between(0.1, 0.18),
        walk: 0.0,
        foil: Foil {
            density_kg_m3: DENSITY,
            area_m2: 0.5 * lateral_m2 / draw.between(30.0, 40.0),
            aspect_ratio: draw.between(1.3, 1.7),
            stall_rad: draw.between(22.0, 30.0).to_radians(),
        },
        in_slipstream: draw.between(0.7, 0.9),
        accelerated: draw.between(0.6, 0.85),
        straightening: [draw.between(0.5, 0.7), draw.between(0.1, 0.3)],
        on_hull: draw.between(0.1, 0.2),
    }
}

fn size(draw: &mut Draw, [lpp_m, beam_m, draught_m]: [f64; 3], unit: &ScrewAndRudder) -> Size {
    Size {
        name: format!("twin-screw-{}", draw.seed),
        category: "ferry",
        lpp_m,
        beam_m,
        draught_m,
        volume_m3: draw.between(0.54, 0.62) * lpp_m * beam_m * draught_m,
        x_g_m: -lpp_m * draw.between(0.01, 0.03),
        yaw_gyradius_ratio: draw.between(0.24, 0.26),
        speed_m_s: draw.between(0.22, 0.28) * (GRAVITY * lpp_m).sqrt(),
        density_kg_m3: DENSITY,
        further: vec![
            ("propeller_diameter_m", unit.screw.diameter_m),
            ("rudder_area_m2", 2.0 * unit.foil.area_m2),
            ("rudder_height_m", (unit.foil.area_m2 * unit.foil.aspect_ratio).sqrt()),
        ],
    }
}
