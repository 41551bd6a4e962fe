//! Values of a model that an export takes by name: coefficients, and in formats whose parameters
//! can be set, the parameters and particulars that the equations read.

use sistership_formula::units::Dimension;
use sistership_model::effect::qualified_name;
use sistership_model::quantity::Quantity;
use sistership_model::{Law, Model};
use sistership_simulation::equations::EquationsOfMotion;
use sistership_simulation::tape::NameBinding;
use sistership_simulation::{Plant, PlantError};

use crate::error::ExportError;
use crate::external_input::ExternalInput;
use crate::identifier::unique_identifiers;
use crate::quoting::single_line;
use crate::states::STATES;

/// Coefficient of the model, or in formats whose parameters can be set, a parameter or particular.
#[derive(Debug, Clone, PartialEq)]
pub struct ExportCoefficient {
    /// Name in the law.
    pub name: String,
    /// Identifier in exported programs.
    pub identifier: String,
    /// Kind or meaning of the value.
    pub meaning: String,
    /// Value.
    pub value: f64,
    /// SI unit; `1` in a prime system.
    pub unit: String,
    /// Key of the source.
    pub source: String,
    /// Standard error, if it is known.
    pub standard_error: Option<f64>,
}

/// Names of variables that exports add to those of the model; no coefficient has one of them.
const ADDED: [&str; 7] = [
    "time",
    "delta_order",
    "rudder_limit",
    "rudder_rate",
    "rudder_time_constant",
    "rudder_dead_band",
    "step_s",
];

/// Returns the open values of a plant: all coefficients, and the others that its tape reads.
///
/// # Errors
/// Returns an error if the law has no such coefficient.
pub fn export_coefficients(
    (equations, law): (&EquationsOfMotion<'_>, &Law),
    plant: &Plant,
    outside: &[ExternalInput],
) -> Result<Vec<ExportCoefficient>, ExportError> {
    let coefficients = &equations.model().coefficients;
    let first = equations.tape_input_names().len();
    let open = plant.open_coefficients().iter().enumerate();
    let names: Vec<&str> = open
        .filter(|(k, name)| coefficients.contains_key(*name) || plant.reads_input(first + k))
        .map(|(_, name)| name.as_str())
        .collect();
    let states = STATES.iter().map(|(name, ..)| *name).chain(ADDED);
    let taken: Vec<&str> =
        states.chain(outside.iter().map(|input| input.identifier.as_str())).collect();
    let identifiers = unique_identifiers(taken.iter().chain(&names).copied());
    let one = |(name, identifier): (&&str, String)| match coefficients.get(*name) {
        Some(quantity) => coefficient(law, (name, quantity), identifier),
        None => Ok(parameter(equations, name, identifier)),
    };
    names.iter().zip(identifiers.into_iter().skip(taken.len())).map(one).collect()
}

fn coefficient(
    law: &Law,
    (name, quantity): (&str, &Quantity),
    identifier: String,
) -> Result<ExportCoefficient, ExportError> {
    Ok(ExportCoefficient {
        name: name.to_owned(),
        identifier,
        meaning: "coefficient".to_owned(),
        value: quantity.value,
        unit: law.coefficient_dimension(name).map_err(PlantError::from)?.to_string(),
        source: quantity.source.clone(),
        standard_error: quantity.standard_error,
    })
}

/// A parameter of the law or of an effect, or a particular.
fn parameter(
    equations: &EquationsOfMotion<'_>,
    name: &str,
    identifier: String,
) -> ExportCoefficient {
    let (model, law) = (equations.model(), equations.law());
    let meaning = match law.parameters.get(name) {
        Some(parameter) => single_line(&parameter.meaning),
        None => "particular".to_owned(),
    };
    let value = match equations.name_binding(name) {
        Some(NameBinding::Constant(value)) => value,
        // Open names are constants of the equations.
        _ => f64::NAN,
    };
    let stated = stated_quantity(model, name);
    ExportCoefficient {
        name: name.to_owned(),
        identifier,
        meaning,
        value,
        unit: law.name_dimension(name).unwrap_or(Dimension::NONE).to_string(),
        source: stated.map_or("from other particulars, or by default", |q| &q.source).to_owned(),
        standard_error: stated.and_then(|quantity| quantity.standard_error),
    }
}

/// Value with its source as the model states it: of an effect, a parameter, or a particular.
fn stated_quantity<'a>(model: &'a Model, name: &str) -> Option<&'a Quantity> {
    let of_effects = model.effects.iter().flat_map(|effect| {
        let qualified = |own: &str| qualified_name(&effect.name, &effect.form.name, own);
        effect.parameters.iter().map(move |(own, quantity)| (qualified(own), quantity))
    });
    let mut of_effects = of_effects.filter(|(qualified, _)| qualified == name);
    let of_effect = of_effects.next().map(|(_, quantity)| quantity);
    of_effect.or_else(|| model.parameters.get(name)).or_else(|| model.particulars.get(name))
}
