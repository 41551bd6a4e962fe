//! Checks of a declaration.

use super::actuators::{ActuatorInput, ExpansionVariable, inputs_and_variables, side_suffixes};
use super::file::{ActuatorFile, ActuatorKind, AngleFeature, HybridFile, Squares, Symmetry};
use super::rules::HYBRID_AXES;
use crate::coefficient::STANDARD_FACTORS;
use crate::law::STATES;
use crate::law::limits::check_count;
use crate::name::check_slug;
use crate::particulars;
use sistership_formula as formula;

/// Largest number of terms of an expansion.
const MAX_TERMS: usize = 5000;

/// Largest number of actuators.
const MAX_ACTUATORS: usize = 50;

type FieldFault = (String, String);

/// Checks everything that can be checked before the law is written.
///
/// # Errors
/// Returns the field at fault and its remedy.
pub fn check_declaration(file: &HybridFile) -> Result<(), FieldFault> {
    let fault = |field: &str, message: String| Err((field.to_owned(), message));
    check_slug(&file.name).map_err(|e| ("name".to_owned(), e.to_string()))?;
    if !(1..=4).contains(&file.order) {
        return fault("order", format!("must be from 1 to 4, not {}", file.order));
    }
    if !(file.shrinkage > 0.0 && file.shrinkage.is_finite()) {
        return fault("shrinkage", format!("must be above 0, not {}", file.shrinkage));
    }
    if file.actuators.is_empty() {
        return fault("actuators", "name at least one actuator".into());
    }
    check_count("actuators", file.actuators.len(), MAX_ACTUATORS)?;
    for (name, actuator) in &file.actuators {
        let field = |(key, message): (&str, String)| (format!("actuators.{name}{key}"), message);
        check_name(name).map_err(|e| field(("", e)))?;
        check_actuator(actuator).map_err(field)?;
    }
    let (inputs, variables) = inputs_and_variables(file);
    check_inputs(&inputs)?;
    check_rules(file, &variables)?;
    check_size(file, variables.len())
}

fn check_name(name: &str) -> Result<(), String> {
    let letters = |c: char| c.is_ascii_alphanumeric() || c == '_';
    if !name.starts_with(|c: char| c.is_ascii_alphabetic()) || !name.chars().all(letters) {
        return Err(
            "the name of an actuator consists of letters, digits and underscores and starts with \
             a letter"
                .into(),
        );
    }
    let state = STATES.iter().any(|(state, _)| *state == name);
    let known = state
        || formula::builtin_constant(name).is_some()
        || formula::Function::by_name(name).is_some()
        || name == "if";
    if known || particulars::particular_dimension(name).is_some() {
        return Err(format!("`{name}` has another meaning in formulas; choose another name"));
    }
    Ok(())
}

fn check_actuator(actuator: &ActuatorFile) -> Result<(), (&'static str, String)> {
    use ActuatorKind::{Propeller, Rudder, TunnelThruster, Vectwin};
    let kind = actuator.kind;
    if actuator.pair && kind == TunnelThruster {
        return Err((
            ".pair",
            "a tunnel thruster cannot be a pair; declare each one separately".into(),
        ));
    }
    // Only rudders and azimuth thrusters have an angle.
    if actuator.angle != AngleFeature::default() && matches!(kind, Propeller | TunnelThruster) {
        return Err((".angle", "it has no angle".into()));
    }
    if actuator
        .axes
        .as_ref()
        .is_some_and(|axes| axes.is_empty() || axes.iter().any(|axis| !HYBRID_AXES.contains(axis)))
    {
        return Err((".axes", "give at least one of X, Y and N".into()));
    }
    let Some(stall) = actuator.stall_deg else { return Ok(()) };
    if !matches!(kind, Rudder | Vectwin) {
        return Err((".stall_deg", "only rudders can stall".into()));
    }
    match side_suffixes(actuator)
        .iter()
        .map(|side| stall.side_angle(side))
        .find(|angle| !(*angle > 0.0 && *angle < 180.0))
    {
        Some(angle) => {
            Err((".stall_deg", format!("must be above 0 and below 180 deg, not {angle}")))
        }
        None => Ok(()),
    }
}

/// Checks that no two actuators share an input, and that an input with a standard name has its
/// standard unit.
fn check_inputs(inputs: &[ActuatorInput]) -> Result<(), FieldFault> {
    for (place, input) in inputs.iter().enumerate() {
        let field = || "actuators".to_owned();
        if inputs[..place].iter().any(|earlier| earlier.name == input.name) {
            return Err((field(), format!("two of them have an input `{}`", input.name)));
        }
        let wanted = match input.name.as_str() {
            "delta" => "rad",
            "n" => "rps",
            name if STANDARD_FACTORS.contains(&name) => {
                return Err((field(), format!("`{name}` is a state")));
            }
            _ => input.unit,
        };
        if wanted != input.unit {
            return Err((
                field(),
                format!(
                    "the input `{}` is in {wanted} everywhere; choose another name",
                    input.name
                ),
            ));
        }
    }
    Ok(())
}

fn check_rules(file: &HybridFile, variables: &[ExpansionVariable]) -> Result<(), FieldFault> {
    let rules = &file.rules;
    let mirrors = rules.symmetry == Symmetry::Mirror;
    if mirrors && rules.zeroth_powers {
        return Err((
            "rules.zeroth_powers".into(),
            "keeps constant terms, which `symmetry: mirror` excludes".into(),
        ));
    }
    if mirrors && rules.squares == Squares::AsPrinted {
        return Err((
            "rules.squares".into(),
            "`as_printed` gives constant terms, which `symmetry: mirror` excludes".into(),
        ));
    }
    for exception in &rules.trigonometric_exceptions {
        let found = variables
            .iter()
            .any(|variable| variable.trigonometric && variable.symbol == exception.factor);
        if !found {
            let known: Vec<&str> =
                variables.iter().filter(|v| v.trigonometric).map(|v| v.symbol.as_str()).collect();
            let message =
                format!("there is no `{}`; choose one of {}", exception.factor, known.join(", "));
            return Err(("rules.trigonometric_exceptions".into(), message));
        }
    }
    Ok(())
}

fn check_size(file: &HybridFile, variables: usize) -> Result<(), FieldFault> {
    // Number of monomials up to the order: the binomial coefficient of variables + order over
    // order.
    let terms = (0..file.order as usize)
        .fold(1, |product, i| product * (variables + file.order as usize - i) / (i + 1));
    if terms > MAX_TERMS {
        let message = format!(
            "{variables} variables to order {} give {terms} terms on an axis; the limit is \
             {MAX_TERMS}",
            file.order
        );
        return Err(("order".into(), message));
    }
    Ok(())
}
