//! Stopping and course-keeping ability of the refined model.

use sistership_simulation::manoeuvre::{
    FurtherManoeuvres, FurtherSelection, ManoeuvreSettings, simulate_further_manoeuvres,
};
use sistership_simulation::{PlantError, Ship};

use super::input::RefinementInput;

/// Simulates the usual additional manoeuvres with the refined model.
pub(crate) fn simulate_further(
    input: &RefinementInput<'_>,
) -> Result<FurtherManoeuvres, PlantError> {
    let (model, law) = (&input.refinement.model, input.law);
    let ship = Ship::new(model, law)?;
    Ok(simulate_further_manoeuvres(
        model,
        law,
        &ship,
        &ManoeuvreSettings::default(),
        &FurtherSelection::default_selection(),
    ))
}

/// Remarks that are needed to read the figures.
pub(crate) fn further_remarks(sailed: &FurtherManoeuvres, lpp_m: f64) -> Vec<String> {
    let stable = match sailed.straight_line_stable {
        Some(true) => {
            Some("according to pull-outs to both sides, the ship is straight-line stable")
        }
        Some(false) => Some("according to pull-outs, the ship is not straight-line stable"),
        None if sailed.pull_outs.is_empty() => None,
        None => Some("pull-outs do not decide whether the ship is straight-line stable"),
    };
    let mut all = sailed.reader_remarks(lpp_m);
    all.extend(stable.map(str::to_owned));
    all
}
