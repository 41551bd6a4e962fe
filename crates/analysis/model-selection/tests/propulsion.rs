//! What the search takes of trials at constant revolutions comes to rest, stops and goes astern.
//! `--ignored` asks it of every ship of the zoo and prints a table (docs/evidence/propulsion.md).
#![allow(clippy::unwrap_used)]

use std::collections::BTreeMap;

use sistership_identification::refine::{
    EstimationMethod as Estimator, RefinementSettings, RefinementSpec, refine,
};
use sistership_identification::testing::{
    mariner_model, simulated_trials, with_scaled_coefficients,
};
use sistership_model::quantity::Quantity;
use sistership_model::trial::{Channel, Trial};
use sistership_model::{Model, Vessel, Zoo};
use sistership_model_selection::{Preference, StartRequest, StartSelection, best_start};
use sistership_propulsion::{PropulsionFault, check_straight};
use sistership_simulation::manoeuvre::{ManoeuvreSettings, simulate_turn, simulate_zigzag};
use sistership_simulation::state::{RECORDED_CHANNELS, Trajectory, at, straight_state};
use sistership_simulation::{HelmOrder, Method, RunSettings, Ship};

/// Revolutions of ships whose law takes none, 1/s.
const REVOLUTIONS: f64 = 1.5;
/// How long a propeller is stopped or reversed, by the time in which the ship sails its length.
const LENGTHS: f64 = 60.0;

/// A ship with trials of its own law, noise of a hundredth in them.
struct Stranger {
    vessel: Vessel,
    trials: Vec<Trial>,
    /// The ship itself, where its law has a propeller.
    truth: Option<Ship>,
}

fn stranger(zoo: &Zoo, vessel: &Vessel) -> Option<Stranger> {
    let model = zoo.published_model(vessel, None).ok()?;
    let ship = Ship::new(&model, zoo.law(&model.law)?).ok()?;
    let length_s = ship.lpp_m() / ship.approach_speed_m_s();
    let settings = ManoeuvreSettings {
        step_s: Some(0.05 * length_s),
        duration_s: Some(25.0 * length_s),
        ..ManoeuvreSettings::default()
    };
    let tracks = [
        simulate_zigzag(&ship, 20.0, 20.0, &settings).ok()?.track,
        simulate_zigzag(&ship, -10.0, 10.0, &settings).ok()?.track,
        simulate_turn(&ship, 35.0, &settings).ok()?.track,
        simulate_turn(&ship, -20.0, &settings).ok()?.track,
    ];
    let n_rps = model.revolutions_rps.unwrap_or(REVOLUTIONS);
    let trials = tracks.iter().enumerate().map(|(k, track)| recorded(track, k, n_rps)).collect();
    let vessel = bare(vessel, &model);
    Some(Stranger { vessel, trials, truth: ship.has_propeller().then_some(ship) })
}

fn recorded(track: &Trajectory, index: usize, n_rps: f64) -> Trial {
    let column = |place: usize| -> Vec<f64> {
        let size = track.states.iter().map(|state| state[place].abs()).fold(0.0, f64::max);
        let shake = |k: usize| (12.9898 * (k + 977 * place + 31 * index) as f64).sin();
        track.states.iter().enumerate().map(|(k, s)| s[place] + 0.01 * size * shake(k)).collect()
    };
    let mut channels: BTreeMap<Channel, Vec<f64>> =
        RECORDED_CHANNELS[..6].iter().map(|&(channel, place)| (channel, column(place))).collect();
    channels.insert(Channel::Delta, track.state_column(at::DELTA));
    channels.insert(Channel::N, vec![n_rps; track.t_s.len()]);
    Trial { name: format!("trial {index}"), t_s: track.t_s.clone(), channels, ..Trial::default() }
}

/// The ship without models of its own.
fn bare(vessel: &Vessel, model: &Model) -> Vessel {
    let mut bare = vessel.clone();
    bare.file.models = Vec::new();
    bare.file.free_running = Vec::new();
    if let Some(speed) = model.speed_m_s {
        bare.particulars.insert("service_speed_m_s".into(), Quantity::new(speed, "model"));
    }
    bare
}

fn found(zoo: &Zoo, stranger: &Stranger) -> Result<StartSelection, String> {
    let trials: Vec<&Trial> = stranger.trials.iter().collect();
    let (champions, settings) = (BTreeMap::new(), RefinementSettings::default());
    let target = &stranger.vessel;
    let asked = StartRequest {
        zoo,
        target,
        champions: &champions,
        trials: &trials,
        settings: &settings,
        preference: Preference::default(),
    };
    best_start(&asked, &|_, _| true).map_err(|error| error.to_string())
}

