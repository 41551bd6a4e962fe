//! Measured data: the Esso Osaka model refined from the zoo with `auto`, judged on manoeuvres left out.

use sistership_dynamics::Ship;
use sistership_dynamics::error::{SquaredError, standard_deviations, standardised_mse};
use sistership_dynamics::recorded::{ReplaySettings, replay};
use sistership_identify::refine::{Family, Method, Refinement, Request, Settings, refine};
use sistership_identify::source::{best_source, similar};
use sistership_identify::transfer::{approach_of, blank};
use sistership_model::{Trial, Zoo};
use sistership_tests::{esso_osaka, shared};

/// Turning and zigzag trials; the `turn_cut` files overlap their parents and are left out.
fn trials() -> Option<Vec<Trial>> {
    let folder = shared::data("esso-osaka")?;
    Some(esso_osaka::trials(&folder, &["turning/turn_1", "zigzag/"]))
}

fn refined(trials: &[Trial], held_out: Vec<String>) -> Refinement {
    let zoo = Zoo::embedded().unwrap_or_else(|error| panic!("{error}"));
    let target = zoo.vessel("esso-osaka-3m").expect("the ship is in the zoo");
    let trials: Vec<&Trial> = trials.iter().collect();
    let ranking = similar(&zoo, target, None, &trials);
    for ranked in ranking.ranking.iter().filter(|ranked| ranked.model.is_some()) {
        println!(
            "{:<12} {:+.3} eligible {}: {}",
            ranked.ship,
            ranked.correlation.unwrap_or(f64::NAN),
            ranked.eligible,
            ranked.reasons.join("; ")
        );
    }
    let source = best_source(&zoo, &ranking).unwrap_or_else(|reason| panic!("{reason}"));
    let law = zoo.law(&source.law).expect("the law of a zoo model");
    let settings = Settings { held_out, ..Settings::default() };
    let request = Request { target, source: &source, law, trials: &trials, settings: &settings };
    refine(&request, &|_, _| true).unwrap_or_else(|error| panic!("{error}"))
}

/// Prints the errors before and after, and asserts that every velocity and the heading have improved.
fn judge(refinement: &Refinement) {
    println!("source {}; {}", refinement.source, refinement.held_out.how);
    for channel in ["u", "v", "r", "psi", "x", "y"] {
        let (before, after) = (refinement.held_out.source[channel], refinement.held_out.refined[channel]);
        println!("{channel:>4} {before:10.4} -> {after:10.4}  factor {:.2}", before / after);
    }
    for channel in ["u", "v", "r", "psi"] {
        assert!(refinement.held_out.refined[channel] < refinement.held_out.source[channel], "{channel} did not improve");
    }
    let diverged: Vec<_> = refinement.options.iter().filter_map(|option| option.reason.as_ref()).collect();
    assert!(diverged.is_empty(), "{diverged:?}");
    assert!(refinement.manoeuvres.refined.failures.is_empty(), "{:?}", refinement.manoeuvres.refined.failures);
}

#[test]
fn esso_osaka_cross_validated_by_manoeuvre() {
    let Some(trials) = trials() else { return };
    judge(&refined(&trials, Vec::new()));
}

/// Every fourth trial is kept out of fit and choice alike.
#[test]
fn esso_osaka_on_trials_that_nothing_has_seen() {
    let Some(trials) = trials() else { return };
    let held_out = trials.iter().skip(3).step_by(4).map(|trial| trial.name.clone()).collect();
    judge(&refined(&trials, held_out));
}

/// Restart and scatter of the score of Wakita et al. 2022, Eq. 26.
const RESTART_S: f64 = 100.0;
const KINDS: [&str; 4] = ["random", "turning", "zigzag", "berthing"];

/// Every trial simulated by a model that was fitted without it, in four folds; the parts of a trial stay together.
fn left_out(trials: &[Trial], method: Method) -> Vec<(String, SquaredError)> {
    let zoo = Zoo::embedded().unwrap_or_else(|error| panic!("{error}"));
    let target = zoo.vessel("esso-osaka-3m").expect("the ship is in the zoo");
    let law = zoo.law("low-speed").expect("a law of the zoo");
    let fold_of = |trial: &Trial, k: usize| if trial.name.contains("15_58_08") { 0 } else { k % 4 };
    let settings = Settings { method, restart_s: Some(RESTART_S), families: vec![Family::Own], ..Settings::default() };
    let mut errors = Vec::new();
    for fold in 0..4 {
        let inside: Vec<&Trial> = trials.iter().enumerate().filter(|(k, t)| fold_of(t, *k) != fold).map(|(_, t)| t).collect();
        let source = blank(law, target, approach_of(&inside)).unwrap_or_else(|error| panic!("{error}"));
        let request = Request { target, source: &source, law, trials: &inside, settings: &settings };
        let model = refine(&request, &|_, _| true).unwrap_or_else(|error| panic!("{error}")).model;
        for (_, trial) in trials.iter().enumerate().filter(|(k, trial)| fold_of(trial, *k) == fold) {
            let mut ship = Ship::new(&model, law).expect("a ready ship");
            ship.set_envelope_speed(1.0);
            let settings = ReplaySettings { restart_s: Some(RESTART_S), ..ReplaySettings::default() };
            let run = replay(&ship, trial, &settings).expect("every channel that the law needs");
            assert_eq!(run.stopped, None, "{} by {}", trial.name, method.name());
            errors.push((trial.name.clone(), SquaredError::of(trial, &run)));
        }
    }
    errors
}

/// Every file, from rest to full speed: the estimators on one law without a source, each cross-validated by file.
#[test]
fn estimators_on_every_trial_of_esso_osaka() {
    let Some(folder) = shared::data("esso-osaka") else { return };
    let trials = esso_osaka::trials(&folder, &KINDS);
    let deviations = standard_deviations(&trials.iter().collect::<Vec<_>>());
    let [published, weak, trajectory] = Method::ALL.map(|method| left_out(&trials, method));
    println!(
        "standardised mean squared error, restarted every {RESTART_S} s, trials left out\nkind      published    weak   trajectory"
    );
    let mut totals = [0.0; 3];
    for kind in KINDS.iter().copied().chain(["all"]) {
        totals = [&published, &weak, &trajectory].map(|errors| {
            let mut sum = SquaredError::default();
            let of_kind = errors.iter().filter(|(name, _)| kind == "all" || name.contains(file_prefix(kind)));
            of_kind.for_each(|(_, error)| sum.add(error));
            standardised_mse(&sum, &deviations)
        });
        println!("{kind:<9} {:9.4} {:9.4} {:9.4}", totals[0], totals[1], totals[2]);
    }
    assert!(totals[2] < 0.9 * totals[0].min(totals[1]), "{totals:?}");
}

/// What the names of a kind's files begin with.
fn file_prefix(kind: &str) -> &str {
    if kind == "turning" { "turn_" } else { kind }
}
