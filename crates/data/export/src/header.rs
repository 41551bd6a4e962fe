//! Header of every export: provenance, units, signs and sources.

use crate::coefficients::ExportCoefficient;
use crate::export_plan::ExportPlan;
use crate::external_input::ExternalInput;
use crate::quoting::single_line;
use crate::states::STATES;

/// Lines that a reader needs before the code: provenance, units, signs, inputs, coefficients.
pub fn header_lines(plan: &ExportPlan) -> Vec<String> {
    // Provenance first, so that a reader sees the model's status at once.
    let mut lines = plan.provenance.clone();
    lines.push(String::new());
    lines.push(
        "SI units and radians. Axes: x forward, y to starboard, z down, origin at midship. \
         Effects on instruments are not included: the states are true values."
            .to_owned(),
    );
    lines.push("States:".to_owned());
    lines.extend(plan.moving_states().map(|place| {
        let (name, unit, meaning) = STATES[place];
        format!("  {name} [{unit}] {meaning}")
    }));
    lines.push("Inputs:".to_owned());
    lines.extend(gear_line(plan));
    lines.extend(plan.outside.iter().map(|outside| {
        let range = range_words(outside.range).map_or(String::new(), |range| format!(", {range}"));
        let ExternalInput { identifier, unit, meaning, .. } = outside;
        format!("  {identifier} [{unit}] {meaning}{range}")
    }));
    lines.push(format!(
        "A simulation is not valid above {:.2} m/s, {:.4} rad/s of yaw rate or {:.2} rad of roll.",
        plan.envelope.speed_m_s(),
        plan.envelope.yaw_rate_rad_s(),
        plan.envelope.roll_rad()
    ));
    lines
}

/// Line of the steering gear, if the law has one rudder.
fn gear_line(plan: &ExportPlan) -> Option<String> {
    let gear = plan.gear.as_ref()?;
    let band = match plan.band_rad {
        // Most gears have no dead band.
        0.0 => String::new(),
        band => format!(", dead band {:.2} deg to either side", band.to_degrees()),
    };
    Some(format!(
        "  delta_order [rad] ordered rudder, positive turns the ship to starboard; the gear stops \
         at {:.1} deg, moves at most {:.2} deg/s, time constant {} s{band}",
        gear.limit_rad().to_degrees(),
        gear.rate_rad_s().to_degrees(),
        gear.time_constant_s()
    ))
}

/// Range of an input in words.
fn range_words([low, high]: [Option<f64>; 2]) -> Option<String> {
    match (low, high) {
        (Some(low), Some(high)) => Some(format!("trials covered {low:.4} to {high:.4}")),
        (Some(low), None) => Some(format!("above {low}")),
        (None, Some(high)) => Some(format!("below {high}")),
        (None, None) => None,
    }
}

/// Unit, source and standard error of a coefficient, on one line.
pub fn coefficient_remark(coefficient: &ExportCoefficient) -> String {
    let ExportCoefficient { name, unit, source, standard_error, .. } = coefficient;
    let error =
        standard_error.map_or(String::new(), |error| format!(", standard error {error:.3e}"));
    let unit = if unit == "1" { String::new() } else { format!(" [{unit}]") };
    single_line(&format!("{name}{unit}, {source}{error}"))
}
