//! Ranges in which the craft of each kind are drawn.

pub mod azimuth;
pub mod car_carrier;
pub mod cargo;
pub mod catamaran;
pub mod outboard;
pub mod pods;
pub mod twin_screw;
pub mod water_jet;

use super::hull::Form;
use super::steerable::Draw;

/// Hull of a ship form: the stern's skeg by fullness of the run, viscous lift and drag as in
/// Hooft (1994) and Faltinsen (1990), Sea Loads on Ships and Offshore Structures, chapter 6.
fn ship_form(draw: &mut Draw) -> Form {
    Form {
        section: draw.between(0.85, 1.05),
        bow: draw.between(3.0, 5.0),
        stern: draw.between(0.65, 0.95),
        lost: draw.between(0.2, 0.45),
        lift: draw.between(0.06, 0.14),
        drag: [draw.between(0.5, 0.9), draw.between(0.2, 0.9)],
        centripetal: draw.between(0.05, 0.25),
        by_heel: [0.0; 2],
    }
}
