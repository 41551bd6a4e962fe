//! One-shot prediction: what is refused, what is bounded, and that training repeats itself.

use crate::ships::Foundation;
use sistership_learned::horizon::{
    HorizonError, HorizonTraining, OneShotSettings, OrderEncoding, TrackExample, TrackPredictor,
    train_predictor,
};
use sistership_learned::recurrent::RecurrentCell;
use sistership_model::trial::{Channel, Trial};
use sistership_simulation::Ship;

/// Half a minute, at two samples a second.
const STEPS: usize = 60;

fn training(cell: RecurrentCell) -> HorizonTraining {
    HorizonTraining { cell, width: 8, epochs: 12, patience: 12, batch: 16, rate: 5e-3, seed: 5 }
}

fn how(told: OrderEncoding, memory: usize) -> OneShotSettings {
    OneShotSettings { steps: STEPS, told, memory }
}

/// A foundation, and zigzags of a ship that differs from it.
fn sailed() -> (Ship, Vec<Trial>) {
    let foundation = Foundation::of("mariner");
    let ship = Ship::new(&foundation.model, &foundation.law).unwrap();
    (ship, foundation.trials(&[10.0, -20.0, 15.0]))
}

fn examples(how: OneShotSettings, ship: Option<&Ship>, trials: &[Trial]) -> Vec<TrackExample> {
    trials.iter().flat_map(|trial| how.trial_examples(ship, trial, 3).unwrap()).collect()
}

fn miss(examples: &[TrackExample], added: impl Fn(&TrackExample) -> Vec<f64>) -> f64 {
    let one = |one: &TrackExample| one.position_errors(&added(one)).iter().sum::<f64>();
    examples.iter().map(one).sum::<f64>() / (STEPS * examples.len()) as f64
}

#[test]
fn a_predictor_takes_off_what_the_foundation_lacks_and_repeats_itself() {
    let (foundation, trials) = sailed();
    for (cell, memory) in [(RecurrentCell::Rnn, 1), (RecurrentCell::Lstm, 6)] {
        let how = how(OrderEncoding::End, memory);
        let parts = [&trials[..1], &trials[1..2], &trials[2..]]
            .map(|own| examples(how, Some(&foundation), own));
        let learned = train_predictor(&parts[0], &parts[1], &training(cell), None).unwrap();
        let alone = miss(&parts[2], |_| vec![0.0; 2 * STEPS]);
        let both = miss(&parts[2], |one| learned.predict_correction(&one.inputs));
        assert!(both < 0.5 * alone, "{cell:?}: {alone} {both}");
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        let again =
            pool.install(|| train_predictor(&parts[0], &parts[1], &training(cell), None)).unwrap();
        assert_eq!(bytes(&again), bytes(&learned));
    }
}

fn bytes(predictor: &TrackPredictor) -> Vec<u8> {
    serde_json::to_vec(predictor).unwrap()
}

#[test]
fn nothing_is_added_beyond_what_training_held() {
    let (foundation, trials) = sailed();
    let all = examples(how(OrderEncoding::End, 1), Some(&foundation), &trials);
    let learned = train_predictor(&all, &all, &training(RecurrentCell::Rnn), None).unwrap();
    let lacking: Vec<Vec<f64>> = all.iter().map(TrackExample::foundation_error).collect();
    let most = |k: usize| lacking.iter().map(|row| row[k]).fold(f64::NEG_INFINITY, f64::max);
    let least = |k: usize| lacking.iter().map(|row| row[k]).fold(f64::INFINITY, f64::min);
    for far in [-1e9, 1e9] {
        let inputs = vec![vec![far; all[0].inputs[0].len()]];
        for (k, added) in learned.predict_correction(&inputs).into_iter().enumerate() {
            assert!((least(k)..=most(k)).contains(&added), "{far} {k}: {added}");
        }
    }
}

#[test]
fn what_cannot_be_learned_from_is_refused() {
    let (foundation, mut trials) = sailed();
    let all = examples(how(OrderEncoding::End, 1), Some(&foundation), &trials);
    let few = train_predictor(&all[..5], &all, &training(RecurrentCell::Rnn), None);
    assert!(matches!(few, Err(HorizonError::Few { found: 5, .. })), "{few:?}");
    let others = examples(how(OrderEncoding::Nothing, 1), Some(&foundation), &trials);
    let mixed = train_predictor(&all, &others, &training(RecurrentCell::Rnn), None);
    assert!(matches!(mixed, Err(HorizonError::Shape { .. })), "{mixed:?}");
    let t_s = trials[0].t_s[7];
    trials[0].channels.get_mut(&Channel::V).unwrap()[7] = f64::NAN;
    let nan = how(OrderEncoding::Nothing, 1).trial_examples(None, &trials[0], 1);
    let wanted = HorizonError::NotANumber { trial: trials[0].name.clone(), t_s };
    assert_eq!(nan.unwrap_err(), wanted);
    trials[1].channels.remove(&Channel::Delta);
    let none = how(OrderEncoding::End, 1).trial_examples(Some(&foundation), &trials[1], 1);
    assert!(matches!(none, Err(HorizonError::Input(_))), "{none:?}");
}

#[test]
fn settings_out_of_range_are_refused_by_field() {
    let good = training(RecurrentCell::Rnn);
    let field = |training: HorizonTraining| training.check_settings().unwrap_err().field;
    assert_eq!(good.check_settings(), Ok(()));
    assert_eq!(field(HorizonTraining { batch: 0, ..good }), "batch");
    assert_eq!(field(HorizonTraining { width: 0, ..good }), "width");
    assert_eq!(field(HorizonTraining { rate: 2.0, ..good }), "rate");
    let refused = train_predictor(&[], &[], &HorizonTraining { batch: 0, ..good }, None);
    assert!(matches!(refused, Err(HorizonError::Setting(_))), "{refused:?}");
    let field = |one_shot: OneShotSettings, hop: usize| match one_shot.trial_examples(
        None,
        &Trial::default(),
        hop,
    ) {
        Err(HorizonError::Setting(error)) => Some(error.field),
        _ => None,
    };
    assert_eq!(field(how(OrderEncoding::End, 1), 1), None);
    assert_eq!(field(how(OrderEncoding::End, 1), 0), Some("hop"));
    assert_eq!(field(how(OrderEncoding::End, 0), 1), Some("memory"));
    assert_eq!(field(how(OrderEncoding::Orders { parts: 0 }, 1), 1), Some("parts"));
    assert_eq!(field(how(OrderEncoding::Orders { parts: STEPS + 1 }, 1), 1), Some("parts"));
}
