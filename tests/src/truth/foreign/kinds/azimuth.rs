//! Research vessels of about 34 m with two ducted azimuth thrusters turned together, of about the
//! dimensions of vessels such as R/V Gunnerus; all coefficients are drawn.

use super::ship_form;
use crate::truth::foreign::craft::{Parts, Steering};
use crate::truth::foreign::devices::{Azimuth, Unit};
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
    let thruster = thruster(draw);
    let size = size(draw, &thruster);
    let mut form = ship_form(draw);
    form.stern = draw.between(0.45, 0.8);
    form.lift = draw.between(0.12, 0.25);
    let (around, wave) = (draw.between(1.15, 1.3), draw.between(0.006, 0.012));
    let hull = Hull::new(&size, form, displacement(&size, around, 0.0006, [wave, 0.40]));
    let (x_m, y_m) = (-0.45 * size.lpp_m, draw.between(0.25, 0.30) * size.beam_m);
    Parts {
        hulls: vec![hull],
        units: vec![Unit::new(x_m, -y_m, 0, thruster), Unit::new(x_m, y_m, 1, thruster)],
        engine: Engine {
            limit: Limit::Power,
            margin: 1.0,
            order: draw.between(1.05, 1.12),
            lag_s: 1.5,
            run_up_s: 1.5,
        },
        steering: Steering {
            rate_rad_s: draw.between(8.0, 14.0).to_radians(),
            stop_rad: 90_f64.to_radians(),
            difference: None,
        },
        roll: None,
        windage: None,
        size,
    }
}

fn thruster(draw: &mut Draw) -> Azimuth {
    let ahead = draw.between(0.04, 0.1);
    Azimuth {
        screw: Screw {
            density_kg_m3: DENSITY,
            diameter_m: draw.between(1.6, 2.0),
            pitch_ratio: draw.between(0.9, 1.15),
            area_ratio: draw.between(0.55, 0.7),
        },
        wake: draw.between(0.05, 0.15),
        nozzle: draw.between(0.2, 0.4),
        nozzle_idle: draw.between(0.5, 0.7),
        turned_in: draw.between(0.6, 1.0),
        deduction: [ahead, draw.between(0.0, 0.2)],
        foil: Foil {
            density_kg_m3: DENSITY,
            area_m2: draw.between(1.2, 2.4),
            aspect_ratio: draw.between(0.9, 1.6),
            stall_rad: draw.between(15.0, 25.0).to_radians(),
        },
    }
}

fn size(draw: &mut Draw, thruster: &Azimuth) -> Size {
    let lpp_m: f64 = draw.between(30.0, 37.0);
    let beam_m = lpp_m / draw.between(3.2, 3.8);
    let draught_m = draw.between(2.5, 3.0);
    Size {
        name: format!("azimuth-{}", draw.seed),
        category: "research",
        lpp_m,
        beam_m,
        draught_m,
        volume_m3: draw.between(0.54, 0.62) * lpp_m * beam_m * draught_m,
        x_g_m: -lpp_m * draw.between(0.01, 0.04),
        yaw_gyradius_ratio: draw.between(0.24, 0.27),
        speed_m_s: draw.between(4.6, 5.6),
        density_kg_m3: DENSITY,
        further: vec![("propeller_diameter_m", thruster.screw.diameter_m)],
    }
}
