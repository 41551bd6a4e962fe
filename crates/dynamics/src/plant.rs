//! A model made ready to run: its law and figures on one tape.

mod rate;

use std::borrow::Cow;

use nalgebra::{LU, Matrix4};
use sistership_model::Model;
use sistership_model::coefficient::Axis;
use sistership_model::formula::Expr;
use sistership_model::law::{Law, STATES};
use sistership_model::particulars;

use crate::tape::{Binding, Tape, TapeBuilder};

pub use rate::Work;

/// Why a model cannot be made ready.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum PlantError {
    /// A formula needs a particular or parameter that the model does not have.
    #[error("law `{law}` needs `{name}`, which the model `{model}` does not give")]
    Missing {
        /// The law.
        law: String,
        /// The name without a value.
        name: String,
        /// The model.
        model: String,
    },
    /// The mass matrix cannot be solved.
    #[error("the mass matrix of `{0}` is singular or not positive: check mass, inertia and added masses")]
    Mass(String),
    /// A coefficient or its formula does not fit the law.
    #[error("{0}")]
    Law(String),
}

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
}

impl Plant {
    /// Lowers a model onto a tape, with the effects that it carries.
    ///
    /// # Errors
    /// Names what the model does not give, or says that the mass matrix cannot be solved.
    pub fn new(model: &Model, law: &Law) -> Result<Self, PlantError> {
        Self::lowered(model, law, Vec::new())
    }

    /// As [`Plant::new`], for any values of the coefficients that the model has: its own are not read.
    ///
    /// # Errors
    /// As [`Plant::new`].
    pub fn open(model: &Model, law: &Law) -> Result<Self, PlantError> {
        Self::lowered(model, law, model.coefficients.keys().cloned().collect())
    }

    fn lowered(model: &Model, law: &Law, open: Vec<String>) -> Result<Self, PlantError> {
        let law = &dressed(model, law)?;
        let bind = |name: &str| binding(model, law, name);
        let states = STATES.iter().map(|&(name, _)| name);
        let names: Vec<&str> =
            states.chain(law.inputs.keys().map(String::as_str)).chain(open.iter().map(String::as_str)).collect();
        if law.inputs.len() > MAX_INPUTS {
            return Err(PlantError::Law(format!("law `{}` has more than {MAX_INPUTS} inputs", law.name)));
        }
        let mut builder = TapeBuilder::new(&names, &bind);
        let missing = |name: String| PlantError::Missing { law: law.name.clone(), name, model: model.name.clone() };
        let layout = lay_out(model, law, &mut builder, (!open.is_empty(), &missing))?;
        let tape = builder.finish();
        let mobility = match constant_mass(&tape, &layout).map(LU::new) {
            Some(lu) if lu.determinant() > 0.0 => Some(lu.try_inverse().ok_or_else(|| PlantError::Mass(model.name.clone()))?),
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
            lags_s: lags(model, law, &missing)?,
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

    /// Whether the law has roll.
    pub fn has_roll(&self) -> bool {
        self.layout.forces[2].is_some()
    }

    /// The default of each input.
    pub fn input_defaults(&self) -> &[Option<f64>] {
        &self.input_defaults
    }
}

/// What a name of the law stands for in a model.
pub fn binding(model: &Model, law: &Law, name: &str) -> Option<Binding> {
    if let Some(expr) = law.values.get(name) {
        return Some(Binding::Formula(expr.clone()));
    }
    let of_effect = law.dressing.parameters.get(name).copied();
    let parameter = of_effect.or_else(|| model.parameters.get(name).map(|quantity| quantity.value));
    parameter.or_else(|| particulars::value(&model.particulars, name)).map(Binding::Constant)
}

fn lay_out(
    model: &Model,
    law: &Law,
    builder: &mut TapeBuilder<'_>,
    (open, missing): (bool, &dyn Fn(String) -> PlantError),
) -> Result<Layout, PlantError> {
    let mut layout = Layout::default();
    for (row, axis) in Axis::ALL.into_iter().enumerate() {
        if law.axes.contains_key(&axis) {
            let force = if open { open_force(model, law, axis) } else { force(model, law, axis) }?;
            layout.forces[row] = Some(builder.output(&force).map_err(missing)?);
        }
        for (column, other) in Axis::ALL.into_iter().enumerate() {
            if let Some(expr) = law.mass.get(&(axis, other)) {
                layout.mass[row][column] = Some(builder.output(expr).map_err(missing)?);
            }
        }
    }
    for (place, name) in ["x", "y", "psi", "phi"].into_iter().enumerate() {
        if let Some(expr) = law.kinematics.get(name) {
            layout.kinematics[place] = Some(builder.output(expr).map_err(missing)?);
        }
    }
    for (axis, expr) in &law.dressing.accelerations {
        let place = &mut layout.accelerations[*axis as usize];
        *place = Some(builder.sum(*place, expr).map_err(missing)?);
    }
    Ok(layout)
}

/// The law with the effects that a model carries.
pub fn dressed<'a>(model: &Model, law: &'a Law) -> Result<Cow<'a, Law>, PlantError> {
    if model.effects.is_empty() {
        return Ok(Cow::Borrowed(law));
    }
    law.with_effects(model).map(Cow::Owned).map_err(|(field, message)| PlantError::Law(format!("{field}: {message}")))
}

fn lags(model: &Model, law: &Law, missing: &dyn Fn(String) -> PlantError) -> Result<Vec<(usize, f64)>, PlantError> {
    let one = |(input, expr): &(String, Expr)| {
        let place = law.inputs.get_index_of(input)?;
        let bind = |name: &str| binding(model, law, name);
        let mut builder = TapeBuilder::new(&[], &bind);
        let tape = builder.output(expr).map_err(missing).map(|_| builder.finish());
        Some(tape.map(|tape| (place, tape.values(&[])[0].max(0.0))))
    };
    law.dressing.lags.iter().filter_map(one).collect()
}

/// The whole right-hand side of an axis, in N (N m): coefficients times regressors, and the rest.
///
/// # Errors
/// Names the coefficient that the law does not have.
pub fn force(model: &Model, law: &Law, axis: Axis) -> Result<Expr, PlantError> {
    let given = model.coefficients.iter().filter(|(_, quantity)| quantity.value != 0.0);
    summed(law, axis, given.map(|(name, quantity)| (name, Expr::Number(quantity.value))))
}

/// As [`force`], by the names of the coefficients.
fn open_force(model: &Model, law: &Law, axis: Axis) -> Result<Expr, PlantError> {
    summed(law, axis, model.coefficients.keys().map(|name| (name, Expr::Name(name.clone()))))
}

fn summed<'n>(law: &Law, axis: Axis, factors: impl Iterator<Item = (&'n String, Expr)>) -> Result<Expr, PlantError> {
    let axis_law = &law.axes[&axis];
    let mut sum = Expr::Number(0.0);
    for (name, factor) in factors {
        let (acts_on, term) = law.term(name).map_err(PlantError::Law)?;
        if acts_on == axis {
            sum = Expr::Add(Box::new(sum), Box::new(term.times(factor)));
        }
    }
    Ok(Expr::Add(Box::new(axis_law.scale.clone().times(sum)), Box::new(axis_law.rest.clone())))
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
