//! Fast craft of 16 to 28 m with one steerable water jet, about the speed of their hump.

use crate::truth::dimensions::GRAVITY;
use crate::truth::foreign::craft::{Parts, Steering};
use crate::truth::foreign::devices::{Jet, Unit};
use crate::truth::foreign::engine::{Engine, Limit};
use crate::truth::foreign::hull::{Form, Hull};
use crate::truth::foreign::resistance::Resistance;
use crate::truth::foreign::size::Size;
use crate::truth::foreign::steerable::Draw;

const DENSITY: f64 = 1025.0;

/// Draws one.
pub fn parts(draw: &mut Draw) -> Parts {
    let size = size(draw);
    let jet = jet(draw, &size);
    let resistance = Resistance::Planing {
        wetted_m2: 0.9 * size.lpp_m * size.beam_m,
        weight_n: GRAVITY * size.mass_kg(),
        trim_rad: draw.between(0.07, 0.1),
        hump_m_s: draw.between(0.5, 0.6) * (GRAVITY * size.lpp_m).sqrt(),
        lifted: draw.between(0.2, 0.4),
    };
    let hull = Hull::new(&size, form(draw), resistance);
    Parts {
        hulls: vec![hull],
        units: vec![Unit::new(-0.5 * size.lpp_m, 0.0, 0, jet)],
        engine: Engine { limit: Limit::Power, margin: 1.0, order: 1.0, lag_s: 1.0, run_up_s: 1.0 },
        steering: Steering {
            rate_rad_s: draw.between(15.0, 25.0).to_radians(),
            stop_rad: 35_f64.to_radians(),
            difference: None,
        },
        roll: None,
        windage: None,
        size,
    }
}

/// Hard chines without a skeg.
fn form(draw: &mut Draw) -> Form {
    Form {
        section: draw.between(0.8, 1.0),
        bow: draw.between(2.0, 3.5),
        stern: draw.between(0.8, 1.0),
        lost: draw.between(0.3, 0.6),
        lift: draw.between(0.15, 0.3),
        drag: [draw.between(0.8, 1.2), draw.between(0.0, 0.4)],
        centripetal: draw.between(0.1, 0.4),
        by_heel: [0.0; 2],
    }
}

/// A nozzle of 0.35 to 0.45 of the impeller's area, as builders have them.
fn jet(draw: &mut Draw, size: &Size) -> Jet {
    let impeller_m = size.lpp_m * draw.between(0.034, 0.042);
    let area = 0.25 * std::f64::consts::PI * impeller_m.powi(2);
    Jet {
        density_kg_m3: DENSITY,
        nozzle_m2: area * draw.between(0.35, 0.45),
        impeller_m,
        head: draw.between(2.5, 3.5),
        inlet_loss: draw.between(0.15, 0.3),
        torque: draw.between(0.10, 0.14),
        bucket: draw.between(0.45, 0.6),
        straightening: draw.between(0.5, 0.9),
    }
}

fn size(draw: &mut Draw) -> Size {
    let lpp_m: f64 = draw.between(16.0, 28.0);
    let beam_m = lpp_m / draw.between(3.8, 4.6);
    let draught_m = beam_m / draw.between(4.0, 4.8);
    Size {
        name: format!("water-jet-{}", draw.seed),
        category: "patrol",
        lpp_m,
        beam_m,
        draught_m,
        volume_m3: draw.between(0.36, 0.42) * lpp_m * beam_m * draught_m,
        x_g_m: -lpp_m * draw.between(0.03, 0.07),
        yaw_gyradius_ratio: draw.between(0.24, 0.27),
        speed_m_s: draw.between(0.45, 0.75) * (GRAVITY * lpp_m).sqrt(),
        density_kg_m3: DENSITY,
        further: Vec::new(),
    }
}
