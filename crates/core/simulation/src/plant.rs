//! Model prepared for simulation: its law and coefficients on one tape.

mod listing;
mod rate;

use nalgebra::{LU, Matrix4};
use sistership_formula::Expr;
use sistership_model::Model;
use sistership_model::coefficient::Axis;
use sistership_model::law::Law;

use crate::equations::{CoefficientBinding, EquationLowering, EquationsOfMotion, PlantError};
use crate::tape::Tape;

pub use listing::PlantListing;
pub use rate::PlantWorkspace;

/// Inputs at an instant, in the order of the law's inputs.
pub type LawInputs = [f64; MAX_INPUTS];

/// Largest number of inputs that a law may declare.
pub const MAX_INPUTS: usize = 16;

/// Model prepared for simulation.
#[derive(Debug)]
pub struct Plant {
    tape: Tape,
    layout: OutputLayout,
    /// Accelerations per unit force on each axis, where masses do not change.
    mobility: Option<Matrix4<f64>>,
    input_names: Vec<String>,
    /// Coefficients, parameters and particulars that are given with each state; all others are
    /// folded into the tape.
    open: Vec<String>,
    input_defaults: Vec<Option<f64>>,
    lags_s: Vec<(usize, f64)>,
    bands: Vec<(usize, f64)>,
}

/// Outputs of the tape by meaning.
#[derive(Debug, Clone, Default)]
struct OutputLayout {
    /// Forces by axis in the order X, Y, K, N; `None` for an axis that the law does not have.
    forces: [Option<usize>; 4],
    /// Mass matrix entries in the same order.
    mass: [[Option<usize>; 4]; 4],
    /// Rates of x, y, psi, phi where the law defines them.
    kinematics: [Option<usize>; 4],
    /// Accelerations that effects add, in the same order.
    accelerations: [Option<usize>; 4],
    /// Distance of the motion from the range covered by trials.
    distance: Option<usize>,
}

impl Plant {
    /// Lowers a model with its effects onto a tape.
    ///
    /// # Errors
    /// Returns an error that names what the model does not give, or if the mass matrix cannot be
    /// inverted.
    pub fn new(model: &Model, law: &Law) -> Result<Self, PlantError> {
        Self::from_equations(&EquationsOfMotion::new(model, law)?, CoefficientBinding::Values)
    }

    /// Lowers a model as [`Plant::new`] does, with all coefficients open, and the parameters that
    /// trials determine: values are given with each state, and those of the model are not read.
    ///
    /// # Errors
    /// The errors of [`Plant::new`].
    pub fn with_open_coefficients(model: &Model, law: &Law) -> Result<Self, PlantError> {
        Self::from_equations(&EquationsOfMotion::new(model, law)?, CoefficientBinding::Names)
    }

    /// Lowers equations that are set up already, as [`Plant::new`] does.
    ///
    /// # Errors
    /// The errors of [`Plant::new`].
    pub fn from_equations(
        equations: &EquationsOfMotion<'_>,
        coefficients: CoefficientBinding,
    ) -> Result<Self, PlantError> {
        Self::with_distance(equations, coefficients, None)
    }

    /// Lowers equations with a formula of the distance from the range covered by trials.
    ///
    /// # Errors
    /// The errors of [`Plant::new`].
    pub fn with_distance(
        equations: &EquationsOfMotion<'_>,
        coefficients: CoefficientBinding,
        distance: Option<&Expr>,
    ) -> Result<Self, PlantError> {
        let (model, law) = (equations.model(), equations.law());
        check_inputs(law)?;
        let mut open: Vec<String> = match coefficients {
            CoefficientBinding::Values => Vec::new(),
            _ => open_names(model, law),
        };
        if coefficients == CoefficientBinding::AllNames {
            let constants = equations.constant_names().into_iter();
            let others: Vec<String> = constants.filter(|name| !open.contains(name)).collect();
            open.extend(others);
        }
        // Open coefficients follow the inputs of the law on the tape.
        let names: Vec<String> =
            equations.tape_input_names().into_iter().chain(open.iter().cloned()).collect();
        let mut lowering = EquationLowering::new(equations, &names);
        let mut layout = build_layout(equations, &mut lowering, coefficients)?;
        layout.distance = distance.map(|distance| lowering.add_output(distance)).transpose()?;
        let tape = lowering.finish();
        // A mass matrix with a determinant of zero or less is not physical.
        let mobility = match constant_mass(&tape, &layout).map(LU::new) {
            Some(lu) if lu.determinant() > 0.0 => {
                Some(lu.try_inverse().ok_or_else(|| PlantError::Mass(model.name.clone()))?)
            }
            Some(_) => return Err(PlantError::Mass(model.name.clone())),
            None => None,
        };
        Ok(Self {
            tape,
            layout,
            mobility,
            open,
            input_names: law.inputs.keys().cloned().collect(),
            input_defaults: law.inputs.values().map(|input| input.default).collect(),
            lags_s: values_by_input(equations, &equations.law().dressing.lags)?,
            bands: values_by_input(equations, &equations.law().dressing.bands)?,
        })
    }

