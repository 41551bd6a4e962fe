//! Common content of all formats: the operations of a model's equations of motion, and names.

use std::borrow::Cow;
use std::sync::LazyLock;

use sistership_model::effect::{AppliedEffect, qualified_name};
use sistership_model::law::LawInput;
use sistership_model::quantity::Quantity;
use sistership_model::{Effect, FileError, Law, Model};
use sistership_simulation::envelope::MotionEnvelope;
use sistership_simulation::equations::{CoefficientBinding, EquationsOfMotion};
use sistership_simulation::gear::SteeringGear;
use sistership_simulation::plant::PlantListing;
use sistership_simulation::validity::distance_formula;
use sistership_simulation::{Plant, Ship};

use crate::coefficients::{ExportCoefficient, export_coefficients};
use crate::correction::with_correction;
use crate::error::ExportError;
use crate::external_input::{CURRENT, ExternalInput};
use crate::identifier::to_identifier;
use crate::states::{DELTA, STATES};
use crate::subject::ExportSubject;

/// Kind of an input of the tape.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TapeOperand {
    /// State, by its index in the state vector.
    State(usize),
    /// External input, by its index in the list of the plan.
    Outside(usize),
    /// Coefficient, by its index in the list of the plan.
    Coefficient(usize),
}

/// Equations of motion of a model, ready for export.
#[derive(Debug)]
pub struct ExportPlan {
    /// Name of the model.
    pub name: String,
    /// Identifier in exported programs.
    pub identifier: String,
    /// Lines of provenance: the model, and the sources of its values.
    pub provenance: Vec<String>,
    /// SHA-256 of the exported document.
    pub sha256: String,
    /// External inputs, except the ordered rudder.
    pub outside: Vec<ExternalInput>,
    /// Coefficients of the model, then the parameters and particulars that can be set.
    pub coefficients: Vec<ExportCoefficient>,
    /// Kinds of the inputs of the tape.
    pub operands: Vec<TapeOperand>,
    /// Steering gear, if the law has one rudder.
    pub gear: Option<SteeringGear>,
    /// Half of the gear's dead band, rad: an order within it is not followed.
    pub band_rad: f64,
    /// Physical range outside which a simulation is not valid.
    pub envelope: MotionEnvelope,
    /// True if the law has roll.
    pub has_roll: bool,
    /// Length between perpendiculars, m.
    pub lpp_m: f64,
    /// Approach speed of the model, m/s.
    pub speed_m_s: f64,
    plant: Plant,
}

impl ExportPlan {
    /// Creates the plan of a model, with a current as an additional input; `names` says what can be
    /// set by name: [`CoefficientBinding::Names`] or [`CoefficientBinding::AllNames`].
    ///
    /// # Errors
    /// Returns an error with the reason why the model cannot be exported.
    pub fn new(
        subject: &ExportSubject<'_>,
        names: CoefficientBinding,
    ) -> Result<Self, ExportError> {
        let model = with_current(subject.model)?;
        let law = with_correction(&model, law_with_effects(&model, subject.law)?)?;
        let equations = EquationsOfMotion::from_law(&model, Cow::Borrowed(&law));
        let known = equations.tape_input_names();
        let is_known = |name: &str| known.iter().any(|known| known == name);
        let distance = model.validity.as_ref().map(|region| distance_formula(region, &is_known));
        let plant = Plant::with_distance(&equations, names, distance.as_ref())?;
        // The ship of the original model: gear and envelope do not depend on the current.
        let ship = Ship::new(subject.model, subject.law)?;
        let delta = law.inputs.get_index_of("delta");
        // Dead bands are stored by the index of the input.
        let band = plant.dead_bands().iter().find(|(place, _)| Some(*place) == delta);
        // The distance to the trials' range is part of the tape, so its inputs are kept, too.
        let outside = external_inputs(&model, &law, &plant);
        let coefficients = export_coefficients((&equations, subject.law), &plant, &outside)?;
        let operands = tape_operands(&law, &plant, (&outside, &coefficients));
        Ok(Self {
            name: model.name.clone(),
            identifier: to_identifier(&model.name),
            provenance: subject.provenance_lines(),
            sha256: subject.sha256.clone(),
            gear: law.inputs.contains_key("delta").then(|| ship.steering_gear()),
            band_rad: band.map_or(0.0, |(_, half)| *half),
            envelope: *ship.envelope(),
            has_roll: ship.has_roll(),
            lpp_m: ship.lpp_m(),
            speed_m_s: ship.approach_speed_m_s(),
            outside,
            coefficients,
            operands,
            plant,
        })
    }

