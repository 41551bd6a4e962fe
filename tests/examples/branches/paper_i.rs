//! Paper I (Kanazawa 2023, sec. 3.1): the track of 30 s under orders to come, drawn by a foundation
//! and corrected once by an LSTM that is told the foundation's end; against the foundation and an
//! LSTM without one, which is told the orders instead.

use sistership_learned::horizon::{
    HorizonTraining, OneShotSettings, OrderEncoding, TrackExample, TrackPredictor, train_predictor,
};
use sistership_learned::recurrent::RecurrentCell;
use sistership_model::{Trial, Zoo};
use sistership_simulation::Ship;

use crate::vessel::foundation::{Shift, ship};
use crate::vessel::hull::{Hull, VESSEL};
use crate::vessel::scenarios;

/// s, at one sample a second.
const HORIZON: usize = 30;
/// Samples of which the LSTM is told: three of the longest waves that are met.
const MEMORY: usize = 12;
/// How far the foundation's damping is off at most: the moderate ones of sec. 4.1.2.
const LOW_FIDELITY: Shift = Shift { damping: 0.6, inertia: 0.0, seed: 1 };

/// How much of it.
#[derive(Debug, Clone, Copy)]
pub struct Size {
    /// Scenarios in all, half at Beaufort 3.
    pub scenarios: usize,
    pub epochs: usize,
    /// Samples from an example to the next.
    pub hop: usize,
}

impl Size {
    pub const PAPER: Self = Self { scenarios: 200, epochs: 60, hop: 3 };
}

/// Mean distance and ninth tenth, m, at each second ahead.
#[derive(Debug, Clone)]
pub struct Misses {
    pub mean_m: Vec<f64>,
    pub tenth_m: Vec<f64>,
}

impl Misses {
    fn of(examples: &[TrackExample], added: impl Fn(&TrackExample) -> Vec<f64>) -> Self {
        let all: Vec<Vec<f64>> =
            examples.iter().map(|one| one.position_errors(&added(one))).collect();
        let column = |k: usize| {
            let mut column: Vec<f64> = all.iter().map(|misses| misses[k]).collect();
            column.sort_unstable_by(f64::total_cmp);
            column
        };
        let columns: Vec<Vec<f64>> = (0..HORIZON).map(column).collect();
        let mean = |column: &Vec<f64>| column.iter().sum::<f64>() / column.len() as f64;
        let tenth = |column: &Vec<f64>| column[9 * column.len() / 10];
        Self {
            mean_m: columns.iter().map(mean).collect(),
            tenth_m: columns.iter().map(tenth).collect(),
        }
    }

    /// Over the whole horizon.
    pub fn mean(&self) -> f64 {
        self.mean_m.iter().sum::<f64>() / self.mean_m.len() as f64
    }
}

/// Foundation, data alone, both.
pub struct Outcome {
    pub force: u8,
    pub misses: [Misses; 3],
}

pub fn training(epochs: usize) -> HorizonTraining {
    HorizonTraining {
        cell: RecurrentCell::Lstm,
        width: 24,
        epochs,
        patience: 10,
        batch: 32,
        rate: 2e-3,
        seed: 2021,
    }
}

fn one_shot(told: OrderEncoding) -> OneShotSettings {
    OneShotSettings { steps: HORIZON, told, memory: MEMORY }
}

fn examples(
    how: OneShotSettings,
    ship: Option<&Ship>,
    trials: &[Trial],
    hop: usize,
) -> Vec<TrackExample> {
    let of = |trial: &Trial| {
        how.trial_examples(ship, trial, hop).unwrap_or_else(|error| panic!("{error}"))
    };
    trials.iter().flat_map(of).collect()
}

/// Scenarios of one force: of ten, five to train on, two for validation, three to be judged on, as
/// the paper's 30 %.
fn parts(hull: &Hull, force: u8, count: usize) -> [Vec<Trial>; 3] {
    let all =
        scenarios::all(count, u64::from(force), |seed| scenarios::commands(hull, force, seed));
    let mut parts: [Vec<Trial>; 3] = Default::default();
    for (k, trial) in all.into_iter().enumerate() {
        parts[[0, 0, 0, 0, 0, 1, 1, 2, 2, 2][k % 10]].push(trial);
    }
    parts
}

pub fn outcomes(size: Size) -> Vec<Outcome> {
    let zoo = Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"));
    let hull = Hull::new(&zoo);
    println!("left by the hull's fit, of surge, sway and yaw: {:.3?}", hull.left);
    let foundation = ship(&zoo, VESSEL, LOW_FIDELITY);
    let by_force = [3, 4].map(|force| parts(&hull, force, size.scenarios / 2));
    let learned = |how: OneShotSettings, ship: Option<&Ship>| -> TrackPredictor {
        let of = |part: usize| -> Vec<TrackExample> {
            by_force.iter().flat_map(|all| examples(how, ship, &all[part], size.hop)).collect()
        };
        let trained = train_predictor(&of(0), &of(1), &training(size.epochs), None);
        trained.unwrap_or_else(|error| panic!("{error}"))
    };
    let (alone, both) =
        (one_shot(OrderEncoding::Orders { parts: 6 }), one_shot(OrderEncoding::End));
    let (data, hybrid) = (learned(alone, None), learned(both, Some(&foundation)));
    println!(
        "epochs and least validation: data {:?}, both {:?}",
        data.training_summary(),
        hybrid.training_summary()
    );
    let judged = |(force, all): (u8, &[Vec<Trial>; 3])| {
        let with = examples(both, Some(&foundation), &all[2], 1);
        let without = examples(alone, None, &all[2], 1);
        let nothing = vec![0.0; 2 * HORIZON];
        Outcome {
            force,
            misses: [
                Misses::of(&with, |_| nothing.clone()),
                Misses::of(&without, |one| data.predict_correction(&one.inputs)),
                Misses::of(&with, |one| hybrid.predict_correction(&one.inputs)),
            ],
        }
    };
    [3, 4].into_iter().zip(&by_force).map(judged).collect()
}

pub fn run(size: Size) {
    println!("distance from where it went, m: mean (ninth tenth)");
    println!("Beaufort  ahead, s   foundation        data alone        both");
    for Outcome { force, misses } in outcomes(size) {
        for k in [5, 10, 15, 20, 25, 30] {
            let cell = |m: &Misses| format!("{:.2} ({:.2})", m.mean_m[k - 1], m.tenth_m[k - 1]);
            let row = misses.each_ref().map(|m| format!("{:<18}", cell(m)));
            println!("{force:<10}{k:<11}{}", row.concat());
        }
        let [foundation, data, both] = misses.each_ref().map(Misses::mean);
        println!(
            "{force}, all 30 s: {foundation:.2} {data:.2} {both:.2}; both by the foundation {:.2}, \
             by data alone {:.2}",
            both / foundation,
            both / data
        );
    }
}
