//! Leaving optional particulars out of a ship: every source that carries over to it with them
//! carries over without, and what is used instead is named with a band.

#![allow(clippy::unwrap_used)]

use std::collections::BTreeMap;
use std::sync::Arc;

use rand::seq::IteratorRandom;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha12Rng;
use rayon::prelude::*;
use sistership_model::estimated_particulars::estimated_particulars;
use sistership_model::{Model, Vessel, Zoo};
use sistership_priors::transfer::{TrialApproach, complete_for_law, transfer_model};
use sistership_simulation::Ship;

/// No regression gives these.
const MAIN: [&str; 3] = ["lpp_m", "beam_m", "draught_m"];

/// One published model of each law.
fn sources(zoo: &Zoo) -> Vec<Model> {
    let mut by_law: BTreeMap<String, Model> = BTreeMap::new();
    for vessel in zoo.vessels() {
        for one in &vessel.file.models {
            let model = zoo.find_model(&format!("{}/{}", vessel.name(), one.name)).unwrap();
            by_law.entry(model.law.clone()).or_insert(model);
        }
    }
    by_law.into_values().collect()
}

fn without(vessel: &Vessel, names: &[&str]) -> Vessel {
    let mut reduced = vessel.clone();
    names.iter().for_each(|name| drop(reduced.particulars.remove(*name)));
    reduced
}

fn optional(vessel: &Vessel) -> Vec<&str> {
    let stated = vessel.particulars.keys().map(String::as_str);
    stated.filter(|name| !MAIN.contains(name)).collect()
}

/// A source on a ship, made ready to sail at the speed that corresponds by Froude's law.
fn carried(zoo: &Zoo, source: &Model, target: &Vessel) -> Result<Model, String> {
    let law = zoo.law(&source.law).unwrap();
    let lpp_m = |particulars| sistership_model::particulars::particular_value(particulars, "lpp_m");
    let ratio = lpp_m(&target.particulars).unwrap() / lpp_m(&source.particulars).unwrap();
    let speed_m_s = source.speed_m_s.unwrap_or(1.0) * ratio.sqrt();
    let model = transfer_model(source, law, target, Some(TrialApproach { speed_m_s, n_rps: None }));
    Ship::new(&model, law).map(|_| model).map_err(|error| error.to_string())
}

/// What goes wrong without some particulars that goes right with them.
fn faults(zoo: &Zoo, sources: &[Model], vessel: &Arc<Vessel>, names: &[&str]) -> Vec<String> {
    let reduced = without(vessel, names);
    let one = |source: &Model| {
        let whole = carried(zoo, source, vessel).ok()?;
        let found = match carried(zoo, source, &reduced) {
            Err(error) => error,
            Ok(model) => unnamed(zoo, &whole, &model, names)?,
        };
        Some(format!("{} without {names:?} by {}: {found}", vessel.name(), source.name))
    };
    sources.par_iter().filter_map(one).collect()
}

/// A particular that the law asks for, that is not stated, and that is not named with a band.
fn unnamed(zoo: &Zoo, whole: &Model, model: &Model, names: &[&str]) -> Option<String> {
    let estimated = estimated_particulars(&model.particulars);
    // What follows from others that the ship states is no estimate.
    if names.iter().any(|name| is_implied(model, name)) {
        return None;
    }
    let law = zoo.law(&whole.law).unwrap();
    let changed = law.parameters.keys().find(|name| {
        let value = |model: &Model| model.parameters.get(*name).map(|one| one.value);
        value(whole) != value(model)
    });
    if changed.is_some() && estimated.is_empty() {
        return Some(format!("{changed:?} changed and nothing is said to be estimated"));
    }
    let bandless = estimated.iter().find(|one| names.contains(&&*one.name) && one.band.is_none());
    bandless.map(|one| format!("{} has no band", one.name))
}

fn is_implied(model: &Model, name: &str) -> bool {
    let estimated = estimated_particulars(&model.particulars);
    let mut stated = model.particulars.clone();
    estimated.iter().for_each(|one| drop(stated.remove(&one.name)));
    sistership_model::particulars::stated_value(&stated, name).is_some()
}

#[test]
fn a_ship_without_an_optional_particular_still_takes_every_source() {
    let zoo = Zoo::load_embedded().unwrap();
    let sources = sources(&zoo);
    let vessels: Vec<&Arc<Vessel>> = zoo.vessels().collect();
    let singles = |vessel: &&Arc<Vessel>| -> Vec<String> {
        let names = optional(vessel).into_iter();
        names.flat_map(|name| faults(&zoo, &sources, vessel, &[name])).collect()
    };
    let found: Vec<String> = vessels.iter().flat_map(singles).collect();
    assert!(found.is_empty(), "{} faults:\n{}", found.len(), found.join("\n"));
}

#[test]
fn pairs_of_particulars_may_be_absent_as_well() {
    let zoo = Zoo::load_embedded().unwrap();
    let sources = sources(&zoo);
    let mut random = ChaCha12Rng::seed_from_u64(50);
    let vessels: Vec<&Arc<Vessel>> = zoo.vessels().collect();
    let mut found = Vec::new();
    for _ in 0..60 {
        let vessel = vessels[random.random_range(0..vessels.len())];
        let pair = optional(vessel).into_iter().sample(&mut random, 2);
        found.extend(faults(&zoo, &sources, vessel, &pair));
    }
    assert!(found.is_empty(), "{} faults:\n{}", found.len(), found.join("\n"));
}

#[test]
fn a_ferry_without_its_centre_of_gravity_takes_no_other_ship_s() {
    let zoo = Zoo::load_embedded().unwrap();
    let (tanker, kcs) = (zoo.find_model("kvlcc2").unwrap(), zoo.vessel("kcs").unwrap());
    let reduced = without(kcs, &["x_g_m"]);
    let model = carried(&zoo, &tanker, &reduced).unwrap();
    let named = estimated_particulars(&model.particulars);
    let x_g = named.iter().find(|one| one.name == "x_g_m").unwrap();
    let [low, high] = x_g.band.unwrap();
    let own = kcs.particular("x_g_m").unwrap();
    assert!((low..high).contains(&own), "{own} is not in {x_g:?}");
    assert!((model.parameters["x_G"].value - x_g.value).abs() < 1e-9);
    let alone = complete_for_law(zoo.law("mmg").unwrap(), &reduced, None);
    assert_eq!(alone["x_g_m"].source, "estimated: zoo-medians");
}
