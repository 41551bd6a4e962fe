//! Variables of an FMU, in the order of their value references.

use crate::export_plan::{DELTA, ExportCoefficient, ExportPlan, STATES};
use crate::header::coefficient_remark;
use crate::range;

/// Value reference of the first state; that of time is zero.
pub const FIRST_STATE: u32 = 1;
/// Value reference of the rate of the first state.
const FIRST_RATE: u32 = 10;
/// Value reference of the ordered rudder.
const ORDER: u32 = 19;
/// Value reference of the first external input; coefficients, the distance outside the range and
/// the largest step follow.
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
    /// Parameter that can be set before the simulation.
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
pub const UNITS: [(&str, [i32; 4]); 8] = [
    ("m", [0, 1, 0, 0]),
    ("s", [0, 0, 1, 0]),
    ("rad", [0, 0, 0, 1]),
    ("m/s", [0, 1, -1, 0]),
    ("rad/s", [0, 0, -1, 1]),
    ("1/s", [0, 0, -1, 0]),
    ("m/s2", [0, 1, -2, 0]),
    ("rad/s2", [0, 0, -2, 1]),
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
    let first = FIRST_OUTSIDE + plan.outside.len() as u32;
    all.extend(plan.coefficients.iter().zip(first..).map(coefficient_variable));
    // The references are without gaps: inputs, coefficients, distance if any, step.
    let last = first + plan.coefficients.len() as u32;
    if let Some(distance) = distance_reference(plan) {
        all.push(distance_variable(distance));
        all.push(step_variable(plan, last + 1));
    } else {
        all.push(step_variable(plan, last));
    }
    all
}

/// Value reference of the distance outside the range covered by trials; `None` if that range is not
/// known.
pub fn distance_reference(plan: &ExportPlan) -> Option<u32> {
    plan.listed_operations().distance?;
    Some(FIRST_OUTSIDE + (plan.outside.len() + plan.coefficients.len()) as u32)
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
    let distance = usize::from(distance_reference(plan).is_some());
    let count =
        // One more for the largest step.
        FIRST_OUTSIDE as usize + plan.outside.len() + plan.coefficients.len() + distance + 1;
    let mut starts = vec![0.0; count];
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
        unit: None,
        description: format!("coefficient {}", coefficient_remark(coefficient)),
        role: VariableRole::Parameter,
        start: Some(coefficient.value),
        range: [None, None],
    }
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
