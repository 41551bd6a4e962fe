//! Tactical diameters at 35 deg of rudder.

use sistership_assessment::uncertainty::{Sampling, draw_from_posterior};
use sistership_model::{Law, Model};
use sistership_simulation::Ship;
use sistership_simulation::manoeuvre::{
    Manoeuvre, ManoeuvreSettings, TurningCircle, simulate_manoeuvre_batch,
};

const TURN_DEG: f64 = 35.0;

/// That of a model, m; none where it does not come round.
pub fn diameter(model: &Model, law: &Law) -> Option<f64> {
    diameters(&Ship::new(model, law).ok()?, &[Vec::new()]).pop()?
}

/// Between which 95 % of the draws from a model's posterior are, m.
pub fn band(model: &Model, law: &Law) -> Option<(f64, f64)> {
    let ship = Ship::with_open_coefficients(model, law).ok()?;
    let sisters: Vec<Vec<f64>> = draw_from_posterior(model, Sampling::default())?
        .iter()
        .map(|draw| ship.open_coefficient_values(draw))
        .collect::<Option<_>>()?;
    let mut all: Vec<f64> = diameters(&ship, &sisters).into_iter().flatten().collect();
    all.sort_by(f64::total_cmp);
    let out = all.len() / 40;
    Some((*all.get(out)?, *all.get(all.len().checked_sub(1 + out)?)?))
}

/// Those of sisters, in lockstep.
fn diameters(ship: &Ship, sisters: &[Vec<f64>]) -> Vec<Option<f64>> {
    let step_s = Some(0.02 * ship.lpp_m() / ship.approach_speed_m_s());
    let settings = ManoeuvreSettings { step_s, ..ManoeuvreSettings::default() };
    let turns: Vec<(Manoeuvre, &[f64])> = sisters
        .iter()
        .map(|sister| (Manoeuvre::Turn { rudder: TURN_DEG }, sister.as_slice()))
        .collect();
    let sailed = simulate_manoeuvre_batch(ship, &turns, &settings).into_iter();
    sailed
        .map(|sailed| {
            TurningCircle::from_manoeuvre(sailed.ok()?, TURN_DEG).ok()?.metrics.tactical_diameter_m
        })
        .collect()
}
