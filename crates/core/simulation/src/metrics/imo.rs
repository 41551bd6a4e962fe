//! Criteria of the IMO Standards for ship manoeuvrability, resolution MSC.137(76), annex, section
//! 5.3.

use serde::{Deserialize, Serialize};

use super::{TurningMetrics, ZigzagMetrics};

/// One criterion with its limit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ImoCriterion {
    /// Name of the criterion.
    pub criterion: String,
    /// Value in `unit`; absent if the manoeuvre did not reach it.
    pub value: Option<f64>,
    /// Largest permitted value.
    pub limit: f64,
    /// Unit of value and limit: `L` (ship lengths) or `deg`.
    pub unit: String,
    /// True if the criterion is met; absent without a value.
    pub pass: Option<bool>,
}

impl ImoCriterion {
    pub(super) fn new(name: &str, value: Option<f64>, limit: f64, unit: &str) -> Self {
        let pass = value.map(|value| value <= limit);
        Self { criterion: name.into(), value, limit, unit: unit.into(), pass }
    }
}

/// Returns the criteria: turning at the largest rudder angle (35 deg), initial turning at 10 deg,
/// zigzags 10/10 and 20/20. If both sides were simulated, the worse side counts. `speed_m_s` is the
/// test speed, `lpp_m` the length.
pub fn imo_criteria(
    lpp_m: f64,
    speed_m_s: f64,
    turns: &[TurningMetrics],
    zigzags: &[ZigzagMetrics],
    initial_turning_m: Option<f64>,
) -> Vec<ImoCriterion> {
    // Half a degree of tolerance on the largest rudder angle of 35 deg.
    let hard = turns.iter().filter(|turn| turn.rudder_deg.abs() >= 34.5);
    let hard: Vec<&TurningMetrics> = hard.collect();
    let lengths = |of: &dyn Fn(&TurningMetrics) -> Option<f64>| {
        worst_value(hard.iter().map(|turn| of(turn))).map(|m| m / lpp_m)
    };
    let zigzag = |rudder: f64, of: &dyn Fn(&ZigzagMetrics) -> Option<f64>| {
        worst_value(
            zigzags
                .iter()
                .filter(|z| z.rudder_deg.abs() == rudder && z.switch_deg == rudder)
                .map(of),
        )
    };
    let time = lpp_m / speed_m_s;
    vec![
        ImoCriterion::new("advance", lengths(&|turn| turn.advance_m), 4.5, "L"),
        ImoCriterion::new("tactical diameter", lengths(&|turn| turn.tactical_diameter_m), 5.0, "L"),
        ImoCriterion::new(
            "initial turning ability",
            initial_turning_m.map(|m| m / lpp_m),
            2.5,
            "L",
        ),
        ImoCriterion::new(
            "10/10 first overshoot",
            zigzag(10.0, &|z| z.first_overshoot_deg),
            first_overshoot_limit(time),
            "deg",
        ),
        ImoCriterion::new(
            "10/10 second overshoot",
            zigzag(10.0, &|z| z.second_overshoot_deg),
            second_overshoot_limit(time),
            "deg",
        ),
        ImoCriterion::new(
            "20/20 first overshoot",
            zigzag(20.0, &|z| z.first_overshoot_deg),
            25.0,
            "deg",
        ),
    ]
}

/// Returns the largest of several values; `None` if any of them is unknown.
fn worst_value(values: impl Iterator<Item = Option<f64>>) -> Option<f64> {
    let values: Option<Vec<f64>> = values.collect();
    values?.into_iter().reduce(f64::max)
}

/// Limit of the first overshoot of the 10/10 zigzag: 10 deg below L/V = 10 s, 20 deg from 30 s, 5 +
/// (L/V)/2 between.
fn first_overshoot_limit(time_s: f64) -> f64 {
    if time_s < 10.0 {
        10.0
    } else if time_s >= 30.0 {
        20.0
    } else {
        5.0 + 0.5 * time_s
    }
}

/// Limit of the second overshoot of the 10/10 zigzag: 25 deg below L/V = 10 s, 40 deg from 30 s,
/// 17.5 + 0.75 (L/V) between.
fn second_overshoot_limit(time_s: f64) -> f64 {
    if time_s < 10.0 {
        25.0
    } else if time_s >= 30.0 {
        40.0
    } else {
        17.5 + 0.75 * time_s
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn overshoot_limits_are_continuous() {
        assert!(
            (first_overshoot_limit(10.0) - first_overshoot_limit(9.999)).abs() < 0.01
                && (first_overshoot_limit(29.999) - 20.0).abs() < 0.01
        );
        assert!(
            (second_overshoot_limit(10.0) - 25.0).abs() < 0.01
                && (second_overshoot_limit(29.999) - 40.0).abs() < 0.01
        );
    }

    #[test]
    fn an_unfinished_turn_is_neither_pass_nor_fail() {
        let all = imo_criteria(100.0, 5.0, &[], &[], Some(300.0));
        assert_eq!(all[0].pass, None);
        assert_eq!(all[2].pass, Some(false));
    }
}
