//! Measured data: the Esso Osaka model refined from the zoo with `auto`, judged on manoeuvres left out.

use sistership_dynamics::Ship;
use sistership_dynamics::error::{SquaredError, standard_deviations, standardised_mse};
use sistership_dynamics::recorded::{ReplaySettings, replay};
use sistership_identify::refine::{CmaEs, Family, Method, Refinement, Request, Settings, refine};
use sistership_identify::source::{best_source, similar};
use sistership_identify::transfer::{approach_of, blank, transfer};
use sistership_model::{Law, Model, Trial, Zoo};
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
    let request = Request { target, source: &source, source_law: None, law, trials: &trials, settings: &settings };
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

/// The estimators that take seconds.
const QUICK: [Method; 3] = [Method::Published, Method::Weak, Method::Trajectory];

/// Every trial simulated by a model that was fitted without it, in four folds; the parts of a trial stay together.
fn left_out(trials: &[Trial], settings: &Settings) -> Vec<(String, SquaredError)> {
    let zoo = Zoo::embedded().unwrap_or_else(|error| panic!("{error}"));
    let target = zoo.vessel("esso-osaka-3m").expect("the ship is in the zoo");
    let law = zoo.law("low-speed").expect("a law of the zoo");
    let fold_of = |trial: &Trial, k: usize| if trial.name.contains("15_58_08") { 0 } else { k % 4 };
    let mut errors = Vec::new();
    for fold in 0..4 {
        let inside: Vec<&Trial> = trials.iter().enumerate().filter(|(k, t)| fold_of(t, *k) != fold).map(|(_, t)| t).collect();
        let source = blank(law, target, approach_of(&inside)).unwrap_or_else(|error| panic!("{error}"));
        let request = Request { target, source: &source, source_law: None, law, trials: &inside, settings };
        let model = refine(&request, &|_, _| true).unwrap_or_else(|error| panic!("{error}")).model;
        let outside: Vec<&Trial> = trials.iter().enumerate().filter(|(k, t)| fold_of(t, *k) == fold).map(|(_, t)| t).collect();
        errors.extend(simulated(&model, law, &outside));
    }
    errors
}

/// Every trial simulated by a source ship's model, scaled to this one and not refined; those that leave the physical range have
/// no error.
fn by_source(trials: &[Trial], name: &str) -> Vec<(String, SquaredError)> {
    let zoo = Zoo::embedded().unwrap_or_else(|error| panic!("{error}"));
    let target = zoo.vessel("esso-osaka-3m").expect("the ship is in the zoo");
    let source = zoo.model(name).unwrap_or_else(|error| panic!("{error}"));
    let law = zoo.law(&source.law).expect("the law of a zoo model");
    let scaled = transfer(&source, law, target, approach_of(&trials.iter().collect::<Vec<_>>()));
    let mut ship = Ship::new(&scaled, law).expect("a ready ship");
    ship.set_envelope_speed(1.0);
    let restarted = ReplaySettings { restart_s: Some(RESTART_S), ..ReplaySettings::default() };
    let run = |trial: &Trial| replay(&ship, trial, &restarted).expect("every channel that the law needs");
    let sailed = trials.iter().map(|trial| (trial, run(trial))).filter(|(_, run)| run.stopped.is_none());
    sailed.map(|(trial, run)| (trial.name.clone(), SquaredError::of(trial, &run))).collect()
}

/// The estimators that are compared: the weak and the trajectory form among few strengths, which is enough and quicker.
fn compared(method: Method) -> Settings {
    let strengths = if method == Method::Published { Vec::new() } else { vec![1e-1, 1e-2, 1e-3] };
    Settings { method, restart_s: Some(RESTART_S), families: vec![Family::Own], strengths, ..Settings::default() }
}

