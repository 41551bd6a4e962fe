//! Standard manoeuvres of the assessment of a ship.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use sistership_model::validity::Excursion;

use super::ManoeuvreSettings;
use super::helm::{INITIAL_DEG, Manoeuvre, SimulatedManoeuvre, simulate_manoeuvre_batch};
use crate::envelope::SimulationStop;
use crate::metrics::{
    ImoCriterion, TurningMetrics, ZigzagMetrics, imo_criteria, initial_turning_distance,
};
use crate::ship::Ship;
use crate::state::Trajectory;

/// Simulated turning circle.
#[derive(Debug, Clone)]
pub struct TurningCircle {
    /// Track.
    pub track: Trajectory,
    /// Metrics.
    pub metrics: TurningMetrics,
}

/// Simulated zigzag.
#[derive(Debug, Clone)]
pub struct ZigzagTest {
    /// Track.
    pub track: Trajectory,
    /// Metrics.
    pub metrics: ZigzagMetrics,
}

/// The metrics of the standard manoeuvres.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct StandardManoeuvres {
    /// Turning circles at 35 deg to both sides.
    pub turns: Vec<TurningMetrics>,
    /// Zigzags 10/10 and 20/20 to both sides.
    pub zigzags: Vec<ZigzagMetrics>,
    /// Distance along the track until the heading has changed by 10 deg with 10 deg of rudder, for
    /// the worse side, m.
    pub initial_turning_m: Option<f64>,
    /// IMO criteria.
    pub imo: Vec<ImoCriterion>,
    /// Manoeuvres that left the physical range, with the reason.
    pub failures: Vec<String>,
    /// Manoeuvres that left the range covered by the model's trials, with the excursion.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub outside: BTreeMap<String, Excursion>,
    /// Mean share of the learned correction over each manoeuvre, 0 to 1; empty for a model without
    /// one.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub branch_share: BTreeMap<String, f64>,
}

impl StandardManoeuvres {
    /// Records how a manoeuvre left the range covered by the model's trials, if it did, and the
    /// mean share of a learned correction.
    pub fn record_excursion(&mut self, name: &str, ship: &Ship, track: &Trajectory) {
        self.outside
            .extend(ship.find_excursion(track).map(|excursion| (name.to_owned(), excursion)));
        self.branch_share
            .extend(ship.mean_correction_share(track).map(|share| (name.to_owned(), share)));
    }
}

impl TurningCircle {
    /// Evaluates a simulated turning circle.
    ///
    /// # Errors
    /// Returns an error if the track ends before the rudder is executed.
    pub fn from_manoeuvre(
        sailed: SimulatedManoeuvre,
        rudder_deg: f64,
    ) -> Result<Self, SimulationStop> {
        let metrics =
            TurningMetrics::from_track(&sailed.after, rudder_deg).ok_or_else(empty_track_error)?;
        Ok(Self { track: sailed.track, metrics })
    }
}

impl ZigzagTest {
    /// Evaluates a simulated zigzag.
    ///
    /// # Errors
    /// Returns an error if the track ends before the rudder is executed.
    pub fn from_manoeuvre(
        sailed: SimulatedManoeuvre,
        rudder_deg: f64,
        switch_deg: f64,
    ) -> Result<Self, SimulationStop> {
        let metrics =
            ZigzagMetrics::from_track(&sailed.after, rudder_deg, switch_deg, &sailed.reversals_s)
                .ok_or_else(empty_track_error)?;
        Ok(Self { track: sailed.track, metrics })
    }
}

fn empty_track_error() -> SimulationStop {
    SimulationStop { t_s: 0.0, reason: "no manoeuvre was simulated".into() }
}

/// The standard manoeuvres: hard turns, zigzags, and turns with 10 deg of rudder for the initial
/// turning ability.
pub const STANDARD_MANOEUVRES: [Manoeuvre; 8] = [
    Manoeuvre::Turn { rudder: 35.0 },
    Manoeuvre::Turn { rudder: -35.0 },
    Manoeuvre::Zigzag { rudder: 10.0, switch: 10.0 },
    Manoeuvre::Zigzag { rudder: -10.0, switch: 10.0 },
    Manoeuvre::Zigzag { rudder: 20.0, switch: 20.0 },
    Manoeuvre::Zigzag { rudder: -20.0, switch: 20.0 },
    Manoeuvre::Turn { rudder: INITIAL_DEG },
    Manoeuvre::Turn { rudder: -INITIAL_DEG },
];

