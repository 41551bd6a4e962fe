//! A foundation, and trials of a ship that it is not quite of.
#![allow(dead_code)]

use sistership_learned::{CorrectionTraining, train_correction};
use sistership_model::branch::{CorrectionMode, Learner, Signal};
use sistership_model::coefficient::Axis;
use sistership_model::trial::{Channel, Trial};
use sistership_model::{Law, Model, Zoo};
use sistership_simulation::Ship;
use sistership_simulation::manoeuvre::{ManoeuvreSettings, simulate_zigzag};
use sistership_simulation::state::{RECORDED_CHANNELS, Trajectory, at};

/// A foundation with its law.
pub struct Foundation {
    pub model: Model,
    pub law: Law,
}

impl Foundation {
    pub fn of(name: &str) -> Self {
        let zoo = Zoo::load_embedded().expect("the zoo");
        let model = zoo.find_model(name).expect("a model of the zoo");
        let law = Law::clone(zoo.law(&model.law).expect("its law"));
        Self { model, law }
    }

    /// The same ship, steering worse and more damped than the foundation says.
    pub fn truth(&self) -> Ship {
        let mut model = self.model.clone();
        for (name, factor) in [("Y_v", 1.2), ("N_r", 1.25), ("N_delta", 0.85), ("X_uu", 1.3)] {
            if let Some(quantity) = model.coefficients.get_mut(name) {
                quantity.value *= factor;
            }
        }
        Ship::new(&model, &self.law).expect("a ready ship")
    }

    /// Zigzags of the true ship; where it has a propeller, each at revolutions of its own.
    pub fn trials(&self, angles: &[f64]) -> Vec<Trial> {
        let truth = self.truth();
        let full = truth.revolutions_at(truth.approach_speed_m_s());
        let sailed = |(k, angle): (usize, &f64)| {
            let n_rps = truth.has_propeller().then(|| full * [1.0, 0.6, 1.3, 0.8][k % 4]);
            let duration_s = Some(500.0);
            let settings = ManoeuvreSettings { duration_s, n_rps, ..Default::default() };
            let track =
                simulate_zigzag(&truth, *angle, angle.abs(), &settings).expect("a zigzag").track;
            recorded(&format!("zigzag {angle}"), &track)
        };
        angles.iter().enumerate().map(sailed).collect()
    }

    /// The model with a branch trained on zigzags, and its weights.
    pub fn trained(&self, training: &CorrectionTraining) -> (Model, Vec<u8>) {
        let trials = self.trials(&[10.0, -10.0, 20.0, -20.0]);
        let trials: Vec<&Trial> = trials.iter().collect();
        let (branch, weights) =
            train_correction(&self.model, &self.law, &trials, training).expect("a trained branch");
        let model = Model { branch: Some(branch), ..self.model.clone() };
        (model, weights.to_bytes().expect("bytes"))
    }
}

/// A track as a trial of two samples a second.
pub fn recorded(name: &str, track: &Trajectory) -> Trial {
    let thin = |column: Vec<f64>| column.into_iter().step_by(5).collect::<Vec<f64>>();
    let columns = RECORDED_CHANNELS[..6].iter().chain(&[(Channel::Delta, at::DELTA)]);
    let mut channels: std::collections::BTreeMap<Channel, Vec<f64>> =
        columns.map(|&(channel, place)| (channel, thin(track.state_column(place)))).collect();
    channels.insert(Channel::N, thin(track.n_rps.clone()));
    Trial { name: name.to_owned(), t_s: thin(track.t_s.clone()), channels, ..Trial::default() }
}

/// A learner of each kind, small enough for tests.
pub fn learners() -> [Learner; 4] {
    [
        Learner::RandomForest { trees: 20, tried: 2, leaf: 5, depth: 10 },
        Learner::BoostedTrees { trees: 60, leaf: 10, depth: 4, rate: 0.1, sampled: 0.5 },
        Learner::KernelRidge { centres: 80, length: 2.0, ridge: 1e-3 },
        Learner::Perceptron { hidden: vec![12], epochs: 40, batch: 32, rate: 0.01, decay: 1e-4 },
    ]
}

/// A training of that learner.
pub fn training(learner: Learner, mode: CorrectionMode) -> CorrectionTraining {
    let mut signals = vec![Signal::U, Signal::V, Signal::R, Signal::Delta];
    if mode == CorrectionMode::Serial {
        signals.extend([Signal::UDot, Signal::VDot, Signal::RDot]);
    }
    let inputs = [Axis::X, Axis::Y, Axis::N].map(|axis| (axis, signals.clone())).to_vec();
    CorrectionTraining { mode, inputs, learner, seed: 1, window_s: 2.0, hop_s: 1.0, fade: 1.0 }
}
