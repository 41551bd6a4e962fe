//! Tactical diameters at 35 deg of rudder.

use sistership_dynamics::Ship;
use sistership_dynamics::manoeuvre::{ManoeuvreSettings, turn};
use sistership_identify::bands::{Sampling, draws};
use sistership_model::{Law, Model};

/// That of a model, m; none where she does not come round.
pub fn diameter(model: &Model, law: &Law) -> Option<f64> {
    let ship = Ship::new(model, law).ok()?;
    let step_s = Some(0.02 * ship.lpp_m() / ship.approach_speed_m_s());
    turn(&ship, 35.0, &ManoeuvreSettings { step_s, ..ManoeuvreSettings::default() }).ok()?.metrics.tactical_diameter_m
}

/// Between which 95 % of the draws from a model's posterior are, m.
pub fn band(model: &Model, law: &Law) -> Option<(f64, f64)> {
    let mut all: Vec<f64> = draws(model, Sampling::default())?.iter().filter_map(|draw| diameter(draw, law)).collect();
    all.sort_by(f64::total_cmp);
    let out = all.len() / 40;
    Some((*all.get(out)?, *all.get(all.len().checked_sub(1 + out)?)?))
}