/// Speed by that of the approach at the end; none where the motion left the physical range.
fn last(ship: &Ship, start: f64, turns: f64) -> Option<f64> {
    let speed = ship.approach_speed_m_s();
    let length_s = ship.lpp_m() / speed;
    let order = HelmOrder { delta_rad: 0.0, n_rps: turns * ship.revolutions_at(speed) };
    let run = RunSettings {
        start: straight_state(start * speed),
        duration_s: LENGTHS * length_s,
        step_s: 0.05 * length_s,
        method: Method::Rk4,
    };
    let mut track = Trajectory::default();
    ship.simulate_orders(run, &mut track, |_, _| Some(order)).ok()?;
    Some(track.states.last()?[at::U] / speed)
}

/// A line of the table; the propeller stopped, reversed, and reversed from rest: without the
/// balance, with it, and by the ship itself.
fn line(stranger: &Stranger, start: &StartSelection) -> String {
    let (model, law) = (&start.refinement.model, &*start.entrant.law);
    let without = Model { propulsion: None, ..model.clone() };
    let ships = [&without, model].map(|model| Ship::new(model, law).unwrap());
    let cell = |(share, turns)| {
        let [before, after] = [&ships[0], &ships[1]].map(|ship| last(ship, share, turns));
        let said = |share: Option<f64>| share.map_or("-".to_owned(), |share| format!("{share:.2}"));
        let truth = stranger.truth.as_ref().and_then(|ship| last(ship, share, turns));
        format!("{}, {}, {}", said(before), said(after), said(truth))
    };
    let cells = [(1.0, 0.0), (1.0, -1.0), (0.0, -1.0)].map(cell).join(" | ");
    let balance = if model.propulsion.is_some() { "yes" } else { "no" };
    let name = stranger.vessel.name();
    format!("| {name} | {} | {balance} | {cells} |", start.entrant.name())
}

fn stops(start: &StartSelection) -> bool {
    let ship = Ship::new(&start.refinement.model, &start.entrant.law).unwrap();
    check_straight(&ship).is_ok()
}

#[test]
fn what_is_taken_of_a_ship_without_revolutions_in_its_law_stops() {
    let zoo = Zoo::load_embedded().unwrap();
    let stranger = stranger(&zoo, zoo.vessel("mariner").unwrap()).unwrap();
    let start = found(&zoo, &stranger).unwrap();
    println!("{}", line(&stranger, &start));
    assert!(stops(&start));
}

#[test]
fn a_named_method_gives_a_law_without_revolutions_a_balance() {
    let (zoo, (model, law)) = (Zoo::load_embedded().unwrap(), mariner_model());
    let trials = simulated_trials(&with_scaled_coefficients(&model, |_| 1.1), &law, 0.001);
    let trials: Vec<&Trial> = trials.iter().collect();
    let settings = RefinementSettings { method: Estimator::Weak, ..RefinementSettings::default() };
    let request = RefinementSpec {
        target: zoo.vessel("mariner").unwrap(),
        source: &model,
        source_law: None,
        law: &law,
        trials: &trials,
        population: &[],
        settings: &settings,
    };
    let made = refine(&request, &|_, _| true).unwrap();
    assert_eq!(check_straight(&Ship::new(&made.model, &law).unwrap()), Ok(()));
    let resistance = &made.model.propulsion.as_ref().unwrap().parameters["resistance"];
    println!("{resistance:?}");
    assert!(resistance.standard_error.unwrap() < 0.4 * resistance.value);
    assert!(
        made.remarks
            .iter()
            .any(|remark| remark.contains("the surge force is open-water thrust minus resistance"))
    );
    assert_eq!(
        check_straight(&Ship::new(&model, &law).unwrap()),
        Err(PropulsionFault::NoRevolutions)
    );
}

#[test]
#[ignore = "minutes"]
fn what_is_taken_of_every_ship_of_the_zoo_stops() {
    let zoo = Zoo::load_embedded().unwrap();
    let mut running = Vec::new();
    for vessel in zoo.vessels() {
        let Some(stranger) = stranger(&zoo, vessel) else { continue };
        match found(&zoo, &stranger) {
            Ok(start) => {
                println!("{}", line(&stranger, &start));
                running.extend((!stops(&start)).then(|| vessel.name().to_owned()));
            }
            Err(error) => println!("| {} | {error} |", vessel.name()),
        }
    }
    assert!(running.is_empty(), "{running:?}");
}
