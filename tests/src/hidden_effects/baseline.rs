//! The fitted model: a source ship refined on twelve clean trials, with what they leave open.

use std::sync::{Arc, LazyLock};

use sistership_diagnosis::{self as diagnose, Diagnosis, calibrate_model};
use sistership_identification::refine::{RefinementSettings, RefinementSpec, refine};
use sistership_model::{Effect, Law, Model, Trial};

use super::truth::{Hidden, Manoeuvre, Sailing, ZOO, trials};

/// A model with its law, ready to be diagnosed.
pub struct Baseline {
    pub model: Model,
    pub law: Arc<Law>,
}

/// The fitted model of the benchmark; `DIAGNOSIS_SOURCE` names another source ship than the
/// Mariner.
pub static BASELINE: LazyLock<Baseline> = LazyLock::new(|| {
    let source = std::env::var("DIAGNOSIS_SOURCE").unwrap_or_else(|_| "mariner".into());
    let trials = trials(&Hidden::default(), &programme(), 0);
    let trials: Vec<&Trial> = trials.iter().collect();
    fitted(&source, "sr108", &trials)
});

/// The library.
pub fn library() -> Vec<Arc<Effect>> {
    ZOO.effects().cloned().collect()
}

/// A source of the zoo refined on a ship's trials and calibrated on them.
pub fn fitted(source: &str, ship: &str, trials: &[&Trial]) -> Baseline {
    refined(&ZOO.find_model(source).unwrap_or_else(|error| panic!("{error}")), ship, trials)
}

/// As [`fitted`], from a model.
pub fn refined(source: &Model, ship: &str, trials: &[&Trial]) -> Baseline {
    let law = ZOO.law(&source.law).unwrap().clone();
    by(source, &law, ship, trials, &RefinementSettings::default())
}

/// As [`refined`], by a law and settings.
pub fn by(
    source: &Model,
    law: &Arc<Law>,
    ship: &str,
    trials: &[&Trial],
    settings: &RefinementSettings,
) -> Baseline {
    let target = ZOO.vessel(ship).unwrap();
    let request =
        RefinementSpec { target, source, source_law: None, law, trials, population: &[], settings };
    let refinement = refine(&request, &|_, _| true).unwrap_or_else(|error| panic!("{error}"));
    let (before, after) = (&refinement.held_out.source, &refinement.held_out.refined);
    println!("refined from {}, held-out errors:", refinement.source);
    for channel in ["u", "v", "r", "psi", "x", "y"] {
        println!("{channel:>6} {:10.5} -> {:10.5}", before[channel], after[channel]);
    }
    let mut model = refinement.model;
    let uncertainty = calibrate_model(&model, law, &library(), trials, None)
        .unwrap_or_else(|error| panic!("{error}"));
    println!("discrepancy {:?}", uncertainty.discrepancy);
    model.uncertainty = Some(uncertainty);
    Baseline { model, law: law.clone() }
}

/// What a diagnosis by the library finds of trials beside a model.
pub fn diagnosed(
    baseline: &Baseline,
    trials: &[Trial],
    settings: &diagnose::Settings,
) -> Diagnosis {
    let trials: Vec<&Trial> = trials.iter().collect();
    let request = diagnose::DiagnosisInputs {
        model: &baseline.model,
        law: &baseline.law,
        effects: &library(),
        trials: &trials,
        settings,
    };
    diagnose::diagnose(&request, &|_, _| true).unwrap_or_else(|error| panic!("{error}"))
}

/// Twelve clean trials: six zigzags that start to either side, and turns of three angles to both.
pub fn programme() -> Vec<Sailing> {
    let zigzags =
        [(10.0, 10.0), (-10.0, 10.0), (20.0, 10.0), (-20.0, 10.0), (10.0, 5.0), (-15.0, 10.0)];
    let zigzags = zigzags.map(|(rudder, switch)| Manoeuvre::Zigzag(rudder, switch));
    let turns = [8.0, -8.0, 12.0, -12.0, 20.0, -20.0].map(Manoeuvre::Turn);
    let headings = [0.0, 90.0].into_iter().cycle();
    let manoeuvres = zigzags.into_iter().chain(turns);
    manoeuvres
        .zip(headings)
        .map(|(manoeuvre, heading_deg)| Sailing { manoeuvre, heading_deg, execute_s: 60.0 })
        .collect()
}
