//! How far a source carried over, and an estimate, are from a ship's own accelerations: what the
//! mixture's weights are learned from.

use sistership_model::{Model, Vessel, Zoo};
use sistership_priors::estimates::{LAW, RegressionLibrary, estimate_ship};
use sistership_priors::transfer::transfer_model;
use sistership_simulation::Ship;
use sistership_simulation::manoeuvre::{
    ManoeuvreSettings, STANDARD_MANOEUVRES, simulate_manoeuvre_batch,
};
use sistership_simulation::plant::PlantWorkspace;
use sistership_simulation::state::{StateVector, at};

use crate::ships::{bare, is_for_work, kin, likeness};
use crate::statistics::{mean, median};

/// Axes by their place in the state.
const AXES: [(&str, usize); 3] = [("X", at::U), ("Y", at::V), ("N", at::R)];
/// The measure by which the source is chosen, within the category: the largest difference of
/// Kanazawa's vector, as eligibility has it.
const MEASURE: usize = 3;
/// From one state that is compared to the next, samples.
const EVERY: usize = 10;

/// Errors of both by axis, by the mean square of the truth: of the source, of the estimate, common.
pub struct Errors(pub [[f64; 3]; 3]);

/// Prints the errors of every ship, and their medians over those for work and for judgement.
pub fn run() {
    let (zoo, library) =
        (Zoo::load_embedded().unwrap(), RegressionLibrary::parse_embedded().unwrap());
    println!(
        "| ship | for | source | X: source | estimate | common | Y: source | estimate | common | \
         N: source | estimate | common |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |");
    let mut all = [Vec::new(), Vec::new()];
    for vessel in zoo.vessels().filter(|vessel| !vessel.file.models.is_empty()) {
        let Some((source, errors)) = of_ship(&zoo, &library, vessel) else { continue };
        let is_work = is_for_work(vessel.name());
        let place = if is_work { "work" } else { "judgement" };
        println!("| `{}` | {place} | `{source}` | {} |", vessel.name(), cells(&errors.0));
        all[usize::from(!is_work)].push(errors);
    }
    for (name, errors) in ["work", "judgement"].into_iter().zip(&all) {
        for (what, of) in [("median", median as fn(&[f64]) -> f64), ("mean", mean)] {
            let figure = |axis: usize, k: usize| {
                of(&errors.iter().map(|one| one.0[axis][k]).collect::<Vec<_>>())
            };
            let figures = std::array::from_fn(|axis| std::array::from_fn(|k| figure(axis, k)));
            println!("| {what} of {} | {name} | | {} |", errors.len(), cells(&figures));
        }
    }
}

fn cells(errors: &[[f64; 3]; 3]) -> String {
    errors.iter().flatten().map(|value| format!("{value:.3}")).collect::<Vec<_>>().join(" | ")
}

fn of_ship(zoo: &Zoo, library: &RegressionLibrary, vessel: &Vessel) -> Option<(String, Errors)> {
    let model = zoo.published_model(vessel, None).ok()?;
    let bare = bare(vessel, &model);
    let source = most_alike(zoo, vessel)?;
    let estimated = estimate_ship(library, &bare, zoo.law(LAW)?, model.speed_m_s?).ok()?;
    let carried = transfer_model(&source, zoo.law(&source.law)?, &bare, None);
    let ship = |model: &Model| Ship::new(model, zoo.law(&model.law)?).ok();
    let errors = errors(&ship(&model)?, &ship(&carried)?, &ship(&estimated.model)?)?;
    Some((source.ship, errors))
}

fn most_alike(zoo: &Zoo, target: &Vessel) -> Option<Model> {
    let others = zoo.vessels().filter(|vessel| {
        !kin(vessel.name(), target.name())
            && sistership_model::categories::are_comparable(
                &vessel.file.category,
                &target.file.category,
            )
    });
    let known = others.filter_map(|vessel| {
        let model = zoo.published_model(vessel, None).ok()?;
        Some((likeness(target, vessel)[MEASURE]?, model))
    });
    known.max_by(|(a, _), (b, _)| a.total_cmp(b)).map(|(_, model)| model)
}

/// Over the ship's own standard manoeuvres; each asked at its own revolutions of straight running.
fn errors(truth: &Ship, source: &Ship, estimate: &Ship) -> Option<Errors> {
    let manoeuvres = STANDARD_MANOEUVRES.map(|manoeuvre| (manoeuvre, &[][..]));
    let sailed = simulate_manoeuvre_batch(truth, &manoeuvres, &ManoeuvreSettings::default());
    let states: Vec<StateVector> = sailed
        .into_iter()
        .flatten()
        .flat_map(|sailed| sailed.track.states.into_iter().step_by(EVERY))
        .collect();
    let [own, source, estimate] = [truth, source, estimate].map(|ship| rates(ship, truth, &states));
    let one = |axis: usize| {
        let product = |a: &[StateVector], b: &[StateVector]| {
            let error = |said: &StateVector, k: usize| said[axis] - own[k][axis];
            (0..own.len()).map(|k| error(&a[k], k) * error(&b[k], k)).sum::<f64>()
        };
        let all = own.iter().map(|rate| rate[axis].powi(2)).sum::<f64>();
        [product(&source, &source), product(&estimate, &estimate), product(&source, &estimate)]
            .map(|sum| sum / all)
    };
    let errors = Errors(AXES.map(|(_, axis)| one(axis)));
    errors.0.iter().flatten().all(|value| value.is_finite()).then_some(errors)
}

fn rates(ship: &Ship, truth: &Ship, states: &[StateVector]) -> Vec<StateVector> {
    let n_rps = ship.revolutions_at(truth.approach_speed_m_s());
    let mut work = PlantWorkspace::default();
    let rate = |state: &StateVector| {
        ship.rate_with(state, &ship.inputs_for(state[at::DELTA], n_rps), &mut work)
    };
    states.iter().map(rate).collect()
}
