//! How long kinds train on all trials of Esso Osaka, and how often they answer in a second.

use std::hint::black_box;
use std::time::Instant as Clock;

use sistership_learned::{LearnedCorrection, train_correction};
use sistership_model::branch::CorrectionMode;
use sistership_model::{Trial, Zoo};
use sistership_simulation::branch::{CorrectionInstant, CorrectionModel};

use crate::measured::{law, nothing, trials};
use crate::osaka::{NAMES, WINDOW_S, learners, training};

/// Answers timed.
const ANSWERS: usize = 200_000;

pub fn run() {
    let Some(trials) = trials() else { return };
    let zoo = Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"));
    let all: Vec<&Trial> = trials.iter().collect();
    let model = nothing(&zoo, &all);
    println!("kind        training, s    weights, kB    answers a second, of all three outputs");
    let named = NAMES.into_iter().zip(learners());
    for (name, learner) in named.flat_map(|(name, all)| all.map(|learner| (name, learner))) {
        let wanted = training(learner, CorrectionMode::Convert, WINDOW_S);
        let begun = Clock::now();
        let (branch, weights) = train_correction(&model, law(&zoo), &all, &wanted)
            .unwrap_or_else(|error| panic!("{error}"));
        let trained_s = begun.elapsed().as_secs_f64();
        let size = weights.to_bytes().map_or(0, |bytes| bytes.len() / 1000);
        let learned =
            LearnedCorrection::from_branch(&branch, weights).expect("a branch of known channels");
        let begun = Clock::now();
        for k in 0..ANSWERS {
            black_box(learned.rate_additions(black_box(&instant(k))));
        }
        let rate = ANSWERS as f64 / begun.elapsed().as_secs_f64();
        println!("{name:<12}{trained_s:<15.2}{size:<15}{rate:.0}");
    }
}

/// Motions within what the trials covered, none like the one before.
fn instant(k: usize) -> CorrectionInstant {
    let phase = k as f64 * 0.618;
    let (sin, cos) = phase.sin_cos();
    CorrectionInstant {
        velocities: [0.35 + 0.1 * sin, 0.04 * cos, 0.03 * (2.0 * phase).sin()],
        delta_rad: 0.3 * (0.7 * phase).sin(),
        n_rps: 10.0,
        accelerations: [0.0; 3],
    }
}
