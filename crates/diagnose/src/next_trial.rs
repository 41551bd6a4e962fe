//! The trial that would tell apart what these cannot: each of a set of manoeuvres is sailed with the model and what was
//! found, and what it would add to the evidence is computed before anybody sails it.

use rayon::prelude::*;
use sistership_dynamics::manoeuvre::{ManoeuvreSettings, turn, zigzag};
use sistership_dynamics::state::{RECORDED, at};
use sistership_dynamics::{Ship, Trajectory};
use sistership_model::Trial;
use sistership_model::trial::Channel;

use super::base::Base;
use super::confounded::Responses;
use super::outcome::{Found, NextTrial};
use super::search::{Judged, Search};
use crate::residual::{Gram, filter};

/// What can be sailed: name, rudder, switch (none for a turn), deg.
const MANOEUVRES: [(&str, f64, Option<f64>); 4] = [
    ("zigzag 10/10", 10.0, Some(10.0)),
    ("zigzag 20/20", 20.0, Some(20.0)),
    ("turning circle 15", 15.0, None),
    ("turning circle 35", 35.0, None),
];
/// Approach speeds by that of the trials.
const SPEEDS: [f64; 2] = [1.0, 0.6];
/// Headings, deg.
const HEADINGS_DEG: [f64; 3] = [0.0, 90.0, 180.0];
/// Duration in the times in which the ship sails her length at the speed of the trials.
const DURATION: f64 = 25.0;

/// One that could be sailed.
#[derive(Clone, Copy)]
struct Planned {
    manoeuvre: (&'static str, f64, Option<f64>),
    speed_m_s: f64,
    heading_deg: f64,
}

/// The trial that separates an effect found from those beside it best; none where nothing is to be separated.
pub(super) fn next_trial(search: &Search<'_>, base: &Base<'_>, judged: &Judged, found: &[Found]) -> Option<NextTrial> {
    let doubtful = found.iter().filter(|found| !found.confounded_with.is_empty());
    let doubtful = doubtful.min_by(|a, b| a.confounded_with[0].angle_deg.total_cmp(&b.confounded_with[0].angle_deg))?;
    let place = judged.candidates.iter().position(|candidate| candidate.effect == doubtful.name)?;
    let ship = ship(search, judged)?;
    let gain = |planned: &Planned| Some((separated(search, base, judged, place, doubtful, &ship, planned)?, *planned));
    let gains: Vec<(f64, Planned)> = plans(base).par_iter().filter_map(gain).collect();
    let (expected, best) = gains.into_iter().max_by(|a, b| a.0.total_cmp(&b.0))?;
    let others = doubtful.confounded_with.iter().map(|other| other.name.clone());
    Some(NextTrial {
        manoeuvre: best.manoeuvre.0.to_owned(),
        speed_m_s: (10.0 * best.speed_m_s).round() / 10.0,
        heading_deg: best.heading_deg,
        separates: std::iter::once(doubtful.name.clone()).chain(others).collect(),
        expected,
    })
}

fn plans(base: &Base<'_>) -> Vec<Planned> {
    let approach = base.workspace.speed_m_s;
    let of =
        |manoeuvre, share: f64| HEADINGS_DEG.map(|heading_deg| Planned { manoeuvre, speed_m_s: share * approach, heading_deg });
    MANOEUVRES.iter().flat_map(|&m| SPEEDS.into_iter().flat_map(move |share| of(m, share))).collect()
}

fn ship(search: &Search<'_>, judged: &Judged) -> Option<Ship> {
    Ship::new(&search.model_with(&judged.candidates, None), search.law).ok()
}

/// The evidence by which the nearest of the others would be behind after a planned trial.
fn separated(
    search: &Search<'_>,
    base: &Base<'_>,
    judged: &Judged,
    place: usize,
    doubtful: &Found,
    ship: &Ship,
    planned: &Planned,
) -> Option<f64> {
    let trial = sailed(base, ship, planned)?;
    let gram = filtered(search, base, judged, &trial)?;
    let mut total = base.total(judged.level.min(base.levels.len() - 1));
    total.add(&gram);
    let responses = Responses::new(search, base, judged, &total)?;
    let names: Vec<&str> = doubtful.confounded_with.iter().map(|other| other.name.as_str()).collect();
    responses.behind(place, &names)
}

/// A trial as it would be recorded, without noise.
fn sailed(base: &Base<'_>, ship: &Ship, planned: &Planned) -> Option<Trial> {
    let workspace = &base.workspace;
    let settings = ManoeuvreSettings {
        speed_m_s: Some(planned.speed_m_s),
        duration_s: Some(DURATION * workspace.lpp_m / workspace.speed_m_s),
        run_in_s: 2.0 * workspace.lpp_m / workspace.speed_m_s,
        ..ManoeuvreSettings::default()
    };
    let (_, rudder, switch) = planned.manoeuvre;
    let track = match switch {
        Some(switch) => zigzag(ship, rudder, switch, &settings).ok()?.track,
        None => turn(ship, rudder, &settings).ok()?.track,
    };
    let model = workspace.trials.first()?;
    Some(recorded(&track, model, planned.heading_deg.to_radians()))
}

/// With the channels and the interval of a trial that was sailed; the wind and the like as they were in its middle.
fn recorded(track: &Trajectory, like: &Trial, heading_rad: f64) -> Trial {
    let step_s = track.t_s.get(1).copied().unwrap_or(1.0);
    let stride = (like.interval_s() / step_s).round().max(1.0) as usize;
    let every = |values: Vec<f64>| values.into_iter().step_by(stride).collect::<Vec<f64>>();
    let (sin, cos) = heading_rad.sin_cos();
    let (x, y) = (track.column(at::X), track.column(at::Y));
    let turned = |channel: Channel, index: usize| match channel {
        Channel::X => x.iter().zip(&y).map(|(x, y)| x * cos - y * sin).collect(),
        Channel::Y => x.iter().zip(&y).map(|(x, y)| x * sin + y * cos).collect(),
        Channel::Psi => track.column(index).into_iter().map(|psi| psi + heading_rad).collect(),
        _ => track.column(index),
    };
    let mut trial = Trial { name: "planned".into(), velocity: like.velocity, depth_m: like.depth_m, ..Trial::default() };
    trial.t_s = every(track.t_s.clone());
    let count = trial.t_s.len();
    for (&channel, values) in &like.channels {
        let constant = values.get(values.len() / 2).copied().unwrap_or_default();
        trial.channels.insert(channel, vec![constant; count]);
    }
    for &(channel, index) in RECORDED.iter().filter(|(channel, _)| like.channel(*channel).is_some()) {
        trial.channels.insert(channel, every(turned(channel, index)));
    }
    trial.channels.insert(Channel::Delta, every(track.column(at::DELTA)));
    if like.channel(Channel::N).is_some() {
        trial.channels.insert(Channel::N, every(track.n_rps.clone()));
    }
    trial
}

/// The products of all columns of a base over a planned trial.
fn filtered(search: &Search<'_>, base: &Base<'_>, judged: &Judged, trial: &Trial) -> Option<Gram> {
    let columns = base.workspace.columns().clone();
    let trials = [trial];
    let workspace = super::workspace::Workspace::new(&search.learned, columns, &trials, search.least_step_s).ok()?;
    let discrepancies = base.levels[judged.level.min(base.levels.len() - 1)].discrepancies();
    let width = 1 + workspace.columns().len();
    let parts = workspace.linear().iter().flatten();
    let grams: Vec<Gram> = parts.map(|part| filter(part, &base.workspace.noise, discrepancies)).collect();
    Some(Gram::sum(&grams, width))
}