/// Every file, from rest to full speed: the estimators on one law without a source, each cross-validated by file. Wakita's score
/// is a sum over six states; here it is their mean, first by the variances over all files, then, as for files judged each
/// on its own, by those within each, where a zigzag hardly moves across and little is much.
#[test]
fn estimators_on_every_trial_of_esso_osaka() {
    let Some(folder) = shared::data("esso-osaka") else { return };
    let trials = esso_osaka::trials(&folder, &KINDS);
    let by_method = QUICK.map(|method| left_out(&trials, &compared(method)));
    let sources = ["kvlcc2", "esso-tanker"].map(|name| (name, by_source(&trials, name)));
    println!("standardised mean squared error, mean over u, v, r, psi, x, y; restarted every {RESTART_S} s, trials left out");
    println!("          by variances over all files       by variances of each file");
    println!("kind      published     weak trajectory     published     weak trajectory");
    let mut totals = [0.0; 3];
    for kind in KINDS.iter().copied().chain(["all"]) {
        totals = by_method.each_ref().map(|errors| over_all(&trials, errors, kind));
        let each = by_method.each_ref().map(|errors| over_each(&trials, errors, kind));
        let row = totals.iter().chain(&each).map(|error| format!("{error:10.4}")).collect::<Vec<_>>();
        println!("{kind:<9}{}   {}", row[..3].concat(), row[3..].concat());
    }
    println!("scaled sources, not refined, by variances over all files (in brackets: trials of so many that they can sail)");
    for kind in KINDS.iter().copied().chain(["all"]) {
        let of = |errors: &Vec<(String, SquaredError)>| {
            format!(
                "{:10.4} ({} of {})",
                over_all(&trials, errors, kind),
                of_kind(errors, kind).count(),
                of_kind(&by_method[0], kind).count()
            )
        };
        println!("{kind:<9}{}", sources.each_ref().map(|(name, errors)| format!("  {name} {}", of(errors))).concat());
    }
    assert!(totals[2] < 0.75 * totals[0].min(totals[1]), "{totals:?}");
    assert!(totals[2] < 0.030, "{totals:?}");
}

/// Few files, and a source of another law: each set is some files of every kind, evenly spread.
const FEW: [(usize, usize); 6] = [(2, 0), (2, 5), (4, 1), (4, 7), (8, 2), (8, 3)];

/// What the KVLCC2's MMG model says, as the prior of a polynomial fitted on few files, against the same fit without a source. With two
/// files nothing but a source makes a model of so many coefficients.
#[test]
fn a_source_of_another_law_helps_where_trials_are_few() {
    let Some(folder) = shared::data("esso-osaka") else { return };
    let trials = esso_osaka::trials(&folder, &KINDS);
    let zoo = Zoo::embedded().unwrap_or_else(|error| panic!("{error}"));
    let (target, law) = (zoo.vessel("esso-osaka-3m").expect("in the zoo"), zoo.law("low-speed").expect("in the zoo"));
    let kvlcc2 = zoo.model("kvlcc2").unwrap_or_else(|error| panic!("{error}"));
    let own = zoo.law(&kvlcc2.law).expect("in the zoo");
    let settings = Settings { strengths: vec![1e1, 1.0, 1e-1, 1e-2, 1e-3], ..compared(Method::Weak) };
    let as_it_is = over_all(&trials, &by_source(&trials, "kvlcc2"), "all");
    println!("standardised mean squared error of the other files; the source as it is: {as_it_is:.4}");
    println!("files  first  without  with the source");
    let mut sums = [0.0; 2];
    for (count, first) in FEW {
        let chosen = |k: usize| (0..count).any(|i| (first + i * (trials.len() / count)) % trials.len() == k);
        let (inside, outside): (Vec<_>, Vec<_>) = trials.iter().enumerate().partition(|(k, _)| chosen(*k));
        let [inside, outside] = [inside, outside].map(|some| some.into_iter().map(|(_, trial)| trial).collect::<Vec<_>>());
        let nothing = blank(law, target, approach_of(&inside)).unwrap_or_else(|error| panic!("{error}"));
        let error = |source: &Model, source_law: &Law| {
            let request = Request { target, source, source_law: Some(source_law), law, trials: &inside, settings: &settings };
            let model = refine(&request, &|_, _| true).ok()?.model;
            Some(over_all(&trials, &simulated(&model, law, &outside), "all"))
        };
        let (without, with) = (error(&nothing, law), error(&kvlcc2, own).expect("a refined model"));
        println!("{count:5}  {first:5}  {}  {with:.4}", without.map_or("   none".into(), |error| format!("{error:.4} ")));
        assert!(with < 0.6 * as_it_is, "{count} files from {first}: {with} against the source's {as_it_is}");
        sums = [sums[0] + without.unwrap_or(as_it_is).ln(), sums[1] + with.ln()];
    }
    assert!(sums[1] < sums[0], "{sums:?}");
}

