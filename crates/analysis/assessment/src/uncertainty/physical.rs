//! Figures that are positive by nature: a draw with another value has not completed the manoeuvre.
//!
//! A posterior is normal in the coefficients and does not exclude such values: some draws of a wide
//! one turn against their rudder, or slide out of the turn, and have a tactical diameter below
//! zero. The ship's own figure is positive; the band is that of the posterior conditioned on this
//! fact.

/// Endings of the names of figures that are above zero: lengths and times from the execution of the
/// rudder on. A transfer is not among them: a ship that turns on the spot may have none.
const POSITIVE: [&str; 6] = [
    "advance",
    "tactical diameter",
    "steady radius",
    "period",
    "initial turning",
    "initial turning ability",
];
/// Ending of the names of figures that are at least zero: the heading beyond the angle of reversal.
const NOT_NEGATIVE: &str = "overshoot";

/// Returns a figure of a draw without the error of its coarse step; `None` if it is impossible for
/// a ship. A correction that would change the sign is not applied.
pub(crate) fn physical_value(name: &str, value: f64, by_step: f64) -> Option<f64> {
    let corrected = value - by_step;
    if name.ends_with(NOT_NEGATIVE) {
        return (value >= 0.0).then_some(corrected.max(0.0));
    }
    if !POSITIVE.iter().any(|ending| name.ends_with(ending)) {
        return Some(corrected);
    }
    (value > 0.0).then_some(if corrected > 0.0 { corrected } else { value })
}

#[cfg(test)]
mod tests {
    use super::physical_value;

    #[test]
    fn only_figures_of_a_ship_are_taken() {
        let diameter = "turn 35 deg: tactical diameter";
        assert_eq!(physical_value(diameter, 500.0, 2.0), Some(498.0));
        assert_eq!(physical_value(diameter, -40.0, 2.0), None);
        assert_eq!(physical_value("IMO: advance", 0.5, 0.6), Some(0.5));
        assert_eq!(physical_value("zigzag 10/10: first overshoot", 0.1, 0.3), Some(0.0));
        assert_eq!(physical_value("zigzag 10/10: first overshoot", -3.0, 0.0), None);
        assert_eq!(physical_value("turn 35 deg: transfer", -4.0, 1.0), Some(-5.0));
    }
}
