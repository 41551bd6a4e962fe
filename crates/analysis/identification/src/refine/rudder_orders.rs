//! Records of rudder orders that no trial had. The models of folds are compared under them, and a
//! chosen model must complete them.

use std::collections::BTreeMap;

use sistership_model::law::Law;
use sistership_model::trial::{Channel, Trial};
use sistership_model::vessel::Steering;
use sistership_model::{Model, particulars};

use super::thresholds::{HELM, SPEED_SCALES};
use sistership_priors::transfer::trial_approach;

/// Rudder orders of a record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RudderOrder {
    /// Random angles within the gear's limit, each held for some ship lengths; the number of the
    /// record selects the sequence.
    Random(usize),
    /// A constant angle as a share of the gear's limit: a turn.
    Held(f64),
}

impl RudderOrder {
    /// Returns orders for `records` random records.
    pub fn random_orders(records: usize) -> Vec<Self> {
        (0..records).map(Self::Random).collect()
    }

    /// Name of the record.
    fn name(self, steering: &Steering) -> String {
        match self {
            Self::Random(record) => format!("random rudder orders {}", record + 1),
            Self::Held(share) => {
                format!("a constant rudder angle of {:.1} deg", share * steering.limit_deg)
            }
        }
    }

    /// Angles, rad, of a rudder that follows its orders at its gear's rate, from an angle at first.
    fn rudder_angles(
        self,
        steering: &Steering,
        interval_s: f64,
        (first_rad, count): (f64, usize),
    ) -> Vec<f64> {
        let limit = steering.limit_deg.to_radians();
        let step = steering.rate_deg_s.to_radians() * interval_s;
        let orders = match self {
            Self::Random(record) => orders_at_random(count, record * count),
            Self::Held(share) => vec![share; count],
        };
        let mut angle = first_rad;
        let moved = |order: &f64| {
            // The gear moves by its rate towards the order, sample by sample.
            angle += (limit * order - angle).clamp(-step, step);
            angle
        };
        orders.iter().map(moved).collect()
    }
}

/// Initial conditions of a record: channels that are held throughout or at first, and the rudder's
/// angle.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordStart {
    /// Speeds (m/s, rad/s), heel (rad) and revolutions (1/s) at first; inputs keep their value.
    pub channels: BTreeMap<Channel, f64>,
    /// The rudder's angle, rad.
    pub angle_rad: f64,
}

/// Returns a record for each speed of [`SPEED_SCALES`] and order, those at full speed first,
/// `lengths` ship lengths long, from straight ahead at that share of the speed and revolutions of
/// the trials' approach, in their depth and without wind. `None` if the approach or the length is
/// not known.
pub fn rudder_records(
    of: (&Model, &Law),
    trials: &[&Trial],
    (helms, lengths): (&[RudderOrder], f64),
) -> Option<Vec<Trial>> {
    let at_scale = |scale: f64| Some((scale, ahead_start(trials, scale)?));
    let starts: Vec<(f64, RecordStart)> =
        SPEED_SCALES.into_iter().map(at_scale).collect::<Option<_>>()?;
    let one = |helm: &RudderOrder, (scale, start): &(f64, RecordStart)| {
        // A slower ship takes longer for the same way.
        let record = rudder_record(of, trials, (*helm, lengths / scale), start)?;
        let slower = format!("{} at {scale} times the approach speed", record.name);
        let name = if *scale == 1.0 { record.name.clone() } else { slower };
        Some(Trial { name, ..record })
    };
    starts.iter().flat_map(|start| helms.iter().map(move |helm| one(helm, start))).collect()
}

/// The start of a record from straight ahead, at a share of the speed and revolutions of the
/// trials' approach.
fn ahead_start(trials: &[&Trial], scale: f64) -> Option<RecordStart> {
    let approach = trial_approach(trials)?;
    let motion = [
        (Channel::U, Some(scale * approach.speed_m_s)),
        (Channel::V, Some(0.0)),
        (Channel::R, Some(0.0)),
        (Channel::N, approach.n_rps.map(|n_rps| scale * n_rps)),
    ];
    let channels = motion.into_iter().filter_map(|(channel, value)| Some((channel, value?)));
    Some(RecordStart { channels: channels.collect(), angle_rad: 0.0 })
}

