//! Manoeuvre metrics of a recorded trial: the kind of manoeuvre follows from its name, the times of
//! the reversals from the recorded rudder.

use serde::{Deserialize, Serialize};
use sistership_model::trial::{Channel, Trial};

use super::{TurningMetrics, ZigzagMetrics};
use crate::state::{RECORDED_CHANNELS, StateVector, Trajectory};

/// Metrics of one manoeuvre.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ManoeuvreMetrics {
    /// Metrics of a turning circle.
    Turn(TurningMetrics),
    /// Metrics of a zigzag.
    Zigzag(ZigzagMetrics),
}

/// Manoeuvre of a trial: its kind, its first sample, and the times of the reversals of the rudder.
#[derive(Debug, Clone, PartialEq)]
pub struct ManoeuvreRecognition {
    kind: ManoeuvreKind,
    start: usize,
    reversals_s: Vec<f64>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum ManoeuvreKind {
    Turn { rudder_deg: f64 },
    Zigzag { rudder_deg: f64, switch_deg: f64 },
}

impl ManoeuvreRecognition {
    /// Recognises `turn ...` or `zigzag R/H` in the trial's manoeuvre; `None` for anything else, or
    /// if the rudder never moves.
    pub fn from_trial(trial: &Trial) -> Option<Self> {
        let name = trial.manoeuvre.as_deref()?.to_lowercase();
        let delta = trial.channel(Channel::Delta)?;
        let start = execution_sample(delta)?;
        if name.starts_with("turn") {
            // The median of the second half is robust against the time in which the rudder moves.
            let rudder_deg = median(&delta[start + (delta.len() - start) / 2..])?.to_degrees();
            return Some(Self {
                kind: ManoeuvreKind::Turn { rudder_deg },
                start,
                reversals_s: Vec::new(),
            });
        }
        let (rudder, switch) = name.strip_prefix("zigzag")?.trim().split_once('/')?;
        let angle = |text: &str| {
            text.trim().trim_end_matches("deg").trim().parse::<f64>().ok().map(f64::abs)
        };
        let side = rudder_side(&delta[start..])?;
        let kind =
            ManoeuvreKind::Zigzag { rudder_deg: side * angle(rudder)?, switch_deg: angle(switch)? };
        let reversals = rudder_reversals(&delta[start..]).into_iter();
        let reversals_s = reversals.map(|k| trial.t_s[start + k] - trial.t_s[start]).collect();
        Some(Self { kind, start, reversals_s })
    }