    /// Names of the inputs of the law, in order.
    pub fn input_names(&self) -> &[String] {
        &self.input_names
    }

    /// Names of the coefficients, parameters and particulars that are given with each state, in
    /// order.
    pub fn open_coefficients(&self) -> &[String] {
        &self.open
    }

    /// Inputs with a lag: place among the inputs and time constant, s.
    pub fn input_lags_s(&self) -> &[(usize, f64)] {
        &self.lags_s
    }

    /// Half widths of the dead bands of inputs, with the place among the inputs.
    pub fn dead_bands(&self) -> &[(usize, f64)] {
        &self.bands
    }

    /// Returns true for a 4-DOF law, which has roll.
    pub fn has_roll(&self) -> bool {
        self.layout.forces[2].is_some()
    }

    /// Default value of each input.
    pub fn input_defaults(&self) -> &[Option<f64>] {
        &self.input_defaults
    }
}

/// Names of the coefficients of a model, and of the parameters of its law that trials determine.
fn open_names(model: &Model, law: &Law) -> Vec<String> {
    let parameters = law.parameter_priors().map(|(name, _)| name);
    let given = parameters.filter(|name| model.parameters.contains_key(*name));
    model.coefficients.keys().chain(given).cloned().collect()
}

/// Refuses a law that has more inputs than [`Inputs`] can hold.
pub(crate) fn check_inputs(law: &Law) -> Result<(), PlantError> {
    if law.inputs.len() > MAX_INPUTS {
        return Err(PlantError::Inputs { law: law.name.clone(), most: MAX_INPUTS });
    }
    Ok(())
}

fn build_layout(
    equations: &EquationsOfMotion<'_>,
    lowering: &mut EquationLowering<'_>,
    coefficients: CoefficientBinding,
) -> Result<OutputLayout, PlantError> {
    let law = equations.law();
    let mut layout = OutputLayout::default();
    for (row, axis) in Axis::ALL.into_iter().enumerate() {
        if law.axes.contains_key(&axis) {
            layout.forces[row] =
                Some(lowering.add_output(&equations.axis_force(axis, coefficients)?)?);
        }
        for (column, other) in Axis::ALL.into_iter().enumerate() {
            layout.mass[row][column] = lowering.add_mass_entry(axis, other)?;
        }
    }
    for (place, name) in ["x", "y", "psi", "phi"].into_iter().enumerate() {
        if let Some(expr) = law.kinematics.get(name) {
            layout.kinematics[place] = Some(lowering.add_output(expr)?);
        }
    }
    // Several effects may act on one axis: their accelerations add.
    for (axis, expr) in &law.dressing.accelerations {
        let place = &mut layout.accelerations[*axis as usize];
        *place = Some(lowering.add_to_output(*place, expr)?);
    }
    Ok(layout)
}

/// Evaluates constant formulas by input; returns the input's place and the value, none below zero.
fn values_by_input(
    equations: &EquationsOfMotion<'_>,
    figures: &[(String, Expr)],
) -> Result<Vec<(usize, f64)>, PlantError> {
    let law = equations.law();
    let one = |(input, expr): &(String, Expr)| {
        let place = law.inputs.get_index_of(input)?;
        // The formula must be constant: its tape has no inputs.
        let mut lowering = EquationLowering::new(equations, &[]);
        let lowered = lowering.add_output(expr);
        Some(lowered.map(|_| (place, lowering.finish().evaluate_point(&[])[0].max(0.0))))
    };
    figures.iter().filter_map(one).collect()
}

fn constant_mass(tape: &Tape, layout: &OutputLayout) -> Option<Matrix4<f64>> {
    // Absent axes keep the entries of the identity, so that the matrix stays regular.
    let mut mass = Matrix4::identity();
    for (row, columns) in layout.mass.iter().enumerate() {
        for (column, output) in columns.iter().enumerate() {
            if let Some(output) = output {
                mass[(row, column)] = tape.constant_output(*output)?;
            }
        }
    }
    Some(mass)
}