    /// Operations of the equations of motion.
    pub fn listed_operations(&self) -> PlantListing<'_> {
        self.plant.to_listing()
    }

    /// Indices of the states that are not constant.
    pub fn moving_states(&self) -> impl Iterator<Item = usize> {
        let moves = |place: &usize| match place {
            // Indices of roll rate and roll angle.
            3 | 4 => self.has_roll,
            &DELTA => self.gear.is_some(),
            _ => true,
        };
        (0..STATES.len()).filter(moves)
    }

    /// Largest time step of the built-in manoeuvres, s: 0.1 s, or a fiftieth of the time in which
    /// the ship travels its length.
    pub fn step_s(&self) -> f64 {
        0.1_f64.min(0.02 * self.lpp_m / self.speed_m_s)
    }
}

/// Current effect of the library of effects.
static CURRENT_EFFECT: LazyLock<Result<Effect, FileError>> = LazyLock::new(|| {
    Effect::parse("current.yaml", include_str!("../../../../models/effects/current.yaml"))
});

/// Returns the model with a current of zero, if it has no current.
fn with_current(model: &Model) -> Result<Model, ExportError> {
    let mut model = model.clone();
    let (name, form, parameters) = CURRENT;
    if model.effects.iter().any(|effect| effect.name == name) {
        return Ok(model);
    }
    let refused = |message: String| ExportError::Effect { field: name.to_owned(), message };
    let current = CURRENT_EFFECT.as_ref().map_err(|error| refused(error.to_string()))?;
    let form = current.forms.iter().find(|known| known.file.name == form);
    let form = form.ok_or_else(|| refused("has no such form".to_owned()))?;
    let still = parameters.map(|parameter| (parameter.to_owned(), Quantity::new(0.0, "")));
    model.effects.push(AppliedEffect {
        name: name.to_owned(),
        acts_on: current.acts_on,
        parameters: still.into(),
        form: form.file.clone(),
    });
    Ok(model)
}

/// Returns the law with the model's effects; the velocity of the current becomes an input.
fn law_with_effects(model: &Model, law: &Law) -> Result<Law, ExportError> {
    let mut law = law
        .with_effects(model)
        .map_err(|(field, message)| ExportError::Effect { field, message })?;
    if let Some((input, _)) = law.dressing.lags.iter().find(|(input, _)| input != "delta") {
        return Err(ExportError::Lag { model: model.name.clone(), input: input.clone() });
    }
    if let Some((input, _)) = law.dressing.bands.iter().find(|(input, _)| input != "delta") {
        return Err(ExportError::Band { model: model.name.clone(), input: input.clone() });
    }
    let (effect, form, parameters) = CURRENT;
    for name in parameters.map(|parameter| qualified_name(effect, form, parameter)) {
        // A current that the model already has becomes the default of the input.
        let Some(value) = law.dressing.parameters.remove(&name) else { continue };
        let dimension = law.parameters[&name].dimension;
        law.inputs.insert(name, LawInput { dimension, default: Some(value), helm: None });
    }
    Ok(law)
}

/// Inputs of the law except the rudder; inputs that no operation reads are omitted.
fn external_inputs(model: &Model, law: &Law, plant: &Plant) -> Vec<ExternalInput> {
    // Inputs of the tape are the states, then the inputs of the law.
    let first = sistership_model::law::STATES.len();
    let reads = |place: usize| plant.reads_input(first + place);
    let inputs = law.inputs.iter().enumerate();
    inputs
        .filter(|(place, (name, _))| name.as_str() != "delta" && reads(*place))
        .map(|(_, (name, input))| ExternalInput::from_law(model, name, input))
        .collect()
}

/// Kind of each input of the tape. An input that no operation reads gets an arbitrary operand.
fn tape_operands(
    law: &Law,
    plant: &Plant,
    (outside, coefficients): (&[ExternalInput], &[ExportCoefficient]),
) -> Vec<TapeOperand> {
    let states = sistership_model::law::STATES.len();
    let of_input = |name: &String| match outside.iter().position(|known| known.name == *name) {
        Some(place) => TapeOperand::Outside(place),
        None => TapeOperand::State(DELTA),
    };
    let of_open = |name: &String| match coefficients.iter().position(|one| one.name == *name) {
        Some(place) => TapeOperand::Coefficient(place),
        None => TapeOperand::State(DELTA),
    };
    (0..states)
        .map(TapeOperand::State)
        .chain(law.inputs.keys().map(of_input))
        .chain(plant.open_coefficients().iter().map(of_open))
        .collect()
}
