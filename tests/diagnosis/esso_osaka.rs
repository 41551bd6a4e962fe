//! Measured data: the Esso Osaka model, with the wind left undeclared, and a placebo.

use sistership_identify::diagnose::{Diagnosis, Request, Settings, diagnose};
use sistership_identify::source::{best_source, similar};
use sistership_model::Trial;
use sistership_model::trial::Channel;
use sistership_tests::{esso_osaka, shared};

use super::baseline::{Baseline, library, refined};
use super::truth::ZOO;

const SHIP: &str = "esso-osaka-3m";

/// Every other trial to fit on, the rest to diagnose, so that both days and both manoeuvres are in each.
fn halves() -> Option<(Vec<Trial>, Vec<Trial>)> {
    let folder = shared::data("esso-osaka")?;
    let trials = esso_osaka::trials(&folder, &["turning/turn_1", "zigzag/"]);
    let (even, odd): (Vec<_>, Vec<_>) = trials.into_iter().enumerate().partition(|(k, _)| k % 2 == 0);
    let plain = |half: Vec<(usize, Trial)>| half.into_iter().map(|(_, trial)| trial).collect();
    Some((plain(even), plain(odd)))
}

/// The best source of the zoo, refined without any effect.
fn baseline(trials: &[Trial]) -> Baseline {
    let trials: Vec<&Trial> = trials.iter().collect();
    let ranking = similar(&ZOO, ZOO.vessel(SHIP).unwrap(), None, &trials);
    let source = best_source(&ZOO, &ranking).unwrap_or_else(|reason| panic!("{reason}"));
    refined(&source, SHIP, &trials)
}

fn diagnosed(baseline: &Baseline, trials: &[Trial]) -> Diagnosis {
    let trials: Vec<&Trial> = trials.iter().collect();
    let (settings, effects) = (Settings::default(), library());
    let request = Request { model: &baseline.model, law: &baseline.law, effects: &effects, trials: &trials, settings: &settings };
    let diagnosis = diagnose(&request, &|_, _| true).unwrap_or_else(|error| panic!("{error}"));
    println!("{:?}; {}", diagnosis.verdict, diagnosis.how);
    for hypothesis in diagnosis.hypotheses.iter().take(8) {
        println!("  {:?} evidence {:.1} held out {:?}", hypothesis.effects, hypothesis.evidence, hypothesis.held_out);
    }
    for found in &diagnosis.effects {
        println!("  {}/{} evidence {:.1}: {:?}", found.name, found.form, found.evidence, found.parameters);
    }
    for channel in ["u", "v", "r", "psi", "x", "y"] {
        let (before, after) = (diagnosis.before[channel], diagnosis.after[channel]);
        println!("{channel:>6} {before:10.5} -> {after:10.5}  factor {:.2}", before / after);
    }
    diagnosis
}

fn names_wind(diagnosis: &Diagnosis) -> bool {
    diagnosis.effects.iter().any(|found| found.name == "wind")
}

/// The wind of another time: everything about it is real but when it blew.
fn with_placebo(trial: &Trial) -> Trial {
    let mut trial = trial.clone();
    for channel in [Channel::WindSpeed, Channel::WindFrom] {
        let column = trial.channels.get_mut(&channel).unwrap();
        let half = column.len() / 2;
        column.rotate_left(half);
    }
    trial
}

#[test]
#[ignore = "not met yet: positions and velocities of this data disagree by a second, which stands before the wind"]
fn the_wind_is_named_and_the_placebo_is_not() {
    let Some((fit, judged)) = halves() else { return };
    let baseline = baseline(&fit);
    println!("fitted on {} trials, diagnosed on {}", fit.len(), judged.len());
    let with_wind = diagnosed(&baseline, &judged);
    println!("placebo:");
    let placebo = diagnosed(&baseline, &judged.iter().map(with_placebo).collect::<Vec<_>>());
    assert!(names_wind(&with_wind), "wind is not named");
    for channel in ["v", "r"] {
        assert!(with_wind.after[channel] < with_wind.before[channel], "{channel} did not improve");
    }
    assert!(!names_wind(&placebo), "the placebo is taken for wind");
}
