//! Catamarans of 2 to 8 m for surveys, with a fixed thruster in each hull.

use crate::truth::dimensions::GRAVITY;
use crate::truth::foreign::craft::{Parts, Steering};
use crate::truth::foreign::devices::{Thruster, Unit};
use crate::truth::foreign::engine::{Engine, Limit};
use crate::truth::foreign::hull::{Form, Hull};
use crate::truth::foreign::resistance::Resistance;
use crate::truth::foreign::screw::Screw;
use crate::truth::foreign::size::Size;
use crate::truth::foreign::steerable::Draw;

const DENSITY: f64 = 1025.0;

/// Draws one.
pub fn parts(draw: &mut Draw) -> Parts {
    let (lpp_m, slender) = (draw.between(2.0, 8.0), draw.between(9.0, 13.0));
    let draught_m = lpp_m / slender * draw.between(0.6, 0.9);
    let thruster = thruster(draw, draught_m);
    let size = size(draw, [lpp_m, slender, draught_m], &thruster);
    let form = form(draw);
    let (around, wave) = (draw.between(1.2, 1.4), draw.between(0.006, 0.012));
    let resistance = Resistance::Displacement {
        // Denny's formula for one of the hulls.
        wetted_m2: 1.7 * lpp_m * draught_m + 0.5 * size.volume_m3 / draught_m,
        form: around,
        // Brackets and thrusters are large beside hulls of this size.
        allowance: draw.between(0.005, 0.012),
        wave: [wave, 0.42],
    };
    let hull = Hull::new(&size, form, resistance);
    let (x_m, y_m) = (-0.42 * lpp_m, 0.5 * (size.beam_m - lpp_m / slender));
    Parts {
        hulls: vec![hull.clone().at(-y_m), hull.at(y_m)],
        units: vec![Unit::new(x_m, -y_m, 0, thruster), Unit::new(x_m, y_m, 1, thruster)],
        engine: Engine {
            limit: Limit::Power,
            margin: draw.between(2.5, 3.5),
            order: 1.0,
            lag_s: 0.3,
            run_up_s: 0.3,
        },
        steering: Steering {
            rate_rad_s: 90_f64.to_radians(),
            stop_rad: 35_f64.to_radians(),
            difference: Some(draw.between(1.1, 1.6)),
        },
        roll: None,
        windage: None,
        size,
    }
}

fn form(draw: &mut Draw) -> Form {
    Form {
        section: draw.between(0.8, 1.0),
        bow: draw.between(3.0, 5.0),
        stern: draw.between(0.35, 0.7),
        lost: draw.between(0.2, 0.5),
        lift: draw.between(0.06, 0.15),
        drag: [draw.between(0.6, 1.0), draw.between(0.0, 0.6)],
        centripetal: draw.between(0.1, 0.4),
        by_heel: [0.0; 2],
    }
}

fn thruster(draw: &mut Draw, draught_m: f64) -> Thruster {
    Thruster {
        screw: Screw {
            density_kg_m3: DENSITY,
            diameter_m: draught_m * draw.between(0.55, 0.75),
            pitch_ratio: draw.between(0.7, 1.0),
            area_ratio: draw.between(0.4, 0.6),
        },
        wake: draw.between(0.05, 0.15),
        deduction: draw.between(0.05, 0.15),
        turned_in: draw.between(0.3, 0.8),
    }
}

/// Volume is that of both hulls; the particulars have the draught of one.
fn size(draw: &mut Draw, [lpp_m, slender, draught_m]: [f64; 3], thruster: &Thruster) -> Size {
    let hull_m = lpp_m / slender;
    let volume_m3 = 2.0 * draw.between(0.5, 0.62) * lpp_m * hull_m * draught_m;
    Size {
        name: format!("catamaran-{}", draw.seed),
        category: "usv",
        lpp_m,
        beam_m: lpp_m * draw.between(0.45, 0.6),
        draught_m,
        volume_m3,
        x_g_m: -lpp_m * draw.between(0.01, 0.05),
        yaw_gyradius_ratio: draw.between(0.25, 0.32),
        speed_m_s: draw.between(0.25, 0.4) * (GRAVITY * lpp_m).sqrt(),
        density_kg_m3: DENSITY,
        further: vec![("propeller_diameter_m", thruster.screw.diameter_m)],
    }
}
