//! A correction's derivatives and formulas are those of what it adds in a simulation.

use std::collections::HashMap;
use std::sync::Arc;

use crate::ships::{Foundation, learners, training};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha12Rng;
use sistership_learned::attach;
use sistership_model::Model;
use sistership_model::branch::{CorrectionMode, Learner};
use sistership_simulation::branch::{
    CorrectionInstant, CorrectionModel, LAW_RATES, attached_correction,
};

const MODES: [CorrectionMode; 3] =
    [CorrectionMode::Parallel, CorrectionMode::Serial, CorrectionMode::Convert];

/// A correction of the Mariner with its weights.
fn learned(
    foundation: &Foundation,
    learner: &Learner,
    mode: CorrectionMode,
) -> (Model, Arc<dyn CorrectionModel>) {
    let (mut model, weights) = foundation.trained(&training(learner.clone(), mode));
    attach(&mut model, &weights).unwrap();
    let learned = attached_correction(&model).unwrap().unwrap();
    (model, learned)
}

/// u, v, r, delta, n and the law's rates, as one list.
fn listed(at: &CorrectionInstant) -> [f64; 8] {
    let ([u, v, r], [a, b, c]) = (at.velocities, at.accelerations);
    [u, v, r, at.delta_rad, at.n_rps, a, b, c]
}

fn instant([u, v, r, delta_rad, n_rps, a, b, c]: [f64; 8]) -> CorrectionInstant {
    CorrectionInstant { velocities: [u, v, r], delta_rad, n_rps, accelerations: [a, b, c] }
}

/// Motions within the domain and as far beyond as the correction reaches.
fn instants(model: &Model, count: usize) -> Vec<CorrectionInstant> {
    let mut rng = ChaCha12Rng::seed_from_u64(3);
    let ranges = &model.branch.as_ref().unwrap().domain.ranges;
    let mut one = |name: &str| {
        let [low, high] = ranges.get(name).copied().unwrap_or([0.0; 2]);
        let (centre, half) = (0.5 * (low + high), 0.5 * (high - low));
        centre + 0.8 * half * rng.random_range(-1.0..1.0)
    };
    let motions: Vec<[f64; 5]> =
        (0..count).map(|_| ["u", "v", "r", "delta", "n"].map(&mut one)).collect();
    let rate = |scale: f64, k: usize| scale * (k as f64).sin();
    let of = |(k, [u, v, r, delta, n]): (usize, &[f64; 5])| {
        instant([*u, *v, *r, *delta, *n, rate(0.02, k), rate(0.03, 3 * k), rate(3e-4, 7 * k)])
    };
    motions.iter().enumerate().map(of).collect()
}

/// Derivatives of the rates added, by what they are told from.
fn gradient(learned: &dyn CorrectionModel, at: &CorrectionInstant) -> [[f64; 8]; 3] {
    let all = learned.addition_gradient(at);
    std::array::from_fn(|row| {
        let ([u, v, r], [a, b, c]) = (all.by_velocity[row], all.by_acceleration[row]);
        [u, v, r, all.by_delta[row], all.by_n[row], a, b, c]
    })
}

/// Central differences over so much of each.
fn differences(
    learned: &dyn CorrectionModel,
    at: &CorrectionInstant,
    steps: [f64; 8],
) -> [[f64; 8]; 3] {
    let mut slopes = [[0.0; 8]; 3];
    for (place, step) in steps.into_iter().enumerate().filter(|(_, step)| *step > 0.0) {
        let [above, below] = [step, -step].map(|moved| {
            let mut all = listed(at);
            all[place] += moved;
            learned.rate_additions(&instant(all))
        });
        (0..3).for_each(|row| slopes[row][place] = (above[row] - below[row]) / (2.0 * step));
    }
    slopes
}

