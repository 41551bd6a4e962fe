//! Response of an engine to a constant order while a ship loses speed: the revolutions of trials
//! fall where torque or power is limited, and stay where a governor holds them.

use sistership_model::trial::{Channel, Trial};

use crate::transfer::{NEAR_APPROACH, median_value, trial_approach};

/// Root mean square about the line, in units of the approach revolutions, above which revolutions
/// were ordered during a trial: half of what still counts as the approach.
const ORDERED: f64 = 0.5 * NEAR_APPROACH;
/// Smallest loss: a ship that loses half of its speed then loses a hundredth of its revolutions,
/// about what they are recorded to.
const LEAST_LOSS: f64 = 0.02;

/// Revolutions of an engine at a constant order, `n = n_0 (1 - e (1 - U/U_0))`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EngineResponse {
    /// Revolutions `n_0` at the approach speed, 1/s.
    pub n_rps: f64,
    /// Loss `e`, 0 to 1.
    pub loss: f64,
}

/// Line of a trial's revolutions over its speed, both by those of the approach.
struct RevolutionsLine {
    slope: f64,
    at_approach: f64,
}

/// Response of the engine by the trials that begin near the approach speed, lose at least a tenth
/// of it, and order no other revolutions: medians over them. `None` if there are none, or if the
/// engine holds its revolutions.
pub fn engine_response(trials: &[&Trial]) -> Option<EngineResponse> {
    let approach = trial_approach(trials)?;
    let n_rps = approach.n_rps?;
    let line = |trial: &&Trial| RevolutionsLine::of_trial(trial, approach.speed_m_s, n_rps);
    let lines: Vec<RevolutionsLine> = trials.iter().filter_map(line).collect();
    let median = |of: fn(&RevolutionsLine) -> f64| {
        median_value(&mut lines.iter().map(of).collect::<Vec<_>>())
    };
    // The median of the revolutions is that in the turns: the loss is by those on the approach.
    let loss = median(|line| line.slope / line.at_approach)?.min(1.0);
    let n_rps = n_rps * median(|line| line.at_approach)?;
    (loss >= LEAST_LOSS).then_some(EngineResponse { n_rps, loss })
}

impl RevolutionsLine {
    /// Least-squares line; `None` if the trial begins elsewhere, keeps its speed, or has other
    /// orders.
    fn of_trial(trial: &Trial, speed_m_s: f64, n_rps: f64) -> Option<Self> {
        let (u, v) = (trial.channel(Channel::U)?, trial.channel(Channel::V)?);
        let speeds: Vec<f64> = u.iter().zip(v).map(|(u, v)| u.hypot(*v) / speed_m_s).collect();
        let revolutions: Vec<f64> = mean_revolutions(trial)?.iter().map(|n| n / n_rps).collect();
        let begins_near = (speeds.first()? - 1.0).abs() <= NEAR_APPROACH;
        let slowest = speeds.iter().copied().fold(f64::INFINITY, f64::min);
        if !begins_near || slowest > 1.0 - NEAR_APPROACH {
            return None;
        }
        // An order to the engine is no function of the speed, and leaves a large residual.
        let (line, residual) = Self::least_squares(&speeds, &revolutions);
        (residual <= ORDERED).then_some(line)
    }

    /// The line, and the root mean square about it.
    fn least_squares(x: &[f64], y: &[f64]) -> (Self, f64) {
        let count = x.len() as f64;
        let (mean_x, mean_y) = (x.iter().sum::<f64>() / count, y.iter().sum::<f64>() / count);
        let centred = x.iter().zip(y).map(|(x, y)| (x - mean_x, y - mean_y));
        let (square, product) =
            centred.clone().fold((0.0, 0.0), |sum, (x, y)| (sum.0 + x * x, sum.1 + x * y));
        let slope = product / square;
        let left: f64 = centred.map(|(x, y)| (y - slope * x).powi(2)).sum();
        let line = Self { slope, at_approach: mean_y + slope * (1.0 - mean_x) };
        (line, (left / count).sqrt())
    }
}

/// Mean revolutions of the recorded shafts, 1/s.
fn mean_revolutions(trial: &Trial) -> Option<Vec<f64>> {
    let shafts = Channel::SHAFTS.into_iter();
    let recorded: Vec<_> = shafts.filter_map(|shaft| trial.channel(shaft)).collect();
    let mean = |k: usize| recorded.iter().map(|n| n[k]).sum::<f64>() / recorded.len() as f64;
    (!recorded.is_empty()).then(|| (0..trial.len()).map(mean).collect())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// A turn in which the speed falls to 60 %, with given revolutions by the share of the speed.
    fn turn(speed_m_s: f64, revolutions: impl Fn(f64) -> f64) -> Trial {
        let share = |k: usize| 0.6 + 0.4 * (-(k as f64) / 10.0).exp();
        let mut trial = Trial { t_s: (0..60).map(|k| k as f64).collect(), ..Trial::default() };
        let of = |value: &dyn Fn(f64) -> f64| (0..60).map(|k| value(share(k))).collect();
        trial.channels.insert(Channel::U, of(&|share| speed_m_s * share));
        trial.channels.insert(Channel::V, vec![0.0; 60]);
        trial.channels.insert(Channel::N, of(&revolutions));
        trial
    }

    #[test]
    fn the_loss_of_an_engine_is_found_and_its_revolutions_on_the_approach() {
        let trials =
            [turn(8.0, |share| 2.0 - 0.8 * (1.0 - share)), turn(8.0, |share| 1.2 + 0.8 * share)];
        // A slower trial has other revolutions, and one with an order to stop is no response.
        let slow = turn(4.0, |_| 1.0);
        let ordered = turn(8.0, |share| if share > 0.8 { 2.0 } else { 0.0 });
        let found = engine_response(&[&trials[0], &slow, &ordered, &trials[1]]).unwrap();
        assert!((found.loss - 0.4).abs() < 1e-9, "{found:?}");
        assert!((found.n_rps - 2.0).abs() < 1e-9, "{found:?}");
    }

    #[test]
    fn a_governor_has_no_loss() {
        assert_eq!(engine_response(&[&turn(8.0, |_| 2.0)]), None);
        assert_eq!(engine_response(&[&turn(8.0, |share| 2.0 - 0.02 * (1.0 - share))]), None);
    }
}
