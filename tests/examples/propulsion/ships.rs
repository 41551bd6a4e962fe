//! Ships of the zoo by their own laws, and ships whose laws it does not have, with trials at
//! constant revolutions.

use sistership_model::quantity::Quantity;
use sistership_model::trial::Trial;
use sistership_model::{Model, Vessel, Zoo};
use sistership_simulation::Ship;
use sistership_tests::synthetic::{Orders, Trouble, replica, trial};
use sistership_tests::truth::container::container;
use sistership_tests::truth::ferry::ferry;
use sistership_tests::truth::instruments::Instruments;
use sistership_tests::truth::manoeuvre::Manoeuvre;
use sistership_tests::truth::motion::Truth;
use sistership_tests::truth::stalled::Stalled;
use sistership_tests::truth::tanker::tanker;
use sistership_tests::truth::{self, family};

use crate::speeds::{self, Speeds};

/// A ship with trials.
pub struct Stranger {
    pub vessel: Vessel,
    pub trials: Vec<Trial>,
    /// What the ship itself does.
    pub truth: Option<Speeds>,
}

/// Rudder and change of heading at which it is reversed, deg.
const ZIGZAGS: [f64; 2] = [20.0, -10.0];
/// Rudder, deg.
const TURNS: [f64; 2] = [35.0, -20.0];

/// Ships of the zoo whose published model sails; they have no model of their own for the search.
pub fn of_zoo(zoo: &Zoo) -> Vec<Stranger> {
    zoo.vessels().filter_map(|vessel| of_vessel(zoo, vessel)).collect()
}

fn of_vessel(zoo: &Zoo, vessel: &Vessel) -> Option<Stranger> {
    let model = zoo.published_model(vessel, None).ok()?;
    let ship = Ship::new(&model, zoo.law(&model.law)?).ok()?;
    let trouble = Trouble { gusts: 0.0, scatter: 0.0, angles_deg: 0.0, ..Trouble::default() };
    let zigzags = ZIGZAGS.map(|angle| (Orders::Zigzag(angle, angle.abs()), 25.0));
    let turns = TURNS.map(|angle| (Orders::Turn(angle), 18.0));
    let all = zigzags.into_iter().chain(turns).enumerate();
    let one = |(k, (orders, lengths)): (usize, (Orders, f64))| {
        trial(&ship, &format!("trial {k}"), orders, lengths, &trouble, &mut replica(1, 100 + k))
    };
    let trials: Vec<Trial> = all.map(one).collect();
    Some(Stranger { vessel: bare(vessel, &model), trials, truth: None })
}

fn bare(vessel: &Vessel, model: &Model) -> Vessel {
    let mut bare = vessel.clone();
    bare.file.models = Vec::new();
    bare.file.free_running = Vec::new();
    if let Some(speed) = model.speed_m_s {
        let quantity = Quantity::new(speed, "model");
        bare.particulars.insert("service_speed_m_s".into(), quantity);
    }
    bare
}

/// Ships whose laws the zoo does not have.
pub fn of_truth() -> Vec<Stranger> {
    let ships: Vec<Box<dyn Truth>> = vec![
        Box::new(Stalled(container())),
        Box::new(ferry()),
        Box::new(tanker()),
        Box::new(family::single_screw(1)),
        Box::new(family::twin_screw(2)),
        Box::new(Stalled(family::single_screw(3))),
    ];
    ships.iter().enumerate().map(|(seed, ship)| of_ship(&**ship, seed as u64)).collect()
}

fn of_ship(ship: &dyn Truth, seed: u64) -> Stranger {
    let zigzags = ZIGZAGS.map(|angle| Manoeuvre::Zigzag(angle, angle.abs()));
    let manoeuvres: Vec<Manoeuvre> =
        zigzags.into_iter().chain(TURNS.map(Manoeuvre::Turn)).collect();
    let text = truth::files::vessel(ship.dimensions());
    Stranger {
        vessel: Vessel::parse("truth", &text).unwrap(),
        trials: truth::trials(ship, &manoeuvres, &Instruments::of(ship), seed),
        truth: Some(speeds::of_truth(ship)),
    }
}
