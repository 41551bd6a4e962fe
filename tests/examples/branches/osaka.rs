//! Esso Osaka, cross-validated by file: the refined law, the refined law with a branch, and
//! branches without it. What a branch is trained with is chosen within the trials it may see, so
//! that no figure printed has been looked at for a choice.

use rayon::prelude::*;
use sistership_branches::{Row, Training, importance, rows, ship, train};
use sistership_dynamics::Ship;
use sistership_dynamics::error::SquaredError;
use sistership_dynamics::recorded::{ReplaySettings, replay};
use sistership_model::branch::{BranchMode, Learner, Signal};
use sistership_model::coefficient::Axis;
use sistership_model::{Law, Model, Trial, Zoo};

use crate::measured::{fold_of, law, nothing, refined, trials};
use crate::score::{KINDS, RESTART_S, over_all};

/// Errors by trial.
pub type Errors = Vec<(String, SquaredError)>;

/// Windows tried, s: about an eighth and a half of the time L/U in which she sails her length at
/// 0.4 m/s.
const WINDOWS_S: [f64; 2] = [1.0, 4.0];

/// A learner of each kind.
pub const NAMES: [&str; 4] = ["forest", "boosted", "kernels", "perceptron"];

pub fn learners() -> [Learner; 4] {
    [
        Learner::RandomForest { trees: 50, tried: 2, leaf: 20, depth: 12 },
        Learner::BoostedTrees { trees: 100, leaf: 40, depth: 4, rate: 0.05, sampled: 0.5 },
        Learner::KernelRidge { centres: 200, length: 3.0, ridge: 1.0 },
        Learner::Perceptron {
            hidden: vec![16, 16],
            epochs: 30,
            batch: 64,
            rate: 0.005,
            decay: 0.01,
        },
    ]
}

pub fn training(learner: Learner, mode: BranchMode, window_s: f64) -> Training {
    let signals = vec![Signal::U, Signal::V, Signal::R, Signal::Delta, Signal::N];
    let inputs = [Axis::X, Axis::Y, Axis::N].map(|axis| (axis, signals.clone())).to_vec();
    Training { mode, inputs, learner, seed: 1, window_s, hop_s: 0.5, fade: 1.0 }
}

/// Trials simulated by a ship, which must sail them all.
fn simulated(mut ship: Ship, trials: &[&Trial]) -> Errors {
    ship.set_envelope_speed(1.0);
    let restarted = ReplaySettings { restart_s: Some(RESTART_S), ..ReplaySettings::default() };
    let one = |trial: &&Trial| {
        let run = replay(&ship, trial, &restarted).expect("every channel that the law needs");
        assert_eq!(run.stopped, None, "{}", trial.name);
        (trial.name.clone(), SquaredError::of(trial, &run))
    };
    trials.par_iter().map(one).collect()
}

/// A foundation with a branch trained on some trials, simulated on others.
fn with_branch(
    model: &Model,
    law: &Law,
    inside: &[&Trial],
    outside: &[&Trial],
    training: &Training,
) -> Errors {
    let (branch, weights) =
        train(model, law, inside, training).unwrap_or_else(|error| panic!("{error}"));
    let model = Model { branch: Some(branch), ..model.clone() };
    let bytes = weights.bytes().unwrap_or_else(|error| panic!("{error}"));
    simulated(ship(&model, law, &bytes).unwrap_or_else(|error| panic!("{error}")), outside)
}