    /// Returns the metrics of a track whose states belong to the given samples of the trial.
    pub fn track_metrics(&self, track: &Trajectory, samples: &[usize]) -> Option<ManoeuvreMetrics> {
        let first = samples.iter().position(|&k| k >= self.start)?;
        // Time counts from the execution of the rudder.
        let mut after = Trajectory::default();
        for k in first..track.states.len() {
            after.push(track.t_s[k] - track.t_s[first], track.states[k], track.n_rps[k]);
        }
        match self.kind {
            ManoeuvreKind::Turn { rudder_deg } => {
                TurningMetrics::from_track(&after, rudder_deg).map(ManoeuvreMetrics::Turn)
            }
            ManoeuvreKind::Zigzag { rudder_deg, switch_deg } => {
                ZigzagMetrics::from_track(&after, rudder_deg, switch_deg, &self.reversals_s)
                    .map(ManoeuvreMetrics::Zigzag)
            }
        }
    }
}

/// Returns a trial as a track; `None` if velocities, heading or position were not recorded.
pub fn recorded_track(trial: &Trial) -> Option<Trajectory> {
    let needed = &RECORDED_CHANNELS[..6];
    let columns: Vec<(usize, &[f64])> = needed
        .iter()
        .filter_map(|&(channel, index)| Some((index, trial.channel(channel)?)))
        .collect();
    if columns.len() < needed.len() {
        return None;
    }
    let mut track = Trajectory::default();
    for (k, &t_s) in trial.t_s.iter().enumerate() {
        let mut state = StateVector::zeros();
        columns.iter().for_each(|(index, column)| state[*index] = column[k]);
        track.push(t_s, state, trial.channel(Channel::N).map_or(0.0, |n| n[k]));
    }
    Some(track)
}

/// Returns the sample at which the rudder leaves its first angle by a tenth of its range and by
/// more than half a degree.
fn execution_sample(delta: &[f64]) -> Option<usize> {
    let rest = *delta.first()?;
    let range = delta.iter().map(|value| (value - rest).abs()).fold(0.0, f64::max);
    let least = (0.1 * range).max(0.5_f64.to_radians());
    delta.iter().position(|value| (value - rest).abs() > least)
}

/// Returns the sign of the first angle that is not zero.
fn rudder_side(delta: &[f64]) -> Option<f64> {
    delta.iter().find(|angle| **angle != 0.0).map(|angle| angle.signum())
}

/// Returns the samples at which the rudder changes its side: the first at or beyond zero. A rudder
/// that returns from zero to the same side has not changed it.
fn rudder_reversals(delta: &[f64]) -> Vec<usize> {
    let (mut reversals, mut side, mut at_zero) = (Vec::new(), rudder_side(delta), None);
    for (k, angle) in delta.iter().enumerate() {
        if *angle == 0.0 {
            at_zero = at_zero.or(Some(k));
            continue;
        }
        let crossing = at_zero.take().unwrap_or(k);
        if side != Some(angle.signum()) {
            reversals.push(crossing);
            side = Some(angle.signum());
        }
    }
    reversals
}

fn median(values: &[f64]) -> Option<f64> {
    let mut values = values.to_vec();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn trial(manoeuvre: &str, delta_deg: &[f64]) -> Trial {
        let delta: Vec<f64> = delta_deg.iter().map(|d| d.to_radians()).collect();
        let t_s = (0..delta.len()).map(|k| k as f64).collect();
        Trial {
            t_s,
            channels: [(Channel::Delta, delta)].into(),
            manoeuvre: Some(manoeuvre.into()),
            ..Trial::default()
        }
    }

    #[test]
    fn a_zigzag_is_recognised_with_its_reversals() {
        let trial =
            trial("zigzag 10/5", &[0.0, 0.0, 5.0, 10.0, 10.0, 2.0, -8.0, -10.0, -10.0, 3.0, 10.0]);
        let found = ManoeuvreRecognition::from_trial(&trial).unwrap();
        assert_eq!((found.start, found.reversals_s), (2, vec![4.0, 7.0]));
        assert_eq!(found.kind, ManoeuvreKind::Zigzag { rudder_deg: 10.0, switch_deg: 5.0 });
    }

    #[test]
    fn a_rudder_that_only_touches_zero_is_not_reversed() {
        let touched = [5.0, 10.0, 0.0, 10.0, 0.0, 0.0, -10.0, 0.0, -5.0, 2.0, 10.0, 0.0];
        assert_eq!(rudder_reversals(&touched), [4, 9]);
        let all = [vec![0.0, 0.0], touched.to_vec()].concat();
        let found = ManoeuvreRecognition::from_trial(&trial("zigzag 10/5", &all)).unwrap();
        assert_eq!((found.start, found.reversals_s), (2, vec![4.0, 9.0]));
    }

    #[test]
    fn a_turn_has_the_rudder_it_ends_with() {
        let found = ManoeuvreRecognition::from_trial(&trial(
            "turn",
            &[0.0, -3.0, -12.0, -12.0, -12.0, -12.0],
        ))
        .unwrap();
        assert_eq!(
            (found.start, found.kind),
            (1, ManoeuvreKind::Turn { rudder_deg: (-12_f64.to_radians()).to_degrees() })
        );
        assert_eq!(ManoeuvreRecognition::from_trial(&trial("random", &[0.0, 5.0])), None);
    }
}