/// Trials simulated by a model that must sail them all.
fn simulated(model: &Model, law: &Law, trials: &[&Trial]) -> Vec<(String, SquaredError)> {
    let mut ship = Ship::new(model, law).expect("a ready ship");
    ship.set_envelope_speed(1.0);
    let restarted = ReplaySettings { restart_s: Some(RESTART_S), ..ReplaySettings::default() };
    let one = |trial: &&Trial| {
        let run = replay(&ship, trial, &restarted).expect("every channel that the law needs");
        assert_eq!(run.stopped, None, "{}", trial.name);
        (trial.name.clone(), SquaredError::of(trial, &run))
    };
    trials.iter().map(one).collect()
}

/// The search given ten times the time that `trajectory` takes, on the same folds; its fits with trials left out, by which it is
/// weighed, take almost half of that. Run with `--release -- --ignored --nocapture`.
#[test]
#[ignore = "takes minutes"]
fn the_search_given_ten_times_the_time() {
    let Some(folder) = shared::data("esso-osaka") else { return };
    let trials = esso_osaka::trials(&folder, &KINDS);
    let begun = std::time::Instant::now();
    let by_trajectory = left_out(&trials, &compared(Method::Trajectory));
    let trajectory_s = begun.elapsed().as_secs_f64() / 4.0;
    let searched = CmaEs { evaluations: usize::MAX, wall_s: Some(10.0 * trajectory_s / 1.8), ..CmaEs::default() };
    let settings = Settings { cma_es: Some(searched), ..compared(Method::CmaEs) };
    let begun = std::time::Instant::now();
    let by_search = left_out(&trials, &settings);
    println!("trajectory {trajectory_s:.1} s a fold, cma-es {:.1} s", begun.elapsed().as_secs_f64() / 4.0);
    println!("          by variances over all files   by variances of each file");
    println!("kind      trajectory    cma-es         trajectory    cma-es");
    let mut totals = [0.0; 2];
    for kind in KINDS.iter().copied().chain(["all"]) {
        totals = [&by_trajectory, &by_search].map(|errors| over_all(&trials, errors, kind));
        let each = [&by_trajectory, &by_search].map(|errors| over_each(&trials, errors, kind));
        println!("{kind:<9}{:10.4}{:10.4}       {:10.4}{:10.4}", totals[0], totals[1], each[0], each[1]);
    }
    assert!(totals[0] <= totals[1], "{totals:?}");
}

fn of_kind<'e>(errors: &'e [(String, SquaredError)], kind: &'e str) -> impl Iterator<Item = &'e (String, SquaredError)> {
    errors.iter().filter(move |(name, _)| kind == "all" || name.contains(file_prefix(kind)))
}

fn over_all(trials: &[Trial], errors: &[(String, SquaredError)], kind: &str) -> f64 {
    let mut sum = SquaredError::default();
    of_kind(errors, kind).for_each(|(_, error)| sum.add(error));
    standardised_mse(&sum, &standard_deviations(&trials.iter().collect::<Vec<_>>())) / 6.0
}

fn over_each(trials: &[Trial], errors: &[(String, SquaredError)], kind: &str) -> f64 {
    let one = |(name, error): &(String, SquaredError)| {
        let own: Vec<&Trial> = trials.iter().filter(|trial| trial.name == *name).collect();
        standardised_mse(error, &standard_deviations(&own)) / 6.0
    };
    of_kind(errors, kind).map(one).sum::<f64>() / of_kind(errors, kind).count() as f64
}

/// What the names of a kind's files begin with.
fn file_prefix(kind: &str) -> &str {
    if kind == "turning" { "turn_" } else { kind }
}
