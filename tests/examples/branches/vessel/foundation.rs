//! Foundations: the zoo's law of the ship with wind of a typical ship, its figures shifted by
//! Kanazawa 2023, Eq. 4.6.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha12Rng;
use sistership_model::effect::AppliedEffect;
use sistership_model::quantity::Quantity;
use sistership_model::{Model, Zoo};
use sistership_simulation::Ship;

/// How far its figures are from those of the zoo.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shift {
    /// Largest share by which each coefficient of the hull's damping is off.
    pub damping: f64,
    /// The same of masses, moments and thrust.
    pub inertia: f64,
    pub seed: u64,
}

/// Parameters of masses and thrust, whatever the law.
const INERTIA: [&str; 8] = ["m", "I_z", "X_udot", "Y_vdot", "Y_rdot", "N_vdot", "N_rdot", "T_nn"];

/// A vessel's model of the zoo with the wind, and figures shifted.
pub fn model(zoo: &Zoo, vessel: &str, shift: Shift) -> Model {
    let mut model = zoo.find_model(vessel).unwrap_or_else(|error| panic!("{error}"));
    let mut rng = ChaCha12Rng::seed_from_u64(shift.seed);
    let mut shifted = |value: f64, by: f64| value * (1.0 + by * rng.random_range(-1.0..1.0));
    for quantity in model.coefficients.values_mut() {
        quantity.value = shifted(quantity.value, shift.damping);
    }
    for name in INERTIA {
        if let Some(quantity) = model.parameters.get_mut(name) {
            quantity.value = shifted(quantity.value, shift.inertia);
        }
    }
    model.effects.push(wind(zoo));
    model
}

/// The wind by the means of its priors.
fn wind(zoo: &Zoo) -> AppliedEffect {
    let effect = zoo.effect("wind").expect("in the zoo");
    let form = effect.forms.iter().find(|form| form.file.name == "measured").expect("a form of it");
    let mean = |name: &String| Quantity::new(form.parameters[name].prior_mean, "prior");
    AppliedEffect {
        name: effect.name.clone(),
        acts_on: effect.acts_on,
        parameters: form.parameters.keys().map(|name| (name.clone(), mean(name))).collect(),
        form: form.file.clone(),
    }
}

/// The same, ready to sail.
pub fn ship(zoo: &Zoo, vessel: &str, shift: Shift) -> Ship {
    let model = model(zoo, vessel, shift);
    let law = zoo.law(&model.law).expect("its law");
    Ship::new(&model, law).unwrap_or_else(|error| panic!("{error}"))
}
