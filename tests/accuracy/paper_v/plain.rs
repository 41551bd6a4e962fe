//! The plain call on the paper's manoeuvres: neither source, law nor method is named. The ship's
//! own model, which is the truth, is no source.

use std::collections::BTreeMap;

use rand_chacha::ChaCha8Rng;
use sistership_identification::refine::RefinementSettings;
use sistership_model::trial::Trial;
use sistership_model::{Law, Model, Zoo};
use sistership_model_selection::{StartRequest, best_start};
use sistership_simulation::Trajectory;

use super::refined::TURNS;
use super::truth::Truth;
use super::weak::measured;

/// The model that the plain call gives for some zigzags and the turns to both sides, with its law.
pub fn refined(
    zoo: &Zoo,
    truth: &Truth,
    zigzags: &[(f64, f64)],
    rng: &mut ChaCha8Rng,
) -> (Model, Law) {
    let mut tracks: Vec<Trajectory> = zigzags
        .iter()
        .map(|&(rudder_deg, heading_deg)| truth.zigzag(rudder_deg, heading_deg))
        .collect();
    tracks.extend(TURNS.map(|rudder_deg| truth.turn(rudder_deg)));
    let trials: Vec<Trial> =
        tracks.iter().enumerate().map(|(k, track)| named(measured(track, rng), k)).collect();
    let trials: Vec<&Trial> = trials.iter().collect();
    let target = zoo.vessel("sr108").expect("a ship of the zoo");
    let asked = StartRequest {
        zoo,
        target,
        champions: &BTreeMap::new(),
        trials: &trials,
        settings: &RefinementSettings::default(),
        preference: Default::default(),
    };
    let start = best_start(&asked, &|_, _| true).unwrap_or_else(|error| panic!("{error}"));
    let entrant = start.entrant;
    assert_ne!(entrant.source_name(), Some("sr108"), "the truth is no source");
    println!(
        "  {} rpm: {} by {}, {}",
        (60.0 * truth.n_rps).round(),
        entrant.law.name,
        entrant.source_name().unwrap_or("no source"),
        start.settings.method.name()
    );
    (start.refinement.model, (*entrant.law).clone())
}

fn named(trial: Trial, place: usize) -> Trial {
    Trial { name: format!("{place}"), ..trial }
}
