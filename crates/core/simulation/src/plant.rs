//! A model made ready to run: its law and figures on one tape.

mod listed;
mod rate;

use nalgebra::{LU, Matrix4};
use sistership_formula::Expr;
use sistership_model::Model;
use sistership_model::coefficient::Axis;
use sistership_model::law::Law;

use crate::equations::{Coefficients, EquationsOfMotion, Lowering, PlantError};
use crate::tape::Tape;

pub use listed::Listed;
pub use rate::Work;

/// What is given from outside at an instant, in the order of the law's inputs.
pub type Inputs = [f64; MAX_INPUTS];

/// Most inputs a law may declare.
pub const MAX_INPUTS: usize = 16;

/// A model made ready to run.
#[derive(Debug)]
pub struct Plant {
    tape: Tape,
    layout: Layout,
    /// What a force on each axis accelerates, where masses do not change.
    mobility: Option<Matrix4<f64>>,
    input_names: Vec<String>,
    /// Coefficients that are data, given with each state; all others are folded into the tape.
    open: Vec<String>,
    input_defaults: Vec<Option<f64>>,
    lags_s: Vec<(usize, f64)>,
    bands: Vec<(usize, f64)>,
}

/// Where the outputs stand on the tape.
#[derive(Debug, Clone, Default)]
struct Layout {
    /// Forces by axis in the order X, Y, K, N; absent axes have none.
    forces: [Option<usize>; 4],
    /// Mass matrix entries in the same order.
    mass: [[Option<usize>; 4]; 4],
    /// Rates of x, y, psi, phi where the law says them.
    kinematics: [Option<usize>; 4],
    /// What effects add to the accelerations, in the same order.
    accelerations: [Option<usize>; 4],
    /// How far the motion is outside of what trials covered.
    distance: Option<usize>,
}

impl Plant {
    /// Lowers a model onto a tape, with the effects that it carries.
    ///
    /// # Errors
    /// Names what the model does not give, or says that the mass matrix cannot be solved.
    pub fn new(model: &Model, law: &Law) -> Result<Self, PlantError> {
        Self::of(&EquationsOfMotion::new(model, law)?, Coefficients::Values)
    }

    /// As [`Plant::new`], for any values of the coefficients that the model has: its own are not
    /// read.
    ///
    /// # Errors
    /// As [`Plant::new`].
    pub fn open(model: &Model, law: &Law) -> Result<Self, PlantError> {
        Self::of(&EquationsOfMotion::new(model, law)?, Coefficients::Names)
    }

    /// As [`Plant::new`], of equations that are set up already.
    ///
    /// # Errors
    /// As [`Plant::new`].
    pub fn of(
        equations: &EquationsOfMotion<'_>,
        coefficients: Coefficients,
    ) -> Result<Self, PlantError> {
        Self::with_distance(equations, coefficients, None)
    }

    /// As [`Plant::of`], with a formula of how far the motion is outside of what trials covered.
    ///
    /// # Errors
    /// As [`Plant::new`].
    pub fn with_distance(
        equations: &EquationsOfMotion<'_>,
        coefficients: Coefficients,
        distance: Option<&Expr>,
    ) -> Result<Self, PlantError> {
        let (model, law) = (equations.model(), equations.law());
        check_inputs(law)?;
        let open: Vec<String> = match coefficients {
            Coefficients::Values => Vec::new(),
            Coefficients::Names => model.coefficients.keys().cloned().collect(),
        };
        let names: Vec<String> =
            equations.names().into_iter().chain(open.iter().cloned()).collect();
        let mut lowering = Lowering::new(equations, &names);
        let mut layout = lay_out(equations, &mut lowering, coefficients)?;
        layout.distance = distance.map(|distance| lowering.output(distance)).transpose()?;
        let tape = lowering.finish();
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
            lags_s: by_input(equations, &equations.law().dressing.lags)?,
            bands: by_input(equations, &equations.law().dressing.bands)?,
        })
    }

    /// The inputs that the law takes, in their order.
    pub fn input_names(&self) -> &[String] {
        &self.input_names
    }

    /// The coefficients that are given with each state, in their order.
    pub fn open_coefficients(&self) -> &[String] {
        &self.open
    }

    /// Inputs that reach the ship through a lag: their place and its time constant, s.
    pub fn lags_s(&self) -> &[(usize, f64)] {
        &self.lags_s
    }

    /// Half widths of the dead bands of inputs, by the input's place.
    pub fn bands(&self) -> &[(usize, f64)] {
        &self.bands
    }

    /// Whether the law has roll.
    pub fn has_roll(&self) -> bool {
        self.layout.forces[2].is_some()
    }

    /// The default of each input.
    pub fn input_defaults(&self) -> &[Option<f64>] {
        &self.input_defaults
    }
}

/// Refuses a law that takes more than [`Inputs`] have room for.
pub(crate) fn check_inputs(law: &Law) -> Result<(), PlantError> {
    if law.inputs.len() > MAX_INPUTS {
        return Err(PlantError::Inputs { law: law.name.clone(), most: MAX_INPUTS });
    }
    Ok(())
}

fn lay_out(
    equations: &EquationsOfMotion<'_>,
    lowering: &mut Lowering<'_>,
    coefficients: Coefficients,
) -> Result<Layout, PlantError> {
    let law = equations.law();
    let mut layout = Layout::default();
    for (row, axis) in Axis::ALL.into_iter().enumerate() {
        if law.axes.contains_key(&axis) {
            layout.forces[row] = Some(lowering.output(&equations.force(axis, coefficients)?)?);
        }
        for (column, other) in Axis::ALL.into_iter().enumerate() {
            layout.mass[row][column] = lowering.mass(axis, other)?;
        }
    }
    for (place, name) in ["x", "y", "psi", "phi"].into_iter().enumerate() {
        if let Some(expr) = law.kinematics.get(name) {
            layout.kinematics[place] = Some(lowering.output(expr)?);
        }
    }
    for (axis, expr) in &law.dressing.accelerations {
        let place = &mut layout.accelerations[*axis as usize];
        *place = Some(lowering.sum(*place, expr)?);
    }
    Ok(layout)
}

/// Figures of inputs by the input's place, none below zero.
fn by_input(
    equations: &EquationsOfMotion<'_>,
    figures: &[(String, Expr)],
) -> Result<Vec<(usize, f64)>, PlantError> {
    let law = equations.law();
    let one = |(input, expr): &(String, Expr)| {
        let place = law.inputs.get_index_of(input)?;
        let mut lowering = Lowering::new(equations, &[]);
        let lowered = lowering.output(expr);
        Some(lowered.map(|_| (place, lowering.finish().values(&[])[0].max(0.0))))
    };
    figures.iter().filter_map(one).collect()
}

fn constant_mass(tape: &Tape, layout: &Layout) -> Option<Matrix4<f64>> {
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
