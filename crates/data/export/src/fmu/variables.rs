//! Variables of an FMU, in the order of their value references.

use crate::coefficients::ExportCoefficient;
use crate::export_plan::ExportPlan;
use crate::header::coefficient_remark;
use crate::range;
use crate::states::{DELTA, STATES};

/// Value reference of the first state; that of time is zero.
pub const FIRST_STATE: u32 = 1;
/// Value reference of the rate of the first state.
const FIRST_RATE: u32 = 10;
/// Value reference of the ordered rudder.
const ORDER: u32 = 19;
/// Value reference of the first external input; coefficients and other parameters, the figures of
/// the steering gear, the distance outside the range and the largest step follow.
pub const FIRST_OUTSIDE: u32 = 20;
/// Depth of deep water, m, for formats without infinity and tools that do not read it.
const DEEP_M: f64 = 1e9;

/// Role of a variable in an FMU.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VariableRole {
    /// State, whose start value can be set; also an output.
    State,
    /// Rate of a state.
    Rate,
    /// Input.
    Input,
    /// Parameter that can be set before the simulation, and between its steps.
    Parameter,
    /// Output that follows from states and inputs.
    Output,
}

/// Variable of an FMU.
#[derive(Debug, Clone)]
pub struct FmuVariable {
    /// Value reference.
    pub reference: u32,
    /// Name of the variable.
    pub name: String,
    /// Unit, if it is in the list of units.
    pub unit: Option<String>,
    /// Description of the variable.
    pub description: String,
    /// Role in the FMU.
    pub role: VariableRole,
    /// Start value; rates and computed outputs have none.
    pub start: Option<f64>,
    /// Smallest and largest value, if limited.
    pub range: [Option<f64>; 2],
}

/// Units with the exponents of kg, m, s and rad.
pub const UNITS: [(&str, [i32; 4]); 12] = [
    ("m", [0, 1, 0, 0]),
    ("s", [0, 0, 1, 0]),
    ("rad", [0, 0, 0, 1]),
    ("m/s", [0, 1, -1, 0]),
    ("rad/s", [0, 0, -1, 1]),
    ("1/s", [0, 0, -1, 0]),
    ("m/s2", [0, 1, -2, 0]),
    ("rad/s2", [0, 0, -2, 1]),
    ("m2", [0, 2, 0, 0]),
    ("m3", [0, 3, 0, 0]),
    ("kg", [1, 0, 0, 0]),
    ("kg/m3", [1, -3, 0, 0]),
];

/// Dimensions of parameters with their units; those of pure numbers and of coefficients have none.
const PARAMETER_UNITS: [(&str, &str); 8] = [
    ("m", "m"),
    ("s", "s"),
    ("kg", "kg"),
    ("m^2", "m2"),
    ("m^3", "m3"),
    ("s^-1", "1/s"),
    ("m s^-1", "m/s"),
    ("kg m^-3", "kg/m3"),
];

/// Figures of the steering gear as parameters: name, unit, meaning.
const GEAR: [(&str, &str, &str); 4] = [
    ("rudder_limit", "rad", "largest rudder angle to either side"),
    ("rudder_rate", "rad/s", "largest rudder rate"),
    ("rudder_time_constant", "s", "time constant of the steering gear"),
    ("rudder_dead_band", "rad", "half of the dead band within which the gear does not move"),
];

/// Returns all variables.
pub fn fmu_variables(plan: &ExportPlan) -> Vec<FmuVariable> {
    let mut all: Vec<FmuVariable> =
        plan.moving_states().map(|place| state_variable(plan, place)).collect();
    all.extend(plan.moving_states().map(rate_variable));
    all.extend(order_variable(plan));
    all.extend(plan.outside.iter().zip(FIRST_OUTSIDE..).map(|(outside, reference)| FmuVariable {
        reference,
        name: outside.identifier.clone(),
        unit: listed_unit(&outside.unit),
        description: outside.meaning.clone(),
        role: VariableRole::Input,
        start: Some(outside.default.min(DEEP_M)),
        range: outside.range,
    }));
    // The references are without gaps: inputs, parameters, gear and distance if any, step.
    all.extend(plan.coefficients.iter().zip(first_parameter(plan)..).map(coefficient_variable));
    all.extend(gear_variables(plan));
    all.extend(distance_reference(plan).map(distance_variable));
    all.push(step_variable(plan, step_reference(plan)));
    all
}

/// Value reference of the first parameter.
pub fn first_parameter(plan: &ExportPlan) -> u32 {
    FIRST_OUTSIDE + plan.outside.len() as u32
}

/// Value references of the figures of the steering gear; `None` if the law has no rudder.
pub fn gear_references(plan: &ExportPlan) -> [Option<u32>; 4] {
    let first = first_parameter(plan) + plan.coefficients.len() as u32;
    let place = |k: usize| plan.gear.is_some().then_some(first + k as u32);
    std::array::from_fn(place)
}