fn split<'t>(trials: &[&'t Trial], folds: usize, fold: usize) -> (Vec<&'t Trial>, Vec<&'t Trial>) {
    let (outside, inside): (Vec<_>, Vec<_>) =
        trials.iter().enumerate().partition(|(k, trial)| fold_of(trial, *k, folds) == fold);
    let bare = |some: Vec<(usize, &&'t Trial)>| some.into_iter().map(|(_, trial)| *trial).collect();
    (bare(inside), bare(outside))
}

/// The error of a training within the trials that it may see, three parts each left out once; of
/// the foundation alone where there is none. The foundation has seen all of them, so that it is
/// favoured here.
fn within(model: &Model, law: &Law, inside: &[&Trial], training: Option<&Training>) -> f64 {
    let all: Vec<Trial> = inside.iter().map(|trial| (*trial).clone()).collect();
    let one = |fold: usize| {
        let (seen, unseen) = split(inside, 3, fold);
        match training {
            Some(training) => with_branch(model, law, &seen, &unseen, training),
            None => simulated(Ship::new(model, law).unwrap_or_else(|e| panic!("{e}")), &unseen),
        }
    };
    over_all(&all, &(0..3).flat_map(one).collect::<Errors>(), "all")
}

/// What a fold gives: of the law alone, of each kind beside it, of the kind chosen, and of each
/// kind without a law.
struct Fold {
    alone: Errors,
    beside: [Errors; 4],
    chosen: Errors,
    data: [Errors; 4],
}

fn fold(zoo: &Zoo, all: &[&Trial], number: usize) -> Fold {
    let (inside, outside) = split(all, 4, number);
    let (law, model, bare) = (law(zoo), refined(zoo, &inside), nothing(zoo, &inside));
    let alone = simulated(Ship::new(&model, law).unwrap_or_else(|e| panic!("{e}")), &outside);
    let before = within(&model, law, &inside, None);
    let mut least = (before, None);
    let beside = learners().map(|learner| {
        let wanted = WINDOWS_S.map(|w| training(learner.clone(), BranchMode::Parallel, w));
        let errors = wanted.each_ref().map(|w| within(&model, law, &inside, Some(w)));
        let best = usize::from(errors[1] < errors[0]);
        println!("fold {number} {learner:?}: within {errors:.4?}, without {before:.4}");
        let found = with_branch(&model, law, &inside, &outside, &wanted[best]);
        if errors[best] < least.0 {
            least = (errors[best], Some(found.clone()));
        }
        found
    });
    let data = learners().map(|learner| {
        let wanted = training(learner, BranchMode::Convert, WINDOWS_S[0]);
        with_branch(&bare, law, &inside, &outside, &wanted)
    });
    let chosen = least.1.unwrap_or_else(|| alone.clone());
    Fold { alone, beside, chosen, data }
}

/// On what the refined law's remainder depends, by a forest trained on three files in four.
fn tell_importance(zoo: &Zoo, all: &[&Trial]) {
    let (inside, outside) = split(all, 4, 1);
    let (law, model, [forest, ..]) = (law(zoo), refined(zoo, &inside), learners());
    let wanted = training(forest, BranchMode::Parallel, WINDOWS_S[1]);
    let (branch, weights) =
        train(&model, law, &inside, &wanted).unwrap_or_else(|error| panic!("{error}"));
    let alone = Ship::new(&model, law).unwrap_or_else(|error| panic!("{error}"));
    let of = |trial: &&Trial| rows(&alone, trial, wanted.window_s, wanted.hop_s);
    let unseen: Vec<Row> = outside.iter().flat_map(|trial| of(trial).unwrap_or_default()).collect();
    println!("rise of the squared error of unseen files where an input is shuffled, by variance");
    for told in importance(&branch, &weights, &unseen, 1) {
        println!("  {} {:<6} {:+.3}", told.axis, format!("{:?}", told.signal), told.rise);
    }
}

pub fn run() {
    let Some(trials) = trials() else { return };
    let zoo = Zoo::embedded().unwrap_or_else(|error| panic!("{error}"));
    let all: Vec<&Trial> = trials.iter().collect();
    let folds: Vec<Fold> = (0..4).map(|number| fold(&zoo, &all, number)).collect();
    let joined = |of: &dyn Fn(&Fold) -> Errors| folds.iter().flat_map(of).collect::<Errors>();
    println!("standardised mean squared error, mean over u, v, r, psi, x, y; files left out");
    println!("           refined law, with a branch beside it                 data alone");
    print!("kind       alone      ");
    NAMES.iter().for_each(|name| print!("{name:<11}"));
    print!("chosen     ");
    NAMES.iter().for_each(|name| print!("{name:<11}"));
    println!();
    let mut columns = vec![joined(&|fold| fold.alone.clone())];
    columns.extend((0..4).map(|k| joined(&|fold| fold.beside[k].clone())));
    columns.push(joined(&|fold| fold.chosen.clone()));
    columns.extend((0..4).map(|k| joined(&|fold| fold.data[k].clone())));
    for kind in KINDS.iter().copied().chain(["all"]) {
        let row = columns.iter().map(|errors| format!("{:<11.4}", over_all(&trials, errors, kind)));
        println!("{kind:<11}{}", row.collect::<String>());
    }
    tell_importance(&zoo, &all);
    let of = |place: usize| over_all(&trials, &columns[place], "all");
    println!("chosen by the law alone: {:.3} (wanted: at most 0.9)", of(5) / of(0));
}
