//! What formulas of effects may mention, and with what dimension.

use crate::law::STATES;
use crate::particulars;
use crate::trial::Channel;
use sistership_formula as formula;
use sistership_formula::units::Dimension;

/// The speed at which the model's trials approach, which belongs to the model and not to the ship.
pub const APPROACH_SPEED: &str = "approach_speed_m_s";

/// The time since the start of the trial, s; a dressed law may call it otherwise, as laws have
/// parameters of that name.
const TIME: &str = "t";

/// What the simulation itself always has; every other channel must be recorded and is listed in
/// `needs`.
const GIVEN: [&str; 7] = ["u", "v", "r", "psi", "delta", "x", "y"];

/// The dimension of a name that every effect may use; `measuring` adds positions and rates of
/// change.
pub fn dimension(name: &str, measuring: bool) -> Option<Dimension> {
    let further = || if measuring { position_or_rate(name).or_else(|| log(name)) } else { None };
    seen(name)
        .or_else(|| formula::builtin(name).map(|(_, dimension)| dimension))
        .or_else(|| (name == TIME).then_some(Dimension::TIME))
        .or_else(|| (name == APPROACH_SPEED).then_some(Dimension::SPEED))
        .or_else(|| particulars::dimension(name))
        .or_else(further)
}

/// The dimension of a name that reports and stand-ins for particulars may use: what does not change
/// during a trial.
pub fn constant(name: &str) -> Option<Dimension> {
    formula::builtin(name).map(|(_, dimension)| dimension).or_else(|| particulars::dimension(name))
}

/// The dimension of a state or of a channel that a law may take.
pub fn seen(name: &str) -> Option<Dimension> {
    state(name).or_else(|| input(name))
}

fn state(name: &str) -> Option<Dimension> {
    STATES.iter().find(|(state, _)| *state == name).map(|&(_, dimension)| dimension)
}

/// The dimension of a channel that reaches a law from outside.
pub fn input(name: &str) -> Option<Dimension> {
    let channel = Channel::by_name(name)?;
    let from_outside = state(name).is_none()
        && !matches!(channel, Channel::X | Channel::Y | Channel::UWater | Channel::VWater);
    from_outside.then(|| channel.dimension())
}

/// A speed through the water that is recorded beside that over the ground.
fn log(name: &str) -> Option<Dimension> {
    matches!(name, "u_water" | "v_water").then_some(Dimension::SPEED)
}

fn position_or_rate(name: &str) -> Option<Dimension> {
    let position = |name: &str| matches!(name, "x" | "y").then_some(Dimension::LENGTH);
    let of_rate = |name: &str| Some(state(name).or_else(|| position(name))? - Dimension::TIME);
    position(name).or_else(|| name.strip_suffix("_dot").and_then(of_rate))
}

/// The channel that a trial must have recorded for the name to mean anything.
pub fn needed(name: &str) -> Option<Channel> {
    if GIVEN.contains(&name) { None } else { Channel::by_name(name) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn measurements_know_positions_and_rates() {
        assert_eq!(dimension("x_dot", true), Some(Dimension::SPEED));
        assert_eq!(dimension("r_dot", true), Some(Dimension::RATE - Dimension::TIME));
        assert_eq!(dimension("x_dot", false), None);
        assert_eq!(dimension("x", false), None);
        assert_eq!(dimension("delta_dot", true), None);
    }

    #[test]
    fn what_the_simulation_has_need_not_be_recorded() {
        assert_eq!(needed("delta"), None);
        assert_eq!(needed("phi"), Some(Channel::Phi));
        assert_eq!(needed("lpp_m"), None);
    }
}
