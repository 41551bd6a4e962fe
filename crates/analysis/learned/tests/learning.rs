//! That branches learn, that they learn the same twice, and what is refused.

use crate::ships::{Foundation, learners, training};
use sistership_learned::{
    CorrectionTraining, JoinError, TrainError, WeightsError, corrected_ship,
    permutation_importance, retrain_correction, train_correction, window_rows,
};
use sistership_model::branch::{CorrectionMode, Learner, Signal};
use sistership_model::coefficient::Axis;
use sistership_model::trial::{Channel, Trial};
use sistership_model::{Law, Model};
use sistership_simulation::error::SquaredError;
use sistership_simulation::manoeuvre::{ManoeuvreSettings, simulate_turn, simulate_zigzag};
use sistership_simulation::recorded::{ReplaySettings, replay_trial};
use sistership_simulation::{Plant, PlantError, Ship};

fn errors(ship: &Ship, trial: &Trial) -> [f64; 3] {
    let run = replay_trial(ship, trial, &ReplaySettings::default()).unwrap();
    assert_eq!(run.stopped, None);
    let error = SquaredError::from_trial(trial, &run);
    [Channel::U, Channel::V, Channel::R].map(|channel| error.channel_rmse(channel).unwrap())
}

/// A branch beside the foundation, in both ways, against the foundation alone and the data alone.
#[test]
fn every_kind_comes_nearer_to_the_truth_than_what_it_is_made_of() {
    let foundation = Foundation::of("mariner");
    let unseen = foundation.trials(&[15.0]).remove(0);
    let alone = errors(&Ship::new(&foundation.model, &foundation.law).unwrap(), &unseen);
    for learner in learners() {
        let of = |mode| {
            let (model, weights) = foundation.trained(&training(learner.clone(), mode));
            errors(&corrected_ship(&model, &foundation.law, &weights).unwrap(), &unseen)
        };
        let data = of(CorrectionMode::Convert);
        for mode in [CorrectionMode::Parallel, CorrectionMode::Serial] {
            let both = of(mode);
            println!("{mode:?} {learner:?}: {alone:?}, data alone {data:?} -> {both:?}");
            // What is added beats the data alone, too; what is given whole need not.
            let limit = |channel: usize| match mode {
                CorrectionMode::Parallel => alone[channel].min(data[channel]),
                _ => alone[channel],
            };
            for (channel, error) in both.iter().enumerate() {
                let half = 0.5 * limit(channel);
                assert!(*error < half, "{mode:?} {learner:?} {channel}");
            }
        }
    }
}

#[test]
fn training_again_gives_the_same_bytes() {
    let foundation = Foundation::of("mariner");
    let trials = foundation.trials(&[10.0, 20.0]);
    let trials: Vec<&Trial> = trials.iter().collect();
    for learner in learners() {
        let wanted = training(learner, CorrectionMode::Parallel);
        let (branch, weights) =
            train_correction(&foundation.model, &foundation.law, &trials, &wanted).unwrap();
        let text = serde_json::to_string(&branch).unwrap();
        let read = serde_json::from_str(&text).unwrap();
        assert_eq!(branch, read);
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        let again =
            || retrain_correction(&foundation.model, &read, &foundation.law, &trials).unwrap();
        let (branch_again, weights_again) = pool.install(again);
        assert_eq!(serde_json::to_string(&branch_again).unwrap(), text);
        assert_eq!(weights_again.to_bytes().unwrap(), weights.to_bytes().unwrap());
        let other = CorrectionTraining { seed: 2, ..wanted };
        let (other, _) =
            train_correction(&foundation.model, &foundation.law, &trials, &other).unwrap();
        assert_ne!(other.weights_sha256, branch.weights_sha256, "the seed changes nothing");
    }
}

#[test]
fn runs_say_that_they_left_the_domain() {
    let (Foundation { law, .. }, model, weights) = forest();
    let joined = corrected_ship(&model, &law, &weights).unwrap();
    let settings = ManoeuvreSettings::default();
    let hard = simulate_turn(&joined, 35.0, &settings).unwrap().track;
    let gentle = simulate_zigzag(&joined, 5.0, 5.0, &settings).unwrap().track;
    let outside = joined.find_excursion(&hard).unwrap();
    assert!(outside.share > 0.5 && outside.beyond > 0.5, "{outside:?}");
    assert_eq!(joined.find_excursion(&gentle), None);
}

