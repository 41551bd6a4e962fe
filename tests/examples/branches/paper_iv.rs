//! Paper IV (Kanazawa 2023, chapter 4): how the error of the cooperative model goes with the amount
//! of data and with how far the foundation is off. For the virtual ship, or for any ship of the
//! zoo, whose own model then sails in its place, in weather of its size.

use sistership_learned::horizon::{
    HorizonTraining, OneShotSettings, OrderEncoding, TrackExample, train_predictor,
};
use sistership_learned::recurrent::RecurrentCell;
use sistership_model::{Trial, Zoo};
use sistership_simulation::Ship;

use crate::vessel::foundation::{Shift, ship};
use crate::vessel::hull::{Hull, VESSEL};
use crate::vessel::scenarios;

const HORIZON: usize = 30;
const HOW: OneShotSettings =
    OneShotSettings { steps: HORIZON, told: OrderEncoding::Nothing, memory: 1 };

/// How much of it.
#[derive(Debug, Clone, Copy)]
pub struct Size<'a> {
    /// Manoeuvres in all, of which the last `judged` are judged on.
    pub judged: usize,
    /// Amounts of manoeuvres, rising; each has those before it.
    pub amounts: &'a [usize],
    pub foundations: &'a [Shift],
    pub epochs: usize,
}

const fn shift(damping: f64, inertia: f64, seed: u64) -> Shift {
    Shift { damping, inertia, seed }
}

impl Size<'_> {
    /// The zoo's figures, moderate foundations and highly uncertain ones, by Eq. 4.6.
    pub const PAPER: Self = Self {
        judged: 20,
        amounts: &[5, 10, 20, 50, 100],
        foundations: &[
            shift(0.0, 0.0, 0),
            shift(0.3, 0.0, 1),
            shift(0.6, 0.0, 1),
            shift(0.6, 0.0, 2),
            shift(0.6, 0.4, 3),
            shift(0.6, 0.4, 4),
        ],
        epochs: 200,
    };
}

/// A row of the map: how far the foundation is off (A), none without one, and the error by amount
/// of data (H), both mean distances over horizon and manoeuvres judged on.
pub struct Row {
    pub foundation: Option<f64>,
    pub errors: Vec<f64>,
}

fn training(epochs: usize) -> HorizonTraining {
    HorizonTraining {
        cell: RecurrentCell::Rnn,
        width: 32,
        epochs,
        patience: 20,
        batch: 32,
        rate: 1e-3,
        seed: 2022,
    }
}

fn examples(ship: Option<&Ship>, trials: &[Trial]) -> Vec<TrackExample> {
    let of = |trial: &Trial| {
        HOW.trial_examples(ship, trial, 2).unwrap_or_else(|error| panic!("{error}"))
    };
    trials.iter().flat_map(of).collect()
}

fn miss(examples: &[TrackExample], added: impl Fn(&TrackExample) -> Vec<f64>) -> f64 {
    let one =
        |one: &TrackExample| one.position_errors(&added(one)).iter().sum::<f64>() / HORIZON as f64;
    examples.iter().map(one).sum::<f64>() / examples.len() as f64
}

fn row(ship: Option<&Ship>, trials: &[Trial], judged: &[Trial], size: Size<'_>) -> Row {
    let test = examples(ship, judged);
    let of_amount = |amount: &usize| {
        // Of five manoeuvres one is for validation.
        let part = |kept: bool| -> Vec<Trial> {
            let own = trials[..*amount].iter().enumerate();
            own.filter(|(k, _)| (k % 5 == 4) == kept).map(|(_, trial)| trial.clone()).collect()
        };
        let (seen, kept) = (examples(ship, &part(false)), examples(ship, &part(true)));
        let learned = train_predictor(&seen, &kept, &training(size.epochs), None);
        let learned = learned.unwrap_or_else(|error| panic!("{error}"));
        miss(&test, |one| learned.predict_correction(&one.inputs))
    };
    let foundation = ship.map(|_| miss(&test, |_| vec![0.0; 2 * HORIZON]));
    Row { foundation, errors: size.amounts.iter().map(of_amount).collect() }
}

/// Rows by foundation, and without one.
pub fn map(vessel: &str, size: Size<'_>) -> Vec<Row> {
    let zoo = Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"));
    let hull = if vessel == VESSEL { Hull::new(&zoo) } else { Hull::of_zoo(&zoo, vessel) };
    let most = size.amounts.iter().copied().max().unwrap_or_default();
    let sailed = |count, seed| scenarios::all(count, seed, |seed| scenarios::turning(&hull, seed));
    let (trials, judged) = (sailed(most, 40), sailed(size.judged, 41));
    let foundation = |shift: &Shift| ship(&zoo, vessel, *shift);
    let ships: Vec<Ship> = size.foundations.iter().map(foundation).collect();
    let with = ships.iter().map(Some).chain([None]);
    with.map(|ship| row(ship, &trials, &judged, size)).collect()
}

pub fn run(vessel: &str, size: Size<'_>) {
    println!(
        "{vessel}: mean distance over {HORIZON} samples, m; rows: foundations, columns: manoeuvres"
    );
    print!("{:<12}", "foundation");
    size.amounts.iter().for_each(|amount| print!("{amount:<8}"));
    println!();
    for Row { foundation, errors } in map(vessel, size) {
        print!("{:<12}", foundation.map_or("none".to_owned(), |error| format!("{error:.2}")));
        errors.iter().for_each(|error| print!("{error:<8.2}"));
        println!();
    }
}
