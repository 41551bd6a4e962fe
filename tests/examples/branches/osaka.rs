//! Esso Osaka, cross-validated by file: the refined law, the refined law with a branch, and
//! branches without it. What a branch is trained with is chosen within the trials it may see, so
//! that no figure printed has been looked at for a choice.

use rayon::prelude::*;
use sistership_learned::{
    CorrectionTraining, WindowRow, corrected_ship, permutation_importance, train_correction,
    window_rows,
};
use sistership_model::branch::{CorrectionMode, Learner, Signal};
use sistership_model::coefficient::Axis;
use sistership_model::{Law, Model, Trial, Zoo};
use sistership_simulation::Ship;
use sistership_simulation::error::SquaredError;
use sistership_simulation::recorded::{ReplaySettings, replay_trial};

use crate::measured::{fold_of, law, nothing, refined, trials};
use crate::score::{KINDS, RESTART_S, over_all};

/// Errors by trial.
pub type Errors = Vec<(String, SquaredError)>;

/// The window unless another is asked for: half of the time L/U in which it sails its length at
/// 0.4 m/s, s.
pub const WINDOW_S: f64 = 4.0;

pub const NAMES: [&str; 4] = ["forest", "boosted", "kernels", "perceptron"];

/// Learners of each kind, the freest first and the most restrained last.
pub fn learners() -> [[Learner; 3]; 4] {
    let forest = |leaf, depth| Learner::RandomForest { trees: 50, tried: 2, leaf, depth };
    let boosted =
        |trees, leaf, depth| Learner::BoostedTrees { trees, leaf, depth, rate: 0.05, sampled: 0.5 };
    let kernels = |ridge| Learner::KernelRidge { centres: 200, length: 3.0, ridge };
    let network = |hidden: &[usize], epochs, decay| Learner::Perceptron {
        hidden: hidden.to_vec(),
        epochs,
        batch: 64,
        rate: 0.005,
        decay,
    };
    [
        [forest(20, 12), forest(200, 8), forest(1000, 5)],
        [boosted(100, 40, 4), boosted(50, 400, 2), boosted(20, 1000, 2)],
        [kernels(1.0), kernels(100.0), kernels(10_000.0)],
        [network(&[16, 16], 30, 0.01), network(&[8], 20, 0.3), network(&[4], 10, 1.0)],
    ]
}

pub fn training(learner: Learner, mode: CorrectionMode, window_s: f64) -> CorrectionTraining {
    let signals = vec![Signal::U, Signal::V, Signal::R, Signal::Delta, Signal::N];
    let inputs = [Axis::X, Axis::Y, Axis::N].map(|axis| (axis, signals.clone())).to_vec();
    CorrectionTraining { mode, inputs, learner, seed: 1, window_s, hop_s: 0.5, fade: 1.0 }
}

/// Trials simulated by a ship, which must sail them all.
fn simulated(mut ship: Ship, trials: &[&Trial]) -> Errors {
    ship.set_envelope_speed(1.0);
    let restarted = ReplaySettings { restart_s: Some(RESTART_S), ..ReplaySettings::default() };
    let one = |trial: &&Trial| {
        let run = replay_trial(&ship, trial, &restarted).expect("every channel that the law needs");
        assert_eq!(run.stopped, None, "{}", trial.name);
        (trial.name.clone(), SquaredError::from_trial(trial, &run))
    };
    trials.par_iter().map(one).collect()
}

/// A foundation with a branch trained on some trials, simulated on others.
fn with_branch(
    model: &Model,
    law: &Law,
    inside: &[&Trial],
    outside: &[&Trial],
    training: &CorrectionTraining,
) -> Errors {
    let (branch, weights) =
        train_correction(model, law, inside, training).unwrap_or_else(|error| panic!("{error}"));
    let model = Model { branch: Some(branch), ..model.clone() };
    let bytes = weights.to_bytes().unwrap_or_else(|error| panic!("{error}"));
    simulated(
        corrected_ship(&model, law, &bytes).unwrap_or_else(|error| panic!("{error}")),
        outside,
    )
}