/// The truth's rudder is weaker than the foundation's, and nothing else differs.
#[test]
fn importance_names_what_the_remainder_depends_on() {
    let foundation = Foundation::of("mariner");
    let mut truth = foundation.model.clone();
    truth.coefficients.get_mut("N_delta").unwrap().value *= 0.7;
    let truth = Ship::new(&truth, &foundation.law).unwrap();
    let track = simulate_zigzag(&truth, 20.0, 20.0, &ManoeuvreSettings::default()).unwrap().track;
    let trial = crate::ships::recorded("zigzag", &track);
    for learner in learners() {
        let wanted = CorrectionTraining {
            inputs: vec![(Axis::N, vec![Signal::U, Signal::V, Signal::R, Signal::Delta])],
            ..training(learner, CorrectionMode::Parallel)
        };
        let (branch, weights) =
            train_correction(&foundation.model, &foundation.law, &[&trial], &wanted).unwrap();
        let alone = Ship::new(&foundation.model, &foundation.law).unwrap();
        let rows = window_rows(&alone, &trial, 2.0, 1.0).unwrap();
        let found = permutation_importance(&branch, &weights, &rows, 1);
        let (rudder, others) = found.split_last().unwrap();
        assert_eq!(rudder.signal, Signal::Delta);
        assert!(others.iter().all(|other| rudder.rise > other.rise), "{found:?}");
    }
}

#[test]
fn a_model_without_a_branch_keeps_its_bytes() {
    let model = Foundation::of("mariner").model;
    assert!(!serde_json::to_string(&model).unwrap().contains("branch"));
}

fn forest() -> (Foundation, Model, Vec<u8>) {
    let foundation = Foundation::of("mariner");
    let [learner, ..] = learners();
    let (model, weights) = foundation.trained(&training(learner, CorrectionMode::Parallel));
    (foundation, model, weights)
}

fn joined(model: &Model, law: &Law, weights: &[u8]) -> String {
    corrected_ship(model, law, weights).unwrap_err().to_string()
}

#[test]
fn what_does_not_belong_together_is_refused_by_name() {
    let (Foundation { law, model: bare }, model, weights) = forest();
    assert!(matches!(corrected_ship(&bare, &law, &weights), Err(JoinError::None(_))));
    assert!(matches!(Ship::new(&model, &law), Err(PlantError::Weights { .. })));
    assert!(matches!(Ship::with_open_coefficients(&model, &law), Err(PlantError::Weights { .. })));
    assert_eq!(
        Plant::new(&model, &law).err(),
        Some(PlantError::Branch(model.name.clone())),
        "a view by formulas cannot have a branch"
    );
    let mut other = weights.clone();
    *other.last_mut().unwrap() = b' ';
    let refused = corrected_ship(&model, &law, &other);
    assert!(matches!(refused, Err(JoinError::Weights(WeightsError::Hash { .. }))));
    let with = |change: &dyn Fn(&mut sistership_model::branch::CorrectionDocument)| {
        let mut model = model.clone();
        model.branch.iter_mut().for_each(change);
        joined(&model, &law, &weights)
    };
    let network =
        Learner::Perceptron { hidden: vec![4], epochs: 1, batch: 1, rate: 0.1, decay: 0.0 };
    assert!(
        with(&|b| b.recipe.learner = network.clone())
            .contains("do not match the kind of the recipe")
    );
    assert!(with(&|b| b.outputs[1].inputs.truncate(1)).contains("weights.outputs.Y"));
    assert!(with(&|b| b.outputs.truncate(2)).contains("there are 3, but the correction has 2"));
    assert!(with(&|b| b.outputs[0].axis = Axis::N).contains("X, Y and N, and each at most once"));
    assert!(with(&|b| b.outputs[0].range = [1.0, f64::NAN]).contains("range"));
    assert!(with(&|b| b.fade = 0.0).contains("fade"));
    assert!(with(&|b| b.mode = CorrectionMode::Serial).contains("of the foundation"));
    assert!(
        with(&|b| {
            b.domain.ranges.insert("u".into(), [-20.0, 40.0]);
        })
        .contains("physical range")
    );
}

#[test]
fn training_on_what_is_no_number_is_refused_with_the_place() {
    let foundation = Foundation::of("mariner");
    let mut trials = foundation.trials(&[10.0]);
    trials[0].channels.get_mut(&Channel::V).unwrap()[40] = f64::NAN;
    let [learner, ..] = learners();
    let wanted = training(learner.clone(), CorrectionMode::Parallel);
    let refused = |trials: &[Trial], wanted: &CorrectionTraining| -> TrainError {
        let trials: Vec<&Trial> = trials.iter().collect();
        train_correction(&foundation.model, &foundation.law, &trials, wanted).unwrap_err()
    };
    let said = refused(&trials, &wanted).to_string();
    assert!(said.contains("trial `zigzag 10`, 20 s"), "{said}");
    trials[0].channels.remove(&Channel::R);
    assert!(refused(&trials, &wanted).to_string().contains("no channel `r`"));
    assert!(refused(&[], &wanted).to_string().contains("too few"));
    let convert = CorrectionTraining {
        inputs: vec![(Axis::X, vec![Signal::UDot])],
        mode: CorrectionMode::Convert,
        ..wanted
    };
    let good = foundation.trials(&[10.0]);
    assert!(
        refused(&good, &convert)
            .to_string()
            .contains("no input may be an acceleration of the foundation")
    );
}
