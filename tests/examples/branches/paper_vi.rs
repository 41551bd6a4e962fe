//! Paper VI (Kanazawa 2023, sec. 3.4): deviations of heave, pitch and roll from a wave radar by
//! closed-form responses, by those with a factor for each motion, and with a factor that is learned
//! from samples of which the common ones are thinned out.

use sistership_learned::seakeeping::{WaveHull, balance_samples, fit_factor};

use crate::vessel::seaway::{Sample, assumed, samples};

/// Samples and folds, in their order (sec. 3.4.2), and the quantile above which they are rare.
const SAMPLES: usize = 104;
const FOLDS: usize = 6;
const RARE: f64 = 0.9;

/// Root mean squares of what is predicted amiss, m or rad: responses alone, with the factor, with
/// the factor of thinned samples; over all samples, and over the rare ones.
#[derive(Debug, Clone, Copy, Default)]
pub struct Errors {
    pub all: [f64; 3],
    pub rare: [f64; 3],
}

/// By motion: heave, pitch, roll.
pub fn errors(draw: u64) -> [Errors; 3] {
    let (hull, samples) = (assumed(), samples(SAMPLES, draw));
    [0, 1, 2].map(|axis| of_motion(&hull, &samples, axis, draw))
}

fn of_motion(hull: &WaveHull, samples: &[Sample], axis: usize, draw: u64) -> Errors {
    let motion = WaveHull::MOTIONS[axis];
    let measured: Vec<f64> = samples.iter().map(|sample| sample.moved[axis]).collect();
    let drawn: Vec<f64> =
        samples.iter().map(|sample| sample.radar.motion_deviation(hull, motion)).collect();
    let mut predicted = vec![[0.0; 3]; samples.len()];
    for fold in 0..FOLDS {
        let of = |k: usize| FOLDS * k / samples.len() == fold;
        let seen: Vec<usize> = (0..samples.len()).filter(|k| !of(*k)).collect();
        let pick = |all: &[f64], kept: &[usize]| kept.iter().map(|k| all[*k]).collect::<Vec<f64>>();
        let learned = |kept: &[usize]| {
            fit_factor(&pick(&drawn, kept), &pick(&measured, kept)).expect("seas that move it")
        };
        let balanced = balance_samples(&pick(&measured, &seen), RARE, 100 * draw + fold as u64);
        let balanced: Vec<usize> = balanced.into_iter().map(|place| seen[place]).collect();
        let factors = [1.0, learned(&seen), learned(&balanced)];
        (0..samples.len())
            .filter(|k| of(*k))
            .for_each(|k| predicted[k] = factors.map(|factor| factor * drawn[k]));
    }
    let mut sorted = measured.clone();
    sorted.sort_unstable_by(f64::total_cmp);
    let limit = sorted[(RARE * samples.len() as f64) as usize];
    let error = |least: f64| {
        [0, 1, 2].map(|way| {
            let own: Vec<usize> = (0..samples.len()).filter(|k| measured[*k] >= least).collect();
            let squares: f64 =
                own.iter().map(|k| (predicted[*k][way] - measured[*k]).powi(2)).sum();
            (squares / own.len() as f64).sqrt()
        })
    };
    Errors { all: error(0.0), rare: error(limit) }
}

/// Draws in which the factor of thinned samples is the better one on rare roll.
pub fn run(draws: u64) {
    println!("{:.3?}", assumed());
    println!("means over {draws} draws: responses, with the factor, with that of thinned samples");
    let all: Vec<[Errors; 3]> = (0..draws).map(errors).collect();
    for (axis, name) in ["heave, cm", "pitch, deg", "roll, deg"].into_iter().enumerate() {
        let unit = if axis == 0 { 100.0 } else { 1.0_f64.to_degrees() };
        let mean = |of: &dyn Fn(&Errors) -> [f64; 3]| {
            [0, 1, 2].map(|way| {
                let sum: f64 = all.iter().map(|draw| of(&draw[axis])[way]).sum();
                unit * sum / draws as f64
            })
        };
        let better = all.iter().filter(|draw| draw[axis].rare[2] < draw[axis].rare[1]).count();
        let (every, rare) = (mean(&|errors| errors.all), mean(&|errors| errors.rare));
        println!("{name:<11} all {every:.2?}, rare {rare:.2?}, thinned better on rare: {better}");
    }
}
