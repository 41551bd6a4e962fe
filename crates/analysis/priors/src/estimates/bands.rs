//! Uncertainty bands of the standard manoeuvres of an estimate.

use rayon::prelude::*;
use serde::Serialize;
use sistership_assessment::uncertainty::{UncertaintyBand, bands_over};
use sistership_model::Model;
use sistership_model::law::Law;
use sistership_simulation::manoeuvre::{
    Manoeuvre, ManoeuvreSettings, SimulatedManoeuvre, StandardManoeuvres, TurningCircle,
    ZigzagTest, simulate_manoeuvre_batch,
};
use sistership_simulation::metrics::{imo_criteria, initial_turning_distance};
use sistership_simulation::{Ship, SimulationStop};

use crate::estimates::draws::DeviationDraws;
use crate::estimates::estimate::ShipEstimate;
use crate::estimates::limits;

/// Number of sets of parameters and particulars that are drawn; each is a ship of its own.
const SHIPS: usize = 8;
/// Number of sets of coefficients that are drawn for each ship; they are simulated in lockstep.
const SISTERS: usize = 8;
/// Time step, by the time in which the ship covers its length: draws need no finer one.
const STEP_LENGTHS: f64 = 0.1;
/// Duration of a hard turn, ship lengths: beyond half a circle until it is steady.
const TURN_LENGTHS: f64 = 25.0;
/// Longest time until the first 10 deg of heading change, ship lengths.
const INITIAL_LENGTHS: f64 = 6.0;
const HARD_DEG: f64 = 35.0;
const INITIAL_DEG: f64 = 10.0;
const ZIGZAGS_DEG: [f64; 2] = [10.0, 20.0];

/// Manoeuvres of the estimate, and the uncertainty bands about them. All to starboard: an estimate
/// is the same on both sides.
#[derive(Debug, Clone, Serialize)]
pub struct EstimateBands {
    /// Manoeuvres by the means.
    pub manoeuvres: StandardManoeuvres,
    /// Number of models that were drawn.
    pub draws: usize,
    /// Number of models that left the physical range in some manoeuvre.
    pub failed: usize,
    /// Band of each figure: 95 % of the draws that reached it are inside.
    pub figures: Vec<UncertaintyBand>,
}

/// Simulates the standard manoeuvres by the estimate and by draws around it; the same seed gives
/// the same bands. Returns none where the law does not fit.
pub fn estimate_bands(estimate: &ShipEstimate, law: &Law, seed: u64) -> Option<EstimateBands> {
    let lots = draw_models(estimate, seed);
    let sailed: Vec<Vec<StandardManoeuvres>> =
        lots.par_iter().map(|lot| simulate_standard(lot, law)).collect::<Option<_>>()?;
    let mut sailed = sailed.into_iter();
    // The first group is the estimate itself, the others are draws.
    let own = sailed.next()?.into_iter().next()?;
    let drawn: Vec<StandardManoeuvres> = sailed.flatten().collect();
    Some(EstimateBands {
        manoeuvres: own,
        draws: drawn.len(),
        failed: drawn.iter().filter(|one| !one.failures.is_empty()).count(),
        figures: bands_over(drawn),
    })
}

/// Groups of models that differ in their coefficients alone; the first group is the estimate.
fn draw_models(estimate: &ShipEstimate, seed: u64) -> Vec<Vec<Model>> {
    let mut around = DeviationDraws::new(&estimate.around_covariance, seed);
    // Two independent streams from one seed.
    let mut coefficients =
        DeviationDraws::new(&estimate.coefficients_covariance, seed ^ 0x9e37_79b9);
    let mut lots = vec![vec![estimate.model.clone()]];
    for _ in 0..SHIPS {
        let moved: Vec<f64> = estimate
            .around
            .iter()
            .zip(around.next_deviations())
            .map(|(one, by)| limits::clamp_parameter(&one.name, one.mean + by))
            .collect();
        let ship = estimate.with_values(&within_particulars(estimate, &moved));
        // A drawn ship whose propeller cannot balance the resistance is omitted.
        let Ok(ship) = estimate.balance_thrust(ship) else { continue };
        let sister = |_| draw_coefficients(estimate, &ship, &coefficients.next_deviations());
        lots.push((0..SISTERS).map(sister).collect());
    }
    lots
}

/// Limits drawn particulars: no change of sign, and no more than twice the mean.
fn within_particulars(estimate: &ShipEstimate, moved: &[f64]) -> Vec<f64> {
    let one = |(one, value): (&crate::estimates::combined::CombinedEstimate, &f64)| {
        if one.name.ends_with("_m") && one.name != "x_g_m"
            || one.name.ends_with("_m2")
            || one.name.ends_with("_ratio")
            || one.name == "f_alpha"
        {
            value.clamp(0.5 * one.mean, 2.0 * one.mean)
        } else {
            *value
        }
    };
    estimate.around.iter().zip(moved).map(one).collect()
}

