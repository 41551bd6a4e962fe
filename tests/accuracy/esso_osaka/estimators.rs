//! The estimators on one law without a source.

use sistership_identification::refine::{
    CmaEs, EstimationMethod, RefinementSettings, RefinementSpec, refine,
};
use sistership_model::{Trial, Zoo};
use sistership_priors::transfer::{blank_model, trial_approach};
use sistership_simulation::error::SquaredError;
use sistership_tests::{esso_osaka, shared};

use super::compared;
use super::score::{KINDS, RESTART_S, by_source, of_kind, over_all, over_each, simulated};

/// The estimators that take seconds.
const QUICK: [EstimationMethod; 3] =
    [EstimationMethod::Published, EstimationMethod::Weak, EstimationMethod::Trajectory];

/// Every trial simulated by a model that was fitted without it, in four folds; the parts of a trial
/// stay together.
fn left_out(trials: &[Trial], settings: &RefinementSettings) -> Vec<(String, SquaredError)> {
    let zoo = Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"));
    let target = zoo.vessel("esso-osaka-3m").expect("the ship is in the zoo");
    let law = zoo.law("low-speed").expect("a law of the zoo");
    let fold_of = |trial: &Trial, k: usize| if trial.name.contains("15_58_08") { 0 } else { k % 4 };
    let mut errors = Vec::new();
    for fold in 0..4 {
        let inside: Vec<&Trial> = trials
            .iter()
            .enumerate()
            .filter(|(k, t)| fold_of(t, *k) != fold)
            .map(|(_, t)| t)
            .collect();
        let source = blank_model(law, target, trial_approach(&inside))
            .unwrap_or_else(|error| panic!("{error}"));
        let request = RefinementSpec {
            target,
            source: &source,
            source_law: None,
            law,
            trials: &inside,
            population: &[],
            settings,
        };
        let model = refine(&request, &|_, _| true).unwrap_or_else(|error| panic!("{error}")).model;
        let outside: Vec<&Trial> = trials
            .iter()
            .enumerate()
            .filter(|(k, t)| fold_of(t, *k) == fold)
            .map(|(_, t)| t)
            .collect();
        errors.extend(simulated(&model, law, &outside));
    }
    errors
}

/// Every file, from rest to full speed: the estimators on one law without a source, each
/// cross-validated by file. Wakita's score is a sum over six states; here it is their mean, first
/// by the variances over all files, then, as for files judged each on its own, by those within
/// each, where a zigzag hardly moves across and little is much.
#[test]
fn estimators_on_every_trial_of_esso_osaka() {
    let Some(folder) = shared::data("esso-osaka") else { return };
    let trials = esso_osaka::trials(&folder, &KINDS);
    let by_method = QUICK.map(|method| left_out(&trials, &compared(method)));
    let sources = ["kvlcc2", "esso-tanker"].map(|name| (name, by_source(&trials, name)));
    println!(
        "standardised mean squared error, mean over u, v, r, psi, x, y; restarted every \
         {RESTART_S} s, trials left out"
    );
    println!("          by variances over all files       by variances of each file");
    println!("kind      published     weak trajectory     published     weak trajectory");
    let mut totals = [0.0; 3];
    for kind in KINDS.iter().copied().chain(["all"]) {
        totals = by_method.each_ref().map(|errors| over_all(&trials, errors, kind));
        let each = by_method.each_ref().map(|errors| over_each(&trials, errors, kind));
        let row =
            totals.iter().chain(&each).map(|error| format!("{error:10.4}")).collect::<Vec<_>>();
        println!("{kind:<9}{}   {}", row[..3].concat(), row[3..].concat());
    }
    println!(
        "scaled sources, not refined, by variances over all files (in brackets: trials of so many \
         that they can sail)"
    );
    for kind in KINDS.iter().copied().chain(["all"]) {
        let of = |errors: &Vec<(String, SquaredError)>| {
            format!(
                "{:10.4} ({} of {})",
                over_all(&trials, errors, kind),
                of_kind(errors, kind).count(),
                of_kind(&by_method[0], kind).count()
            )
        };
        println!(
            "{kind:<9}{}",
            sources.each_ref().map(|(name, errors)| format!("  {name} {}", of(errors))).concat()
        );
    }
    assert!(totals[2] < 0.75 * totals[0].min(totals[1]), "{totals:?}");
    assert!(totals[2] < 0.030, "{totals:?}");
}

/// The search given ten times the time that `trajectory` takes, on the same folds; its fits with
/// trials left out, by which it is weighed, take almost half of that. Run with `--release --
/// --ignored --nocapture`.
#[test]
#[ignore = "takes minutes"]
fn the_search_given_ten_times_the_time() {
    let Some(folder) = shared::data("esso-osaka") else { return };
    let trials = esso_osaka::trials(&folder, &KINDS);
    let begun = std::time::Instant::now();
    let by_trajectory = left_out(&trials, &compared(EstimationMethod::Trajectory));
    let trajectory_s = begun.elapsed().as_secs_f64() / 4.0;
    let searched = CmaEs {
        evaluations: usize::MAX,
        wall_s: Some(10.0 * trajectory_s / 1.8),
        ..CmaEs::default()
    };
    let settings =
        RefinementSettings { cma_es: Some(searched), ..compared(EstimationMethod::CmaEs) };
    let begun = std::time::Instant::now();
    let by_search = left_out(&trials, &settings);
    println!(
        "trajectory {trajectory_s:.1} s a fold, cma-es {:.1} s",
        begun.elapsed().as_secs_f64() / 4.0
    );
    println!("          by variances over all files   by variances of each file");
    println!("kind      trajectory    cma-es         trajectory    cma-es");
    let mut totals = [0.0; 2];
    for kind in KINDS.iter().copied().chain(["all"]) {
        totals = [&by_trajectory, &by_search].map(|errors| over_all(&trials, errors, kind));
        let each = [&by_trajectory, &by_search].map(|errors| over_each(&trials, errors, kind));
        println!(
            "{kind:<9}{:10.4}{:10.4}       {:10.4}{:10.4}",
            totals[0], totals[1], each[0], each[1]
        );
    }
    assert!(totals[0] <= totals[1], "{totals:?}");
}
