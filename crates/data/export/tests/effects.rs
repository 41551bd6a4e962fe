//! Models with effects, wind and current, exported to C and sailed beside our own simulation.
#![allow(clippy::unwrap_used)]

mod shared;

use sistership_export::{ExportError, ExportSubject, by_name};
use sistership_model::effect::AppliedEffect;
use sistership_model::quantity::Quantity;
use sistership_model::{Model, Zoo};
use sistership_simulation::plant::PlantWorkspace;
use sistership_simulation::state::{at, straight_state};
use sistership_simulation::{Method, Ship};

use shared::programs::by_c;
use shared::{Circle, Track, largest, written};

const MOST: f64 = 1e-6;

/// An effect with its parameters somewhere within their priors.
fn effect(zoo: &Zoo, name: &str, form: &str) -> AppliedEffect {
    let effect = zoo.effect(name).unwrap();
    let form = effect.forms.iter().find(|own| own.file.name == form).unwrap();
    let value = |name: &String| {
        let parameter = &form.parameters[name];
        Quantity::new(parameter.prior_mean + 0.3 * parameter.prior_deviation, "test")
    };
    AppliedEffect {
        name: effect.name.clone(),
        acts_on: effect.acts_on,
        parameters: form.parameters.keys().map(|name| (name.clone(), value(name))).collect(),
        form: form.file.clone(),
    }
}

fn with(zoo: &Zoo, ship: &str, effects: &[(&str, &str)]) -> Model {
    let mut model = zoo.find_model(ship).unwrap();
    model.effects = effects.iter().map(|(name, form)| effect(zoo, name, form)).collect();
    model
}

/// Our own simulation with inputs of the law by name.
fn own(ship: &Ship, circle: &Circle, given: &[(&str, f64)]) -> Track {
    let names: Vec<String> = ship.law_inputs().map(|(name, _)| name.to_owned()).collect();
    let (mut state, mut rows, mut work) =
        (straight_state(circle.speed_m_s), Vec::new(), PlantWorkspace::default());
    let order = circle.rudder_deg.to_radians();
    for _ in 0..=(circle.duration_s / circle.step_s).round() as usize {
        rows.push(std::array::from_fn(|k| state[k]));
        state = Method::Rk4.advance_state(&state, circle.step_s, |_, state| {
            let mut inputs =
                ship.inputs_for(state[at::DELTA], ship.revolutions_at(circle.speed_m_s));
            for (name, value) in given {
                inputs[names.iter().position(|known| known == name).unwrap()] = *value;
            }
            let mut rate = ship.rate_with(state, &inputs, &mut work);
            rate[at::DELTA] =
                ship.steering_gear().rudder_rate(order, state[at::DELTA], circle.step_s);
            rate
        });
    }
    Track(rows)
}

/// The C export with inputs set by the names that programs use.
fn exported(model: &Model, zoo: &Zoo, circle: &Circle, given: &[(&str, f64)]) -> Track {
    let code = String::from_utf8(written(zoo, model, "c")).unwrap();
    let set: String =
        given.iter().map(|(name, value)| format!("in.{name} = {value:?};\n")).collect();
    let order = "in.delta_order = rudder_deg";
    assert!(code.contains(order));
    let folder = tempfile::tempdir().unwrap();
    let code = code.replace(order, &format!("{set}{order}"));
    by_c(folder.path(), code.as_bytes(), &circle.arguments())
}

fn sails_alike(ship: &str, effects: &[(&str, &str)], given: &[(&str, f64)]) {
    let zoo = Zoo::load_embedded().unwrap();
    let (model, circle) = (with(&zoo, ship, effects), Circle::of(&zoo, ship, 10.0));
    let found = exported(&model, &zoo, &circle, given);
    let difference = largest(&circle, &found, &own(&shared::ship(&zoo, &model), &circle, given));
    println!("{ship} {effects:?}: {difference:.1e}");
    assert!(difference < MOST, "{ship} {effects:?}: {difference:e}");
    // It is no bare model that was compared.
    let bare = own(&shared::ship(&zoo, &with(&zoo, ship, &[])), &circle, &[]);
    assert!(largest(&circle, &found, &bare) > 1e-3, "{ship} {effects:?} changes nothing");
}

#[test]
fn effects_act_as_in_our_own_simulation() {
    sails_alike("mariner", &[("rudder-lag", "first-order"), ("rudder-offset", "constant")], &[]);
    sails_alike("kvlcc2", &[("extra-resistance", "quadratic"), ("current", "constant")], &[]);
    sails_alike("mariner", &[("rudder-lag", "dead-band")], &[]);
    let wind = [("wind_speed", 15.0), ("wind_from", 1.0)];
    sails_alike("mariner", &[("wind", "measured"), ("current", "constant")], &wind);
}

#[test]
fn a_law_that_knows_depth_takes_it() {
    sails_alike("esso-tanker", &[], &[("depth", 30.0)]);
}

#[test]
fn a_current_from_outside_is_that_of_the_effect() {
    let zoo = Zoo::load_embedded().unwrap();
    let circle = Circle::of(&zoo, "sr108", 10.0);
    let given = [("current_north", 0.7), ("current_east", -0.4)];
    let found = exported(&zoo.find_model("sr108").unwrap(), &zoo, &circle, &given);
    let mut model = with(&zoo, "sr108", &[("current", "constant")]);
    for (name, value) in [("north_m_s", 0.7), ("east_m_s", -0.4)] {
        model.effects[0].parameters.insert(name.to_owned(), Quantity::new(value, "test"));
    }
    let difference = largest(&circle, &found, &own(&shared::ship(&zoo, &model), &circle, &[]));
    assert!(difference < MOST, "{difference:e}");
}

#[test]
fn what_cannot_be_exported_says_why() {
    let zoo = Zoo::load_embedded().unwrap();
    let mut model = with(&zoo, "kvlcc2", &[("rudder-lag", "first-order")]);
    model.effects[0].form.lags = [("n".to_owned(), "time_constant_s".to_owned())].into();
    let law = zoo.law(&model.law).unwrap();
    let subject = ExportSubject { model: &model, law, version: None, sha256: String::new() };
    let refused = by_name("c").unwrap().prepare(&subject).unwrap_err();
    assert!(matches!(&refused, ExportError::Lag { input, .. } if input == "n"), "{refused}");
}
