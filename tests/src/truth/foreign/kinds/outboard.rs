//! Workboats of about 8 m with one outboard of 60 to 110 kW.

use crate::truth::dimensions::GRAVITY;
use crate::truth::foreign::craft::{Parts, Steering};
use crate::truth::foreign::devices::{Outboard, Unit};
use crate::truth::foreign::engine::{Engine, Limit};
use crate::truth::foreign::foil::Foil;
use crate::truth::foreign::hull::{Form, Hull};
use crate::truth::foreign::resistance::Resistance;
use crate::truth::foreign::screw::Screw;
use crate::truth::foreign::size::Size;
use crate::truth::foreign::steerable::Draw;

const DENSITY: f64 = 1025.0;

/// Draws one.
pub fn parts(draw: &mut Draw) -> Parts {
    let motor = motor(draw);
    let size = size(draw, &motor);
    let hump_m_s = draw.between(0.5, 0.6) * (GRAVITY * size.lpp_m).sqrt();
    let resistance = Resistance::Planing {
        wetted_m2: 0.85 * size.lpp_m * size.beam_m,
        weight_n: GRAVITY * size.mass_kg(),
        trim_rad: draw.between(0.09, 0.13),
        hump_m_s,
        lifted: draw.between(0.25, 0.45),
    };
    let hull = Hull::new(&size, form(draw), resistance);
    Parts {
        hulls: vec![hull],
        units: vec![Unit::new(-0.53 * size.lpp_m, 0.0, 0, motor)],
        engine: Engine {
            limit: Limit::Torque,
            margin: draw.between(1.05, 1.2),
            order: 1.0,
            lag_s: 0.6,
            run_up_s: 0.6,
        },
        steering: Steering {
            rate_rad_s: draw.between(18.0, 30.0).to_radians(),
            stop_rad: 35_f64.to_radians(),
            difference: None,
        },
        roll: None,
        windage: None,
        size,
    }
}

/// Shallow sections with a small keel.
fn form(draw: &mut Draw) -> Form {
    Form {
        section: draw.between(0.7, 0.95),
        bow: draw.between(2.0, 3.5),
        stern: draw.between(0.75, 0.98),
        lost: draw.between(0.3, 0.6),
        lift: draw.between(0.15, 0.3),
        drag: [draw.between(0.7, 1.1), draw.between(0.0, 0.5)],
        centripetal: draw.between(0.1, 0.4),
        by_heel: [0.0; 2],
    }
}

fn motor(draw: &mut Draw) -> Outboard {
    Outboard {
        screw: Screw {
            density_kg_m3: DENSITY,
            diameter_m: draw.between(0.34, 0.40),
            pitch_ratio: draw.between(0.9, 1.2),
            area_ratio: draw.between(0.5, 0.65),
        },
        wake: draw.between(0.02, 0.1),
        walk: draw.between(0.15, 0.35),
        ventilated: draw.between(0.2, 0.7),
        foil: Foil {
            density_kg_m3: DENSITY,
            area_m2: draw.between(0.05, 0.09),
            aspect_ratio: draw.between(1.2, 2.0),
            stall_rad: draw.between(16.0, 24.0).to_radians(),
        },
    }
}

fn size(draw: &mut Draw, motor: &Outboard) -> Size {
    let lpp_m: f64 = draw.between(7.0, 9.0);
    let beam_m = lpp_m / draw.between(2.8, 3.3);
    let draught_m = draw.between(0.45, 0.58);
    Size {
        name: format!("outboard-{}", draw.seed),
        category: "boat",
        lpp_m,
        beam_m,
        draught_m,
        volume_m3: draw.between(0.32, 0.40) * lpp_m * beam_m * draught_m,
        x_g_m: -lpp_m * draw.between(0.03, 0.08),
        yaw_gyradius_ratio: draw.between(0.24, 0.28),
        speed_m_s: draw.between(4.2, 6.5),
        density_kg_m3: DENSITY,
        further: vec![("propeller_diameter_m", motor.screw.diameter_m)],
    }
}
