#![allow(clippy::unwrap_used)]
use sistership_model::branch::{CorrectionDocument, CorrectionMode, CorrectionRecipe, Learner};
use sistership_model::effect::AppliedEffect;
use sistership_model::learned::AttachedWeights;
use sistership_model::manifest::VelocityFrame;
use sistership_model::quantity::Quantity;
use sistership_model::trial::Channel;
use sistership_model::validity::Region;
use sistership_model::{Effect, Law, Model, Trial, Zoo};
use sistership_simulation::Ship;
use sistership_simulation::branch::AdditionFormulas;
use sistership_simulation::plant::PlantWorkspace;
use sistership_simulation::state::{StateVector, at};

use super::*;
use crate::{
    EffectCandidate, FilterColumns, LinearisationDetail, LinearisedPart, ResidualSystem,
    TrialReadings, linearise,
};

/// Smooth in everything that it sees; it takes a third of the law's place.
#[derive(Debug)]
struct Known;

impl CorrectionModel for Known {
    fn rate_additions(&self, at: &CorrectionInstant) -> [f64; 3] {
        let ([u, v, r], [a, b, c]) = (at.velocities, at.accelerations);
        [0.01 * u * v - a / 3.0, 0.2 * u * r * at.delta_rad - b / 3.0, 1e-3 * v * v - c / 3.0]
    }

    fn addition_gradient(&self, at: &CorrectionInstant) -> AdditionGradient {
        let [u, v, r] = at.velocities;
        let third = -1.0 / 3.0;
        AdditionGradient {
            by_velocity: [
                [0.01 * v, 0.01 * u, 0.0],
                [0.2 * r * at.delta_rad, 0.0, 0.2 * u * at.delta_rad],
                [0.0, 2e-3 * v, 0.0],
            ],
            by_delta: [0.0, 0.2 * u * r, 0.0],
            by_n: [0.0; 3],
            by_acceleration: [[third, 0.0, 0.0], [0.0, third, 0.0], [0.0, 0.0, third]],
        }
    }

    fn addition_formulas(&self) -> AdditionFormulas {
        AdditionFormulas::default()
    }

    fn active_share(&self, _: &CorrectionInstant) -> f64 {
        1.0
    }
}

/// The Mariner with that correction.
fn model(zoo: &Zoo) -> Model {
    let recipe = CorrectionRecipe {
        learner: Learner::KernelRidge { centres: 1, length: 1.0, ridge: 1.0 },
        seed: 1,
        window_s: 1.0,
        hop_s: 1.0,
        trials: Vec::new(),
    };
    let columns = ["u", "v", "r"].map(|name| (name.to_owned(), vec![-1.0, 1.0]));
    let branch = CorrectionDocument {
        mode: CorrectionMode::Serial,
        outputs: Vec::new(),
        weights_sha256: String::new(),
        domain: Region::from_samples(&columns.into()).unwrap(),
        fade: 1.0,
        recipe,
        learned: AttachedWeights::new(Arc::new(Known)),
    };
    Model { branch: Some(branch), ..zoo.find_model("mariner").unwrap() }
}

const STATE: [(Channel, usize, f64); 6] = [
    (Channel::U, at::U, 7.0),
    (Channel::V, at::V, -0.6),
    (Channel::R, at::R, 0.008),
    (Channel::Psi, at::PSI, 0.4),
    (Channel::X, at::X, 0.0),
    (Channel::Y, at::Y, 0.0),
];
const DELTA: f64 = -0.2;

/// Nine samples of one motion, so that every mean is that of one sample.
fn trial() -> Trial {
    let mut channels: std::collections::BTreeMap<Channel, Vec<f64>> =
        STATE.iter().map(|(channel, _, value)| (*channel, vec![*value; 9])).collect();
    channels.insert(Channel::Delta, vec![DELTA; 9]);
    let t_s = (0..9).map(f64::from).collect();
    Trial { name: "held".into(), t_s, channels, ..Trial::default() }
}