fn split<'t>(trials: &[&'t Trial], folds: usize, fold: usize) -> (Vec<&'t Trial>, Vec<&'t Trial>) {
    let (outside, inside): (Vec<_>, Vec<_>) =
        trials.iter().enumerate().partition(|(k, trial)| fold_of(trial, *k, folds) == fold);
    let bare = |some: Vec<(usize, &&'t Trial)>| some.into_iter().map(|(_, trial)| *trial).collect();
    (bare(inside), bare(outside))
}

/// Errors within the trials that a fold may see, three parts each left out once, by the law
/// refined on the rest: of the law alone, and with each learner beside it.
fn within(zoo: &Zoo, inside: &[&Trial], window_s: f64) -> (f64, [[f64; 3]; 4]) {
    let all: Vec<Trial> = inside.iter().map(|trial| (*trial).clone()).collect();
    let law = law(zoo);
    let mut alone = Errors::new();
    let mut beside: [[Errors; 3]; 4] = Default::default();
    for part in 0..3 {
        let (seen, unseen) = split(inside, 3, part);
        let model = refined(zoo, &seen);
        let bare = Ship::new(&model, law).unwrap_or_else(|error| panic!("{error}"));
        alone.extend(simulated(bare, &unseen));
        for (learner, errors) in learners().into_iter().flatten().zip(beside.iter_mut().flatten()) {
            let wanted = training(learner, CorrectionMode::Parallel, window_s);
            errors.extend(with_branch(&model, law, &seen, &unseen, &wanted));
        }
    }
    let of = |errors: &Errors| over_all(&all, errors, "all");
    (of(&alone), beside.each_ref().map(|kind| kind.each_ref().map(of)))
}

/// What a fold gives: of the law alone, of each kind beside it, of the kind chosen, and of each
/// kind without a law.
struct Fold {
    alone: Errors,
    beside: [Errors; 4],
    chosen: Errors,
    data: [Errors; 4],
}

fn fold(zoo: &Zoo, all: &[&Trial], number: usize, window_s: f64) -> Fold {
    let (inside, outside) = split(all, 4, number);
    let (law, model, bare) = (law(zoo), refined(zoo, &inside), nothing(zoo, &inside));
    let alone = simulated(Ship::new(&model, law).unwrap_or_else(|e| panic!("{e}")), &outside);
    let (without, with) = within(zoo, &inside, window_s);
    println!("fold {number}: within its trials {without:.4} by the law alone; {with:.4?}");
    let best = with.map(|kind| least(&kind));
    let beside = std::array::from_fn(|kind| {
        let wanted =
            training(learners()[kind][best[kind]].clone(), CorrectionMode::Parallel, window_s);
        with_branch(&model, law, &inside, &outside, &wanted)
    });
    let data = learners().map(|[free, ..]| {
        with_branch(
            &bare,
            law,
            &inside,
            &outside,
            &training(free, CorrectionMode::Convert, window_s),
        )
    });
    let kind = least(&std::array::from_fn::<f64, 4, _>(|kind| with[kind][best[kind]]));
    let wins = with[kind][best[kind]] < without;
    let beside: [Errors; 4] = beside;
    let chosen = if wins { beside[kind].clone() } else { alone.clone() };
    println!("  taken: {}", if wins { NAMES[kind] } else { "no branch" });
    Fold { alone, beside, chosen, data }
}

fn least(errors: &[f64]) -> usize {
    (0..errors.len()).min_by(|a, b| errors[*a].total_cmp(&errors[*b])).unwrap_or_default()
}

/// On what the refined law's remainder depends, by a forest trained on three files in four.
fn tell_importance(zoo: &Zoo, all: &[&Trial]) {
    let (inside, outside) = split(all, 4, 1);
    let (law, model, [[forest, ..], ..]) = (law(zoo), refined(zoo, &inside), learners());
    let wanted = training(forest, CorrectionMode::Parallel, WINDOW_S);
    let (branch, weights) =
        train_correction(&model, law, &inside, &wanted).unwrap_or_else(|error| panic!("{error}"));
    let alone = Ship::new(&model, law).unwrap_or_else(|error| panic!("{error}"));
    let of = |trial: &&Trial| window_rows(&alone, trial, wanted.window_s, wanted.hop_s);
    let unseen: Vec<WindowRow> =
        outside.iter().flat_map(|trial| of(trial).unwrap_or_default()).collect();
    println!("rise of the squared error of unseen files where an input is shuffled, by variance");
    for told in permutation_importance(&branch, &weights, &unseen, 1) {
        println!("  {} {:<6} {:+.3}", told.axis, format!("{:?}", told.signal), told.rise);
    }
}

pub fn run(window_s: f64) {
    let Some(trials) = trials() else { return };
    let zoo = Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"));
    let all: Vec<&Trial> = trials.iter().collect();
    let folds: Vec<Fold> = (0..4).map(|number| fold(&zoo, &all, number, window_s)).collect();
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
