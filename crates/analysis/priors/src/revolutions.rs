//! Revolutions of trials that record none.
//!
//! Recordings of rudder, gyro and GNSS have no revolutions, and without them no law with a propeller
//! can be fitted. A ship that holds its engine order turns its propeller in proportion to the speed
//! of its approach; at the usual speed the thrust balances the resistance by the estimate from
//! particulars.

use sistership_model::trial::{Channel, Trial};
use sistership_model::{Vessel, Zoo};

use crate::estimates::{RegressionLibrary, estimate_ship};
use crate::transfer::trial_approach;

/// Law of the estimate.
const ESTIMATE_LAW: &str = "mmg";
/// Quantile of the speed that is that of the approach: a ship loses speed in its turns, and single
/// readings are too high.
const APPROACH_QUANTILE: f64 = 0.95;

/// Revolutions of each trial, 1/s, if no trial records any; `None` if one does, or if the ship's
/// particulars do not suffice for an estimate.
pub fn assume_revolutions(zoo: &Zoo, vessel: &Vessel, trials: &[&Trial]) -> Option<Vec<f64>> {
    let is_recorded =
        |trial: &&Trial| Channel::SHAFTS.iter().any(|&one| trial.channel(one).is_some());
    if trials.iter().any(is_recorded) {
        return None;
    }
    let speed_m_s = trial_approach(trials)?.speed_m_s;
    // Without an estimate the laws without a propeller remain.
    let library = RegressionLibrary::parse_embedded().ok()?;
    let estimate = estimate_ship(&library, vessel, zoo.law(ESTIMATE_LAW)?, speed_m_s).ok()?;
    let n_rps = estimate.model.revolutions_rps?;
    let of_trial = |trial: &&Trial| {
        let ratio = approach_speed(trial)? / speed_m_s;
        // Three digits: more would look like a reading.
        Some((1e3 * n_rps * ratio).round() / 1e3).filter(|n_rps| *n_rps > 0.0)
    };
    trials.iter().map(of_trial).collect()
}

/// Speed of the approach of a trial, m/s.
fn approach_speed(trial: &Trial) -> Option<f64> {
    let (u, v) = (trial.channel(Channel::U)?, trial.channel(Channel::V)?);
    let mut speeds: Vec<f64> = u.iter().zip(v).map(|(u, v)| u.hypot(*v)).collect();
    let place = (APPROACH_QUANTILE * (speeds.len().checked_sub(1)?) as f64) as usize;
    Some(*speeds.select_nth_unstable_by(place, f64::total_cmp).1)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn turn(speed_m_s: f64, recorded: Option<Channel>) -> Trial {
        let u = vec![speed_m_s, speed_m_s, 0.6 * speed_m_s, 0.5 * speed_m_s];
        let mut trial = Trial { t_s: vec![0.0, 1.0, 2.0, 3.0], ..Trial::default() };
        trial.channels.insert(Channel::U, u);
        trial.channels.insert(Channel::V, vec![0.0; 4]);
        trial.channels.extend(recorded.map(|channel| (channel, vec![1.0; 4])));
        trial
    }

    #[test]
    fn an_engine_order_that_was_held_follows_from_the_speed_of_the_approach() {
        let zoo = Zoo::load_embedded().unwrap();
        let vessel = zoo.vessel("kvlcc2").unwrap();
        let (full, half) = (turn(7.97, None), turn(3.985, None));
        let found = assume_revolutions(&zoo, vessel, &[&full, &full, &half]).unwrap();
        // 1.547 1/s are published for 15.5 kn; pitch and resistance are estimates here.
        assert!((0.6..1.4).contains(&(found[0] / 1.547)) && found[0] == found[1], "{found:?}");
        assert!((found[2] - 0.5 * found[0]).abs() < 1e-3, "{found:?}");
    }

    #[test]
    fn recorded_revolutions_are_kept() {
        let zoo = Zoo::load_embedded().unwrap();
        let vessel = zoo.vessel("kvlcc2").unwrap();
        for shaft in Channel::SHAFTS {
            let trials = [turn(7.97, None), turn(7.97, Some(shaft))];
            assert_eq!(assume_revolutions(&zoo, vessel, &[&trials[0], &trials[1]]), None);
        }
    }
}