/// Value reference after those of the parameters: that of the distance, if there is one.
fn after_parameters(plan: &ExportPlan) -> u32 {
    let gear = gear_references(plan).iter().flatten().count();
    first_parameter(plan) + (plan.coefficients.len() + gear) as u32
}

/// Value reference of the distance outside the range covered by trials; `None` if that range is not
/// known.
pub fn distance_reference(plan: &ExportPlan) -> Option<u32> {
    plan.listed_operations().distance?;
    Some(after_parameters(plan))
}

/// Value reference of the largest step, the last one.
fn step_reference(plan: &ExportPlan) -> u32 {
    after_parameters(plan) + u32::from(distance_reference(plan).is_some())
}

fn distance_variable(reference: u32) -> FmuVariable {
    FmuVariable {
        reference,
        name: range::NAME.to_owned(),
        unit: None,
        description: range::MEANING.to_owned(),
        role: VariableRole::Output,
        start: None,
        range: [None, None],
    }
}

/// Start values of all variables, by value reference.
pub fn start_values(plan: &ExportPlan) -> Vec<f64> {
    let mut starts = vec![0.0; step_reference(plan) as usize + 1];
    for variable in fmu_variables(plan) {
        starts[variable.reference as usize] = variable.start.unwrap_or(0.0);
    }
    starts
}

/// Unit, if it is in the list of units.
fn listed_unit(unit: &str) -> Option<String> {
    UNITS.iter().any(|(known, _)| *known == unit).then(|| unit.to_owned())
}

fn state_variable(plan: &ExportPlan, place: usize) -> FmuVariable {
    let (name, unit, meaning) = STATES[place];
    FmuVariable {
        reference: FIRST_STATE + place as u32,
        name: name.to_owned(),
        unit: listed_unit(unit),
        description: meaning.to_owned(),
        role: VariableRole::State,
        start: Some(if place == 0 { plan.speed_m_s } else { 0.0 }),
        range: [None, None],
    }
}

fn rate_variable(place: usize) -> FmuVariable {
    let (name, unit, meaning) = STATES[place];
    // Unit of the time derivative; angles and unknown units become rad/s.
    let unit = match unit {
        "m/s" => "m/s2",
        "rad/s" => "rad/s2",
        "m" => "m/s",
        _ => "rad/s",
    };
    FmuVariable {
        reference: FIRST_RATE + place as u32,
        name: format!("{name}_dot"),
        unit: listed_unit(unit),
        description: format!("rate of change of {name}: {meaning}"),
        role: VariableRole::Rate,
        start: None,
        range: [None, None],
    }
}

fn order_variable(plan: &ExportPlan) -> Option<FmuVariable> {
    let limit = plan.gear?.limit_rad();
    Some(FmuVariable {
        reference: ORDER,
        name: "delta_order".to_owned(),
        unit: listed_unit(STATES[DELTA].1),
        description: "ordered rudder, positive turns the ship to starboard".to_owned(),
        role: VariableRole::Input,
        start: Some(0.0),
        range: [Some(-limit), Some(limit)],
    })
}

fn coefficient_variable((coefficient, reference): (&ExportCoefficient, u32)) -> FmuVariable {
    FmuVariable {
        reference,
        name: coefficient.identifier.clone(),
        unit: parameter_unit(coefficient),
        description: format!("{}: {}", coefficient.meaning, coefficient_remark(coefficient)),
        role: VariableRole::Parameter,
        start: Some(coefficient.value),
        range: [None, None],
    }
}

/// Unit of a parameter or particular, if it is in the list of units.
fn parameter_unit(coefficient: &ExportCoefficient) -> Option<String> {
    let known = PARAMETER_UNITS.iter().find(|(dimension, _)| *dimension == coefficient.unit);
    known.map(|(_, unit)| (*unit).to_owned())
}

fn gear_variables(plan: &ExportPlan) -> impl Iterator<Item = FmuVariable> {
    let values = plan.gear.map_or([0.0; 4], |gear| {
        [gear.limit_rad(), gear.rate_rad_s(), gear.time_constant_s(), plan.band_rad]
    });
    let one = |((reference, (name, unit, meaning)), value)| {
        Some(FmuVariable {
            reference: reference?,
            name: str::to_owned(name),
            unit: listed_unit(unit),
            description: str::to_owned(meaning),
            role: VariableRole::Parameter,
            start: Some(value),
            range: [Some(0.0), None],
        })
    };
    gear_references(plan).into_iter().zip(GEAR).zip(values).filter_map(one)
}

fn step_variable(plan: &ExportPlan, reference: u32) -> FmuVariable {
    FmuVariable {
        reference,
        name: "step_s".to_owned(),
        unit: listed_unit("s"),
        description:
            "longest step of the integration, and the time in which a steering gear without \
                      time constant reaches its order"
                .to_owned(),
        role: VariableRole::Parameter,
        start: Some(plan.step_s()),
        range: [Some(1e-6), None],
    }
}