/// Rates of u, v, r by simulation.
fn rates(model: &Model, law: &Law, moved: &dyn Fn(&mut StateVector)) -> [f64; 3] {
    let ship = Ship::new(model, law).unwrap();
    let mut state = StateVector::zeros();
    STATE.iter().for_each(|(_, place, value)| state[*place] = *value);
    moved(&mut state);
    let rate = ship.rate_with(&state, &ship.inputs_for(DELTA, 0.0), &mut PlantWorkspace::default());
    [rate[at::U], rate[at::V], rate[at::R]]
}

fn slope(of: &dyn Fn(f64) -> [f64; 3], step: f64) -> [f64; 3] {
    let (above, below) = (of(step), of(-step));
    std::array::from_fn(|k| (above[k] - below[k]) / (2.0 * step))
}

fn linearised(model: &Model, law: &Law, columns: FilterColumns) -> LinearisedPart {
    let dressed = law.with_effects(model).unwrap();
    let system = ResidualSystem::new(model, &dressed, columns, VelocityFrame::Ground).unwrap();
    let trial = trial();
    let record = TrialReadings::new(&trial, 0.0, 0.0);
    linearise(&system, &record, LinearisationDetail::Whole).unwrap().remove(0)
}

fn assert_close(found: [f64; 3], expected: [f64; 3], what: &str) {
    let size = expected.iter().fold(1e-9_f64, |size, value| size.max(value.abs()));
    let close = |(a, b): (&f64, &f64)| (a - b).abs() < 1e-5 * size;
    assert!(found.iter().zip(&expected).all(close), "{what}: {found:?} not {expected:?}");
}

#[test]
fn a_correction_is_part_of_what_is_linearised() {
    let zoo = Zoo::load_embedded().unwrap();
    let (model, law) = (model(&zoo), zoo.law("abkowitz").unwrap());
    let part = linearised(&model, law, FilterColumns::default());
    let states = part.sizes.states;
    let by_state = |state: usize| [0, 1, 2].map(|row| part.jacobian[row * states + state]);
    for (state, place) in [(0, at::U), (1, at::V), (2, at::R)] {
        let expected = slope(&|by| rates(&model, law, &|state| state[place] += by), 1e-4);
        assert_close(by_state(state), expected, "state");
    }
    let alone = linearised(&model.without_correction(), law, FilterColumns::default());
    assert_ne!(part.jacobian, alone.jacobian, "it is the correction that is compared");
    // What the model moves more than the path, in a second.
    let moves = rates(&model, law, &|_| {});
    assert_close([part.defect[0], part.defect[1], part.defect[2]], moves, "defect");
}

#[test]
fn coefficients_and_effects_act_around_it() {
    let zoo = Zoo::load_embedded().unwrap();
    let (model, law) = (model(&zoo), zoo.law("abkowitz").unwrap());
    let nuisance = FilterColumns::nuisance_columns(&model, law, &[]);
    let own = nuisance.iter().position(|known| known.name == "N_r").unwrap();
    let effect = zoo.effect("rudder-offset").unwrap();
    let form = effect.forms.iter().find(|form| form.file.name == "constant").unwrap();
    let candidate = EffectCandidate::at_absence(&effect.name, form);
    let columns = FilterColumns { nuisance, candidates: vec![candidate] };
    let count = columns.len();
    let part = linearised(&model, law, columns);
    let column = |place: usize| [0, 1, 2].map(|row| part.accelerations[row * count + place]);
    let with_coefficient = |by: f64| {
        let mut moved = model.clone();
        moved.coefficients.get_mut("N_r").unwrap().value += by;
        rates(&moved, law, &|_| {})
    };
    assert_close(column(own), slope(&with_coefficient, 1e-6), "N_r");
    let offset = |by: f64| rates(&with_offset(&model, effect, by), law, &|_| {});
    assert_close(column(count - 1), slope(&offset, 1e-5), "rudder offset");
}

fn with_offset(model: &Model, effect: &Effect, by: f64) -> Model {
    let form = effect.forms.iter().find(|form| form.file.name == "constant").unwrap();
    let names = form.parameters.keys().cloned();
    let effect = AppliedEffect {
        name: effect.name.clone(),
        acts_on: effect.acts_on,
        parameters: names.map(|name| (name, Quantity::new(by, "test"))).collect(),
        form: form.file.clone(),
    };
    Model { effects: vec![effect], ..model.clone() }
}
