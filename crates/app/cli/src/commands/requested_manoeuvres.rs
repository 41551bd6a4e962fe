//! Simulation of the requested manoeuvres.

use sistership_simulation::manoeuvre::{
    ManoeuvreSettings, StandardManoeuvres, simulate_standard_manoeuvres, simulate_turn,
    simulate_zigzag,
};
use sistership_simulation::{Ship, Trajectory};

/// Simulates the requested turns and zigzags, or the standard set if `usual`; a manoeuvre that
/// diverges is a failure in the result.
pub fn simulate_requested(
    ship: &Ship,
    turns: &[f64],
    zigzags: &[(f64, f64)],
    usual: bool,
    settings: &ManoeuvreSettings,
) -> (StandardManoeuvres, Vec<Trajectory>) {
    if usual {
        // Tracks are written for a single requested manoeuvre only.
        return (simulate_standard_manoeuvres(ship, settings), Vec::new());
    }
    let (mut sailed, mut tracks) = (StandardManoeuvres::default(), Vec::new());
    for rudder in turns {
        let name = format!("turn {rudder} deg");
        match simulate_turn(ship, *rudder, settings) {
            Ok(turn) => {
                sailed.record_excursion(&name, ship, &turn.track);
                sailed.turns.push(turn.metrics);
                tracks.push(turn.track);
            }
            Err(stopped) => sailed.failures.push(format!("{name}: {stopped}")),
        }
    }
    for (rudder, switch) in zigzags {
        let name = format!("zigzag {rudder}/{switch}");
        match simulate_zigzag(ship, *rudder, *switch, settings) {
            Ok(zigzag) => {
                sailed.record_excursion(&name, ship, &zigzag.track);
                sailed.zigzags.push(zigzag.metrics);
                tracks.push(zigzag.track);
            }
            Err(stopped) => sailed.failures.push(format!("{name}: {stopped}")),
        }
    }
    (sailed, tracks)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use sistership_model::Zoo;

    #[test]
    fn what_is_asked_for_is_sailed_and_nothing_else() {
        let zoo = Zoo::load_embedded().unwrap();
        let ship =
            Ship::new(&zoo.find_model("mariner").unwrap(), zoo.law("abkowitz").unwrap()).unwrap();
        let (sailed, tracks) =
            simulate_requested(&ship, &[35.0, -35.0], &[], false, &ManoeuvreSettings::default());
        assert_eq!(
            (sailed.turns.len(), sailed.zigzags.len(), sailed.imo.len(), tracks.len()),
            (2, 0, 0, 2)
        );
        let (all, tracks) =
            simulate_requested(&ship, &[], &[], true, &ManoeuvreSettings::default());
        assert!(!all.imo.is_empty() && tracks.is_empty());
    }
}