#[test]
fn smooth_corrections_have_the_derivatives_of_what_they_add() {
    let foundation = Foundation::of("mariner");
    let [.., kernels, network] = learners();
    for (learner, mode) in [kernels, network].iter().flat_map(|l| MODES.map(|mode| (l, mode))) {
        let (model, learned) = learned(&foundation, learner, mode);
        let scales = [1.0, 0.5, 0.005, 0.2, 1.0, 0.02, 0.03, 3e-4];
        let (mut seen, mut faded) = (0, 0);
        for at in instants(&model, 60) {
            let found = gradient(&*learned, &at);
            // A kink of the share or of the bounds between the steps shows in their difference.
            let fine = differences(&*learned, &at, scales.map(|scale| 1e-6 * scale));
            let coarse = differences(&*learned, &at, scales.map(|scale| 3e-5 * scale));
            let size = |row: usize| {
                let parts = (0..8).map(|k| (found[row][k] * scales[k]).abs());
                parts.fold(1e-9, f64::max)
            };
            for (row, place) in (0..3).flat_map(|row| (0..8).map(move |place| (row, place))) {
                let close =
                    |a: f64, b: f64, by: f64| (a - b).abs() * scales[place] < by * size(row);
                if close(fine[row][place], coarse[row][place], 1e-3) {
                    seen += 1;
                    let (own, other) = (found[row][place], fine[row][place]);
                    assert!(
                        close(own, other, 2e-3),
                        "{learner:?} {mode:?} {row} {place}: {own} {other}"
                    );
                }
            }
            faded += usize::from((0.01..0.99).contains(&learned.active_share(&at)));
        }
        assert!(seen > 1200 && faded > 3, "{seen} derivatives, {faded} where it fades");
    }
}

#[test]
fn trees_have_the_secants_over_half_a_deviation_to_either_side() {
    let foundation = Foundation::of("mariner");
    let [forest, boosted, ..] = learners();
    for learner in [forest, boosted] {
        let (model, learned) = learned(&foundation, &learner, CorrectionMode::Parallel);
        let inputs = &model.branch.as_ref().unwrap().outputs[2].inputs;
        let mut seen = 0;
        for at in instants(&model, 60) {
            for (place, input) in inputs.iter().enumerate() {
                let mut steps = [0.0; 8];
                steps[place] = 0.5 * input.scale;
                let whole = [-1.0, 0.0, 1.0].iter().all(|side| {
                    let mut all = listed(&at);
                    all[place] += side * steps[place];
                    learned.active_share(&instant(all)) == 1.0
                });
                if whole {
                    seen += 1;
                    let secant = differences(&*learned, &at, steps)[2][place];
                    let found = gradient(&*learned, &at)[2][place];
                    assert!(
                        (found - secant).abs() < 1e-9 * secant.abs().max(1e-9),
                        "{found} {secant}"
                    );
                }
            }
        }
        assert!(seen > 20, "{seen}");
    }
}

#[test]
fn formulas_say_what_is_added() {
    let foundation = Foundation::of("mariner");
    for (learner, mode) in learners().iter().flat_map(|l| MODES.map(|mode| (l, mode))) {
        let (model, learned) = learned(&foundation, learner, mode);
        let formulas = learned.addition_formulas();
        for at in instants(&model, 20) {
            let names = ["u", "v", "r", "delta", "n"].into_iter().chain(LAW_RATES);
            let mut known: HashMap<String, f64> =
                names.map(str::to_owned).zip(listed(&at)).collect();
            for (name, expr) in &formulas.values {
                let value = expr.value(&|name| known.get(name).copied()).unwrap();
                known.insert(name.clone(), value);
            }
            for (expr, added) in formulas.added.iter().zip(learned.rate_additions(&at)) {
                let value =
                    expr.as_ref().map_or(0.0, |e| e.value(&|n| known.get(n).copied()).unwrap());
                assert!((value - added).abs() < 1e-12 * added.abs().max(1e-3), "{value} {added}");
            }
        }
    }
}
