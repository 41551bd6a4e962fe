//! The measured trials of Esso Osaka, their folds, and the law refined against some of them.

use std::path::{Path, PathBuf};

use sistership_identification::refine::{
    EstimationMethod, RefinementSettings, RefinementSpec, TermFamily, refine,
};
use sistership_model::{Law, Model, Trial, Zoo};
use sistership_priors::transfer::{blank_model, trial_approach};

use crate::esso_osaka;
use crate::score::{KINDS, RESTART_S};

/// Every given trial; none, said plainly, where the data are missing.
pub fn trials() -> Option<Vec<Trial>> {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = here
        .ancestors()
        .map(|above| -> PathBuf { above.join("shared/data/esso-osaka") })
        .find(|folder| folder.exists());
    if folder.is_none() {
        println!("skipped: there is no shared/data/esso-osaka beside the project");
    }
    Some(esso_osaka::trials(&folder?, &KINDS))
}

/// The folds of docs/evidence/estimators.md: the parts of a trial stay together.
pub fn fold_of(trial: &Trial, place: usize, folds: usize) -> usize {
    if trial.name.contains("15_58_08") { 0 } else { place % folds }
}

/// The ship's law of the zoo.
pub fn law(zoo: &Zoo) -> &Law {
    zoo.law("low-speed").expect("a law of the zoo")
}

/// The law without anything known of it.
pub fn nothing(zoo: &Zoo, inside: &[&Trial]) -> Model {
    let target = zoo.vessel("esso-osaka-3m").expect("the ship is in the zoo");
    blank_model(law(zoo), target, trial_approach(inside)).unwrap_or_else(|error| panic!("{error}"))
}

/// The law refined on trials as in docs/evidence/estimators.md.
pub fn refined(zoo: &Zoo, inside: &[&Trial]) -> Model {
    let target = zoo.vessel("esso-osaka-3m").expect("the ship is in the zoo");
    let source = nothing(zoo, inside);
    let settings = RefinementSettings {
        method: EstimationMethod::Trajectory,
        restart_s: Some(RESTART_S),
        families: vec![TermFamily::Own],
        strengths: vec![1e-1, 1e-2, 1e-3],
        ..RefinementSettings::default()
    };
    let law = law(zoo);
    let request = RefinementSpec {
        target,
        source: &source,
        source_law: None,
        law,
        trials: inside,
        population: &[],
        settings: &settings,
    };
    refine(&request, &|_, _| true).unwrap_or_else(|error| panic!("{error}")).model
}
