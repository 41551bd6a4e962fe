//! Properties that hold whatever the numbers: symmetry, the prime system, coefficients recovered,
//! runs that stop.

mod across_laws;
mod foreign;
mod propulsion;
mod recovery;
mod scaling;
mod stopping;
mod symmetry;
mod truth;

use std::sync::Arc;

use sistership_model::{Law, Model, Zoo};
use sistership_simulation::Ship;

/// The models of the zoo that sail.
const SHIPS: [&str; 6] = ["mariner", "sr108", "kvlcc2", "kvlcc2-7m", "kcs", "esso-tanker"];

fn model(name: &str) -> (Model, Arc<Law>) {
    let zoo = Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"));
    let model = zoo.find_model(name).unwrap_or_else(|error| panic!("{error}"));
    let law = zoo.law(&model.law).expect("the law of a zoo model").clone();
    (model, law)
}

fn ready(model: &Model, law: &Law) -> Ship {
    Ship::new(model, law).unwrap_or_else(|error| panic!("{error}"))
}