/// Returns a record of an order from initial conditions, `lengths` ship lengths long, in the depth
/// of the trials and without wind. `None` if the approach or the length is not known.
pub fn rudder_record(
    (model, law): (&Model, &Law),
    trials: &[&Trial],
    (helm, lengths): (RudderOrder, f64),
    begun: &RecordStart,
) -> Option<Trial> {
    let lpp_m = particulars::particular_value(&model.particulars, "lpp_m")?;
    let interval_s = lpp_m / trial_approach(trials)?.speed_m_s / HELM.samples_a_length;
    let count = (lengths * HELM.samples_a_length) as usize;
    let calm = [(Channel::WindSpeed, 0.0), (Channel::WindFrom, 0.0)];
    let constants = begun.channels.clone().into_iter().chain(calm);
    let mut channels: BTreeMap<Channel, Vec<f64>> =
        constants.map(|(channel, value)| (channel, vec![value; count])).collect();
    let angles = helm.rudder_angles(&model.steering, interval_s, (begun.angle_rad, count));
    channels.insert(Channel::Delta, angles);
    let mut record = Trial {
        name: helm.name(&model.steering),
        t_s: (0..count).map(|sample| sample as f64 * interval_s).collect(),
        channels,
        depth_m: trials.first().and_then(|trial| trial.depth_m),
        ..Trial::default()
    };
    law.set_actuators(&mut record);
    Some(record)
}

/// `count` samples of orders as shares of the gear's limit, from a place of a low-discrepancy
/// sequence on.
fn orders_at_random(count: usize, mut place: usize) -> Vec<f64> {
    let [shortest, longest] = HELM.held;
    let (mut order, mut until) = (0.0, 0.0);
    let sample = |sample: usize| {
        if sample as f64 >= until {
            place += 1;
            order = 2.0 * radical_inverse(place, 2) - 1.0;
            // Bases 2 and 3 give angle and duration independent sequences (Halton).
            let lengths = shortest + (longest - shortest) * radical_inverse(place, 3);
            until += HELM.samples_a_length * lengths;
        }
        order
    };
    (0..count).map(sample).collect()
}

/// The digits of a number in a base, in reverse order behind the point: over consecutive numbers
/// they fill the unit interval evenly (Halton 1960, Numerische Mathematik 2, 84, section 2).
fn radical_inverse(mut number: usize, base: usize) -> f64 {
    let (mut value, mut digit) = (0.0, 1.0 / base as f64);
    while number > 0 {
        value += digit * (number % base) as f64;
        number /= base;
        digit /= base as f64;
    }
    value
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::testing::{mariner_model, simulated_trials};

    #[test]
    fn digits_are_reversed() {
        let eighths: Vec<f64> = (1..8).map(|k| 8.0 * radical_inverse(k, 2)).collect();
        assert_eq!(eighths, [4.0, 2.0, 6.0, 1.0, 5.0, 3.0, 7.0]);
        assert!((radical_inverse(5, 3) - 7.0 / 9.0).abs() < 1e-12);
    }

    #[test]
    fn records_at_full_speed_come_first() {
        let (model, law) = mariner_model();
        let trials = simulated_trials(&model, &law, 0.0);
        let trials: Vec<&Trial> = trials.iter().collect();
        let orders = RudderOrder::random_orders(3);
        let records = rudder_records((&model, &law), &trials, (&orders, 2.0)).unwrap();
        let first = |record: &Trial| record.channel(Channel::U).unwrap()[0];
        let (full, slower) = records.split_at(orders.len());
        assert_eq!(slower.len(), orders.len());
        for (full, slower) in full.iter().zip(slower) {
            assert!((first(slower) / first(full) - SPEED_SCALES[1]).abs() < 1e-9);
            assert!((slower.duration_s() / full.duration_s() * SPEED_SCALES[1] - 1.0).abs() < 0.1);
        }
    }

    #[test]
    fn a_rudder_moves_at_its_gears_rate_within_its_limit() {
        let steering = Steering { limit_deg: 20.0, rate_deg_s: 3.0, ..Steering::default() };
        let angles = RudderOrder::Random(0).rudder_angles(&steering, 2.0, (0.0, 400));
        let degrees = |angle: &f64| angle.to_degrees();
        let most = angles.iter().map(degrees).fold(0.0, |most: f64, angle| most.max(angle.abs()));
        assert!((10.0..20.0 + 1e-9).contains(&most), "{most}");
        let moves = angles.windows(2).map(|pair| (pair[1] - pair[0]).abs().to_degrees());
        assert!(moves.fold(0.0, f64::max) < 6.0 + 1e-9);
        assert_ne!(angles, RudderOrder::Random(1).rudder_angles(&steering, 2.0, (0.0, 400)));
        let held = RudderOrder::Held(-0.5).rudder_angles(&steering, 2.0, (0.0, 400));
        assert!((held[0].to_degrees() + 6.0).abs() < 1e-9);
        assert!((held[399].to_degrees() + 10.0).abs() < 1e-9);
    }
}
