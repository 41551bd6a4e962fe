//! Paper III (Kanazawa 2023, sec. 3.2): docking, perceptrons on what the foundation's accelerations
//! lack, asked at every step.

use sistership_learned::horizon::{OneShotSettings, OrderEncoding, TrackExample};
use sistership_learned::{CorrectionTraining, corrected_ship as joined, train_correction};
use sistership_model::branch::{CorrectionMode, Learner, Signal};
use sistership_model::coefficient::Axis;
use sistership_model::{Model, Trial, Zoo};
use sistership_simulation::Ship;

use crate::vessel::foundation::{Shift, model, ship};
use crate::vessel::hull::{Hull, VESSEL};
use crate::vessel::scenarios;

/// s.
const HORIZON: usize = 60;
const LOW_FIDELITY: Shift = Shift { damping: 0.6, inertia: 0.0, seed: 1 };

/// Trials to train on and to be judged on; the paper has 56 with 14 for validation, and 18.
#[derive(Debug, Clone, Copy)]
pub struct Size {
    pub trained: usize,
    pub judged: usize,
    pub epochs: usize,
}

impl Size {
    pub const PAPER: Self = Self { trained: 56, judged: 18, epochs: 20 };
}

/// Distances at 15, 30 and 60 s, m, means and ninth tenths.
pub type Row = [(f64, f64); 3];

pub fn training(epochs: usize) -> CorrectionTraining {
    use Signal::{Delta, N, R, U, V};
    CorrectionTraining {
        mode: CorrectionMode::Parallel,
        inputs: [Axis::X, Axis::Y, Axis::N].map(|axis| (axis, vec![U, V, R, N, Delta])).to_vec(),
        learner: Learner::Perceptron {
            hidden: vec![16, 16],
            epochs,
            batch: 32,
            rate: 3e-3,
            decay: 1e-3,
        },
        seed: 2022,
        // The motion of wave frequency drowns what changes in one second.
        window_s: 4.0,
        hop_s: 1.0,
        fade: 1.0,
    }
}

fn both(zoo: &Zoo, model: &Model, trials: &[Trial], training: &CorrectionTraining) -> Ship {
    let law = zoo.law(&model.law).expect("its law");
    let trials: Vec<&Trial> = trials.iter().collect();
    let trained = train_correction(model, law, &trials, training);
    let (branch, weights) = trained.unwrap_or_else(|error| panic!("{error}"));
    let model = Model { branch: Some(branch), ..model.clone() };
    let bytes = weights.to_bytes().unwrap_or_else(|error| panic!("{error}"));
    joined(&model, law, &bytes).unwrap_or_else(|error| panic!("{error}"))
}

fn row(ship: &Ship, trials: &[Trial]) -> Row {
    let how = OneShotSettings { steps: HORIZON, told: OrderEncoding::Nothing, memory: 1 };
    let of = |trial: &Trial| {
        how.trial_examples(Some(ship), trial, 5).unwrap_or_else(|error| panic!("{error}"))
    };
    let nothing = vec![0.0; 2 * HORIZON];
    let all: Vec<Vec<f64>> =
        trials.iter().flat_map(of).map(|one: TrackExample| one.position_errors(&nothing)).collect();
    [15, 30, 60].map(|seconds| {
        let mut column: Vec<f64> = all.iter().map(|misses| misses[seconds - 1]).collect();
        column.sort_unstable_by(f64::total_cmp);
        (column.iter().sum::<f64>() / column.len() as f64, column[9 * column.len() / 10])
    })
}

/// Foundation and both.
pub fn outcomes(size: Size) -> [Row; 2] {
    let zoo = Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"));
    let hull = Hull::new(&zoo);
    let sailed = |count, seed| scenarios::all(count, seed, |seed| scenarios::docking(&hull, seed));
    let (seen, judged) = (sailed(size.trained, 30), sailed(size.judged, 31));
    let foundation = ship(&zoo, VESSEL, LOW_FIDELITY);
    let model = model(&zoo, VESSEL, LOW_FIDELITY);
    let both = both(&zoo, &model, &seen, &training(size.epochs));
    [row(&foundation, &judged), row(&both, &judged)]
}

pub fn run(size: Size) {
    let [foundation, both] = outcomes(size);
    println!("docking, distance, m: mean (ninth tenth)   15 s   30 s   60 s");
    let cells = |row: &Row| row.map(|(mean, tenth)| format!("{mean:.2} ({tenth:.2})")).join("   ");
    println!("foundation  {}", cells(&foundation));
    println!("both        {}", cells(&both));
    let less = |k: usize| 100.0 * (1.0 - both[k].0 / foundation[k].0);
    println!("reduction of the mean: {:.0} %, {:.0} %, {:.0} %", less(0), less(1), less(2));
    println!("printed (Table 3.1): 50.2 % at 15 s, 34.6 % at 30 s");
}
