//! Paper II (Kanazawa 2023, sec. 3.3): a perceptron that draws tracks of 30 s without a foundation,
//! which serves as a simulator alone: on its simulations in calm water the perceptron is trained
//! first, then on few trials.

use sistership_learned::horizon::{
    HorizonTraining, OneShotSettings, OrderEncoding, TrackExample, TrackPredictor, train_predictor,
};
use sistership_learned::recurrent::RecurrentCell;
use sistership_model::trial::Channel;
use sistership_model::{Trial, Zoo};

use crate::vessel::foundation::{Shift, ship};
use crate::vessel::hull::{Hull, VESSEL};
use crate::vessel::scenarios;

const HORIZON: usize = 30;
const HOW: OneShotSettings =
    OneShotSettings { steps: HORIZON, told: OrderEncoding::Orders { parts: 6 }, memory: 1 };
const WIND: [Channel; 2] = [Channel::WindSpeed, Channel::WindFrom];
/// As in Paper I.
const LOW_FIDELITY: Shift = Shift { damping: 0.6, inertia: 0.0, seed: 1 };
/// Share of each trial, at its end, that is kept for validation.
const KEPT: f64 = 0.3;

/// How much of it.
#[derive(Debug, Clone, Copy)]
pub struct Size<'a> {
    pub simulations: usize,
    /// Amounts of trials.
    pub trials: &'a [usize],
    /// Draws of the trials.
    pub draws: usize,
    pub judged: usize,
    pub epochs: usize,
}

impl Size<'_> {
    pub const PAPER: Self =
        Self { simulations: 300, trials: &[1, 2, 4, 8], draws: 3, judged: 12, epochs: 300 };
}

/// Mean distance over horizon and trials judged on, m.
pub struct Outcome {
    pub trials: usize,
    pub untrained: f64,
    pub pretrained: f64,
}

/// Without trials: the foundation, and the perceptron that saw its simulations alone.
pub struct Outcomes {
    pub foundation: f64,
    pub simulated: f64,
    pub by_amount: Vec<Outcome>,
}

fn training(epochs: usize, seed: u64) -> HorizonTraining {
    HorizonTraining {
        cell: RecurrentCell::Rnn,
        width: 40,
        epochs,
        patience: 30,
        batch: 32,
        rate: 1e-3,
        seed,
    }
}

/// What the perceptron is told, as the paper's: no wind, of which the simulations know nothing.
fn examples(trials: &[Trial], hop: usize) -> Vec<TrackExample> {
    let of = |trial: &Trial| {
        let mut trial = trial.clone();
        trial.channels.retain(|channel, _| !WIND.contains(channel));
        HOW.trial_examples(None, &trial, hop).unwrap_or_else(|error| panic!("{error}"))
    };
    trials.iter().flat_map(of).collect()
}

/// Examples to learn from, and those at the end of each trial, of which none sees the same seconds.
fn parts(trials: &[Trial]) -> [Vec<TrackExample>; 2] {
    let mut parts: [Vec<TrackExample>; 2] = Default::default();
    for trial in trials {
        let from = ((1.0 - KEPT) * trial.len() as f64) as usize - HORIZON / 2;
        for one in examples(std::slice::from_ref(trial), 1) {
            if one.sample >= from {
                parts[1].push(one);
            } else if one.sample + HORIZON < from + HORIZON / 2 {
                parts[0].push(one);
            }
        }
    }
    parts
}

fn learned(
    parts: &[Vec<TrackExample>; 2],
    how: &HorizonTraining,
    start: Option<&TrackPredictor>,
) -> TrackPredictor {
    train_predictor(&parts[0], &parts[1], how, start).unwrap_or_else(|error| panic!("{error}"))
}

fn miss(examples: &[TrackExample], added: impl Fn(&TrackExample) -> Vec<f64>) -> f64 {
    let one =
        |one: &TrackExample| one.position_errors(&added(one)).iter().sum::<f64>() / HORIZON as f64;
    examples.iter().map(one).sum::<f64>() / examples.len() as f64
}

pub fn outcomes(size: Size<'_>) -> Outcomes {
    let zoo = Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"));
    let hull = Hull::new(&zoo);
    let simulator = Hull::in_calm(ship(&zoo, VESSEL, LOW_FIDELITY), &hull);
    let simulated =
        scenarios::all(size.simulations, 7, |seed| scenarios::zigzag(&simulator, None, seed));
    let sailed = |count: usize, seed: u64| {
        scenarios::all(count, seed, |seed| scenarios::zigzag(&hull, Some(3), seed))
    };
    let split = simulated.len() * 4 / 5;
    let before = [examples(&simulated[..split], 5), examples(&simulated[split..], 5)];
    let first = learned(&before, &training(size.epochs / 3, 2022), None);
    let judged = sailed(size.judged, 8);
    let test = examples(&judged, 1);
    let foundation = foundation(&zoo, &judged);
    let of_amount = |trials: &usize| {
        let (mut untrained, mut pretrained) = (0.0, 0.0);
        for draw in 0..size.draws as u64 {
            let parts = parts(&sailed(*trials, 20 + draw));
            let how = training(size.epochs, draw);
            let share = 1.0 / size.draws as f64;
            for (sum, start) in [(&mut untrained, None), (&mut pretrained, Some(&first))] {
                let learned = learned(&parts, &how, start);
                *sum += share * miss(&test, |one| learned.predict_correction(&one.inputs));
            }
        }
        Outcome { trials: *trials, untrained, pretrained }
    };
    let by_amount = size.trials.iter().map(of_amount).collect();
    let simulated = miss(&test, |one| first.predict_correction(&one.inputs));
    Outcomes { foundation, simulated, by_amount }
}

/// The foundation itself, under the orders to come.
fn foundation(zoo: &Zoo, judged: &[Trial]) -> f64 {
    let ship = ship(zoo, VESSEL, LOW_FIDELITY);
    let how = OneShotSettings { told: OrderEncoding::Nothing, ..HOW };
    let of = |trial: &Trial| {
        how.trial_examples(Some(&ship), trial, 1).unwrap_or_else(|error| panic!("{error}"))
    };
    let examples: Vec<TrackExample> = judged.iter().flat_map(of).collect();
    miss(&examples, |_| vec![0.0; 2 * HORIZON])
}

pub fn run(size: Size<'_>) {
    let Outcomes { foundation, simulated, by_amount } = outcomes(size);
    println!(
        "mean distance over 30 s, m: foundation {foundation:.2}, simulations alone {simulated:.2}"
    );
    println!("trials  without pre-training  with it  reduction");
    for Outcome { trials, untrained, pretrained } in by_amount {
        let less = 100.0 * (1.0 - pretrained / untrained);
        println!("{trials:<8}{untrained:<22.2}{pretrained:<9.2}{less:.0} %");
    }
    println!("printed, with 9 trials for training and 3 for validation: 61 %");
}
