//! Cruise ships of 180 to 260 m with two pulling pods turned together.

use super::ship_form;
use crate::truth::dimensions::GRAVITY;
use crate::truth::foreign::craft::{Parts, Steering};
use crate::truth::foreign::devices::{Pod, Unit};
use crate::truth::foreign::engine::{Engine, Limit};
use crate::truth::foreign::foil::Foil;
use crate::truth::foreign::hull::Hull;
use crate::truth::foreign::resistance::{Windage, displacement};
use crate::truth::foreign::screw::Screw;
use crate::truth::foreign::size::Size;
use crate::truth::foreign::steerable::Draw;

const DENSITY: f64 = 1025.0;

/// Draws one.
pub fn parts(draw: &mut Draw) -> Parts {
    let lpp_m = draw.between(180.0, 260.0);
    let beam_m = lpp_m / draw.between(6.8, 7.8);
    let pod = pod(draw, beam_m / 3.9);
    let size = size(draw, lpp_m, beam_m, &pod);
    let mut form = ship_form(draw);
    form.stern = draw.between(0.45, 0.75);
    form.lift = draw.between(0.10, 0.18);
    let (around, wave) = (draw.between(1.12, 1.2), draw.between(0.003, 0.006));
    let hull = Hull::new(&size, form, displacement(&size, around, 0.0004, [wave, 0.40]));
    let (x_m, y_m) = (-0.46 * lpp_m, draw.between(0.2, 0.26) * beam_m);
    Parts {
        hulls: vec![hull],
        units: vec![Unit::new(x_m, -y_m, 0, pod), Unit::new(x_m, y_m, 1, pod)],
        engine: Engine {
            limit: Limit::Power,
            margin: 1.0,
            order: draw.between(1.0, 1.05),
            lag_s: 4.0,
            run_up_s: 4.0,
        },
        steering: Steering {
            rate_rad_s: draw.between(2.5, 5.0).to_radians(),
            stop_rad: 35_f64.to_radians(),
            difference: None,
        },
        windage: Some(Windage {
            frontal_m2: beam_m * draw.between(28.0, 36.0),
            lateral_m2: lpp_m * draw.between(26.0, 34.0),
            centre_m: lpp_m * draw.between(-0.02, 0.04),
        }),
        roll: None,
        size,
    }
}

fn pod(draw: &mut Draw, draught_m: f64) -> Pod {
    let diameter_m = draught_m * draw.between(0.62, 0.72);
    Pod {
        screw: Screw {
            density_kg_m3: DENSITY,
            diameter_m,
            pitch_ratio: draw.between(0.95, 1.2),
            area_ratio: draw.between(0.55, 0.7),
        },
        wake: draw.between(0.03, 0.12),
        deduction: draw.between(0.06, 0.12),
        in_plane: draw.between(0.2, 0.5),
        straightening: draw.between(0.6, 0.9),
        foil: Foil {
            density_kg_m3: DENSITY,
            area_m2: diameter_m.powi(2) * draw.between(0.35, 0.55),
            aspect_ratio: draw.between(0.9, 1.4),
            stall_rad: draw.between(20.0, 28.0).to_radians(),
        },
        body_m2: diameter_m.powi(2) * draw.between(0.02, 0.04),
    }
}

fn size(draw: &mut Draw, lpp_m: f64, beam_m: f64, pod: &Pod) -> Size {
    let draught_m = beam_m / 3.9;
    Size {
        name: format!("pods-{}", draw.seed),
        category: "cruise",
        lpp_m,
        beam_m,
        draught_m,
        volume_m3: draw.between(0.60, 0.68) * lpp_m * beam_m * draught_m,
        x_g_m: -lpp_m * draw.between(0.005, 0.025),
        yaw_gyradius_ratio: draw.between(0.245, 0.265),
        speed_m_s: draw.between(0.2, 0.24) * (GRAVITY * lpp_m).sqrt(),
        density_kg_m3: DENSITY,
        further: vec![("propeller_diameter_m", pod.screw.diameter_m)],
    }
}
