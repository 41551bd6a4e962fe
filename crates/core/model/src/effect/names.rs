//! Names that formulas of effects may use, with their dimensions.

use crate::law::STATES;
use crate::particulars;
use crate::trial::Channel;
use sistership_formula as formula;
use sistership_formula::units::Dimension;

/// Approach speed of the model's trials, which belongs to the model and not to the ship.
pub const APPROACH_SPEED: &str = "approach_speed_m_s";

/// Time since the start of the trial, s; a law with effects may use another name, as laws may have
/// a parameter `t`.
const TIME_NAME: &str = "t";

/// Names that a simulation always has; every other channel must be recorded and is listed in
/// `needs`.
const ALWAYS_AVAILABLE: [&str; 7] = ["u", "v", "r", "psi", "delta", "x", "y"];

/// Dimension of a name that every effect may use; `measuring` adds positions and rates of change.
pub fn name_dimension(name: &str, measuring: bool) -> Option<Dimension> {
    let further =
        || if measuring { position_or_rate(name).or_else(|| log_dimension(name)) } else { None };
    replaceable_dimension(name)
        .or_else(|| formula::builtin_constant(name).map(|(_, dimension)| dimension))
        .or_else(|| (name == TIME_NAME).then_some(Dimension::TIME))
        .or_else(|| (name == APPROACH_SPEED).then_some(Dimension::SPEED))
        .or_else(|| particulars::particular_dimension(name))
        .or_else(further)
}

/// Dimension of a name that reports and replacements of particulars may use, which does not change
/// during a trial.
pub fn constant_dimension(name: &str) -> Option<Dimension> {
    formula::builtin_constant(name)
        .map(|(_, dimension)| dimension)
        .or_else(|| particulars::particular_dimension(name))
}

/// Dimension of a state or of a channel that a law may use.
pub fn replaceable_dimension(name: &str) -> Option<Dimension> {
    state_dimension(name).or_else(|| input_dimension(name))
}

fn state_dimension(name: &str) -> Option<Dimension> {
    STATES.iter().find(|(state, _)| *state == name).map(|&(_, dimension)| dimension)
}

/// Dimension of a channel that is an input of a law.
pub fn input_dimension(name: &str) -> Option<Dimension> {
    // Positions and speeds through the water are results or readings, not inputs.
    let channel = Channel::by_name(name)?;
    let from_outside = state_dimension(name).is_none()
        && !matches!(channel, Channel::X | Channel::Y | Channel::UWater | Channel::VWater);
    from_outside.then(|| channel.dimension())
}

/// Dimension of a speed through the water that is recorded in addition to that over the ground.
fn log_dimension(name: &str) -> Option<Dimension> {
    matches!(name, "u_water" | "v_water").then_some(Dimension::SPEED)
}

fn position_or_rate(name: &str) -> Option<Dimension> {
    let position = |name: &str| matches!(name, "x" | "y").then_some(Dimension::LENGTH);
    let of_rate =
        |name: &str| Some(state_dimension(name).or_else(|| position(name))? - Dimension::TIME);
    position(name).or_else(|| name.strip_suffix("_dot").and_then(of_rate))
}

/// Channel that a trial must have recorded for the name to be available.
pub fn required_channel(name: &str) -> Option<Channel> {
    if ALWAYS_AVAILABLE.contains(&name) { None } else { Channel::by_name(name) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn measurements_know_positions_and_rates() {
        assert_eq!(name_dimension("x_dot", true), Some(Dimension::SPEED));
        assert_eq!(name_dimension("r_dot", true), Some(Dimension::RATE - Dimension::TIME));
        assert_eq!(name_dimension("x_dot", false), None);
        assert_eq!(name_dimension("x", false), None);
        assert_eq!(name_dimension("delta_dot", true), None);
    }

    #[test]
    fn what_the_simulation_has_need_not_be_recorded() {
        assert_eq!(required_channel("delta"), None);
        assert_eq!(required_channel("phi"), Some(Channel::Phi));
        assert_eq!(required_channel("lpp_m"), None);
    }
}