/// Simulates the standard manoeuvres; one that diverges is reported, and the others continue.
pub fn simulate_standard_manoeuvres(
    ship: &Ship,
    settings: &ManoeuvreSettings,
) -> StandardManoeuvres {
    simulate_standard_ensemble(ship, &[&[]], settings).remove(0)
}

/// Simulates the standard manoeuvres as [`standard`] does, and also returns the tracks in the order
/// of [`STANDARD`]; `None` for one that diverged.
pub fn simulate_standard_with_tracks(
    ship: &Ship,
    settings: &ManoeuvreSettings,
) -> (StandardManoeuvres, Vec<Option<Trajectory>>) {
    let sailed = simulate_manoeuvre_batch(
        ship,
        &STANDARD_MANOEUVRES.map(|manoeuvre| (manoeuvre, &[][..])),
        settings,
    );
    let tracks = sailed.iter().map(|sailed| Some(sailed.as_ref().ok()?.track.clone())).collect();
    (collect_metrics(ship, settings, sailed.into_iter()), tracks)
}

/// Simulates the standard manoeuvres in lockstep for several ships that differ in their
/// coefficients alone, each as [`standard`] would.
pub fn simulate_standard_ensemble(
    ship: &Ship,
    sisters: &[&[f64]],
    settings: &ManoeuvreSettings,
) -> Vec<StandardManoeuvres> {
    let manoeuvres: Vec<(Manoeuvre, &[f64])> = sisters
        .iter()
        .flat_map(|coefficients| STANDARD_MANOEUVRES.map(|manoeuvre| (manoeuvre, *coefficients)))
        .collect();
    let mut sailed = simulate_manoeuvre_batch(ship, &manoeuvres, settings).into_iter();
    sisters
        .iter()
        .map(|_| collect_metrics(ship, settings, sailed.by_ref().take(STANDARD_MANOEUVRES.len())))
        .collect()
}

/// Metrics of one ship's standard manoeuvres.
fn collect_metrics(
    ship: &Ship,
    settings: &ManoeuvreSettings,
    sailed: impl Iterator<Item = Result<SimulatedManoeuvre, SimulationStop>>,
) -> StandardManoeuvres {
    let mut all = StandardManoeuvres::default();
    let mut initial = Vec::new();
    for (manoeuvre, sailed) in STANDARD_MANOEUVRES.into_iter().zip(sailed) {
        match manoeuvre {
            Manoeuvre::Turn { rudder } => {
                let turn = sailed.and_then(|sailed| TurningCircle::from_manoeuvre(sailed, rudder));
                let turn =
                    record_result(ship, turn, &manoeuvre.to_string(), &mut all, |turn| &turn.track);
                // Turns with 10 deg of rudder serve the initial turning ability only.
                match turn {
                    Some(turn) if rudder.abs() == INITIAL_DEG => {
                        initial.push(initial_turning_distance(&turn.track, rudder, INITIAL_DEG));
                    }
                    turn => all.turns.extend(turn.map(|turn| turn.metrics)),
                }
            }
            Manoeuvre::Zigzag { rudder, switch } => {
                let zigzag =
                    sailed.and_then(|sailed| ZigzagTest::from_manoeuvre(sailed, rudder, switch));
                let zigzag =
                    record_result(ship, zigzag, &manoeuvre.to_string(), &mut all, |zigzag| {
                        &zigzag.track
                    });
                all.zigzags.extend(zigzag.map(|zigzag| zigzag.metrics));
            }
        }
    }
    // Both sides must reach the change of heading; the worse side counts.
    let both: Option<Vec<f64>> = initial.into_iter().collect();
    all.initial_turning_m = both.and_then(|both| both.into_iter().reduce(f64::max));
    let speed = settings.speed_m_s.unwrap_or(ship.approach_speed_m_s());
    all.imo = imo_criteria(ship.lpp_m(), speed, &all.turns, &all.zigzags, all.initial_turning_m);
    all
}

/// Returns a simulated manoeuvre after recording its excursion; records the failure of one that
/// stopped.
fn record_result<T>(
    ship: &Ship,
    sailed: Result<T, SimulationStop>,
    name: &str,
    all: &mut StandardManoeuvres,
    track: impl Fn(&T) -> &Trajectory,
) -> Option<T> {
    match sailed {
        Ok(result) => {
            all.record_excursion(name, ship, track(&result));
            Some(result)
        }
        Err(stopped) => {
            all.failures.push(format!("{name}: {stopped}"));
            None
        }
    }
}