fn draw_coefficients(estimate: &ShipEstimate, ship: &Model, moved: &[f64]) -> Model {
    let mut model = Model { posterior: None, ..ship.clone() };
    for (one, by) in estimate.coefficients.iter().zip(moved) {
        if let Some(quantity) = model.coefficients.get_mut(&one.name) {
            quantity.value = limits::limit_coefficient(&one.name, one.mean + by, one.mean);
        }
    }
    model
}

fn simulate_standard(lot: &[Model], law: &Law) -> Option<Vec<StandardManoeuvres>> {
    let ship = Ship::with_open_coefficients(lot.first()?, law).ok()?;
    let sisters: Vec<Vec<f64>> =
        lot.iter().map(|model| ship.open_coefficient_values(model)).collect::<Option<_>>()?;
    let mut all = vec![StandardManoeuvres::default(); lot.len()];
    let turn = Manoeuvre::Turn { rudder: HARD_DEG };
    for (one, sailed) in all.iter_mut().zip(run(&ship, &sisters, &[turn], Some(TURN_LENGTHS))) {
        let turn = sailed.and_then(|sailed| TurningCircle::from_manoeuvre(sailed, HARD_DEG));
        record_outcome(one, turn.map(|turn| turn.metrics), turn_name, |all, turn| {
            all.turns.push(turn)
        });
    }
    // Both angles at once: simulations that end early give their lanes to others.
    let zigzag = |angle: f64| Manoeuvre::Zigzag { rudder: angle, switch: angle };
    let mut zigzags = run(&ship, &sisters, &ZIGZAGS_DEG.map(zigzag), None).into_iter();
    for angle in ZIGZAGS_DEG {
        for (one, sailed) in all.iter_mut().zip(zigzags.by_ref()) {
            let zigzag = sailed.and_then(|sailed| ZigzagTest::from_manoeuvre(sailed, angle, angle));
            let name = || zigzag_name(angle);
            record_outcome(one, zigzag.map(|zigzag| zigzag.metrics), name, |all, zigzag| {
                all.zigzags.push(zigzag);
            });
        }
    }
    // The initial turning ability needs a turn of its own, with a small rudder angle.
    let initial = Manoeuvre::Turn { rudder: INITIAL_DEG };
    for (one, sailed) in all.iter_mut().zip(run(&ship, &sisters, &[initial], Some(INITIAL_LENGTHS)))
    {
        one.initial_turning_m = sailed
            .ok()
            .and_then(|sailed| initial_turning_distance(&sailed.after, INITIAL_DEG, INITIAL_DEG));
    }
    // The criteria combine figures of several manoeuvres.
    for one in &mut all {
        let speed = ship.approach_speed_m_s();
        one.imo =
            imo_criteria(ship.lpp_m(), speed, &one.turns, &one.zigzags, one.initial_turning_m);
    }
    Some(all)
}

fn turn_name() -> String {
    Manoeuvre::Turn { rudder: HARD_DEG }.to_string()
}

fn zigzag_name(angle: f64) -> String {
    Manoeuvre::Zigzag { rudder: angle, switch: angle }.to_string()
}

/// Simulates manoeuvres one after the other, each by every sister; for the given number of lengths,
/// or until the manoeuvre is complete.
fn run(
    ship: &Ship,
    sisters: &[Vec<f64>],
    manoeuvres: &[Manoeuvre],
    lengths: Option<f64>,
) -> Vec<Result<SimulatedManoeuvre, SimulationStop>> {
    let length_s = ship.lpp_m() / ship.approach_speed_m_s();
    let settings = ManoeuvreSettings {
        step_s: Some(STEP_LENGTHS * length_s),
        duration_s: lengths.map(|lengths| lengths * length_s),
        reversals_within_steps: true,
        ..ManoeuvreSettings::default()
    };
    let by_all = |manoeuvre: &Manoeuvre| {
        let manoeuvre = *manoeuvre;
        sisters.iter().map(move |sister| (manoeuvre, sister.as_slice()))
    };
    let all: Vec<(Manoeuvre, &[f64])> = manoeuvres.iter().flat_map(by_all).collect();
    simulate_manoeuvre_batch(ship, &all, &settings)
}

fn record_outcome<T>(
    all: &mut StandardManoeuvres,
    sailed: Result<T, SimulationStop>,
    name: impl Fn() -> String,
    keep: impl Fn(&mut StandardManoeuvres, T),
) {
    match sailed {
        Ok(metrics) => keep(all, metrics),
        Err(stopped) => all.failures.push(format!("{}: {stopped}", name())),
    }
}
