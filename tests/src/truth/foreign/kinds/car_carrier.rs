//! Car carriers of about 180 m: dimensions as of ships of 4,000 to 6,500 cars.

use super::ship_form;
use crate::truth::foreign::craft::{Parts, Steering};
use crate::truth::foreign::devices::{ScrewAndRudder, Unit};
use crate::truth::foreign::engine::{Engine, Limit};
use crate::truth::foreign::foil::Foil;
use crate::truth::foreign::hull::Hull;
use crate::truth::foreign::resistance::{Windage, displacement};
use crate::truth::foreign::roll::Roll;
use crate::truth::foreign::screw::Screw;
use crate::truth::foreign::size::Size;
use crate::truth::foreign::steerable::Draw;

const DENSITY: f64 = 1025.0;

/// Draws one.
pub fn parts(draw: &mut Draw) -> Parts {
    let rudder = rudder(draw);
    let size = size(draw, &rudder);
    let mut form = ship_form(draw);
    form.by_heel = [-draw.between(0.0, 0.01), -draw.between(0.002, 0.01)];
    let (bow, wave) = (draw.between(1.12, 1.2), draw.between(0.002, 0.004));
    let hull = Hull::new(&size, form, displacement(&size, bow, 0.0004, [wave, 0.38]));
    let roll = roll(draw, &size);
    let mut unit = Unit::new(-0.495 * size.lpp_m, 0.0, 0, rudder);
    unit.hull_x_m = -draw.between(0.40, 0.46) * size.lpp_m;
    Parts {
        hulls: vec![hull],
        units: vec![unit],
        engine: Engine {
            limit: Limit::Torque,
            margin: draw.between(1.0, 1.04),
            order: 1.0,
            lag_s: 4.0,
            run_up_s: 5.0,
        },
        steering: Steering {
            rate_rad_s: draw.between(2.4, 3.5).to_radians(),
            stop_rad: 37_f64.to_radians(),
            difference: None,
        },
        windage: Some(Windage {
            frontal_m2: size.beam_m * draw.between(25.0, 29.0),
            lateral_m2: size.lpp_m * draw.between(24.0, 28.0),
            centre_m: size.lpp_m * draw.between(-0.03, 0.02),
        }),
        roll: Some(roll),
        size,
    }
}

fn rudder(draw: &mut Draw) -> ScrewAndRudder {
    let aspect_ratio = draw.between(1.4, 1.8);
    ScrewAndRudder {
        screw: Screw {
            density_kg_m3: DENSITY,
            diameter_m: draw.between(5.8, 6.6),
            pitch_ratio: draw.between(0.85, 1.05),
            area_ratio: draw.between(0.55, 0.7),
        },
        wake: draw.between(0.2, 0.3),
        deduction: draw.between(0.14, 0.2),
        walk: 0.0,
        foil: Foil {
            density_kg_m3: DENSITY,
            area_m2: draw.between(34.0, 42.0),
            aspect_ratio,
            stall_rad: draw.between(20.0, 27.0).to_radians(),
        },
        in_slipstream: draw.between(0.75, 0.9),
        accelerated: draw.between(0.6, 0.8),
        straightening: [draw.between(0.35, 0.5), draw.between(0.1, 0.3)],
        on_hull: draw.between(0.15, 0.3),
    }
}

fn size(draw: &mut Draw, rudder: &ScrewAndRudder) -> Size {
    let lpp_m: f64 = draw.between(165.0, 195.0);
    let beam_m = draw.between(30.0, 32.3);
    let draught_m = draw.between(8.2, 9.4);
    Size {
        name: format!("car-carrier-{}", draw.seed),
        category: "car-carrier",
        lpp_m,
        beam_m,
        draught_m,
        volume_m3: draw.between(0.54, 0.60) * lpp_m * beam_m * draught_m,
        x_g_m: -lpp_m * draw.between(0.005, 0.02),
        yaw_gyradius_ratio: draw.between(0.24, 0.26),
        speed_m_s: draw.between(8.8, 10.2),
        density_kg_m3: DENSITY,
        further: vec![
            ("propeller_diameter_m", rudder.screw.diameter_m),
            ("rudder_area_m2", rudder.foil.area_m2),
            ("rudder_height_m", (rudder.foil.area_m2 * rudder.foil.aspect_ratio).sqrt()),
        ],
    }
}

/// Little stability under a high centre of gravity; Ikeda's damping for such hulls.
fn roll(draw: &mut Draw, size: &Size) -> Roll {
    let gm_m = draw.between(1.0, 1.8);
    let block = size.volume_m3 / (size.lpp_m * size.beam_m * size.draught_m);
    let bm_m = 0.075 * size.beam_m.powi(2) / (size.draught_m * block);
    let kg_m = 0.53 * size.draught_m + bm_m - gm_m;
    Roll {
        gm_m,
        bm_m,
        gyradius_m: draw.between(0.40, 0.46) * size.beam_m,
        damping: draw.between(0.02, 0.04),
        by_speed: draw.between(0.03, 0.06),
        quadratic: draw.between(0.2, 0.5),
        levers_m: [kg_m - 0.5 * size.draught_m, kg_m - 0.42 * size.draught_m],
    }
}
