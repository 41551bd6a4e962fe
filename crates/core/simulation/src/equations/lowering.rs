//! Lowering of the formulas of the equations of motion to a tape.

use sistership_formula::Expr;
use sistership_model::coefficient::Axis;

use super::definition::EquationsOfMotion;
use super::plant_error::PlantError;
use crate::tape::{Tape, TapeBuilder, UnboundName};

/// Builder of the tape for one view of the equations of motion. Outputs are numbered in the order
/// in which they are added.
pub struct EquationLowering<'e> {
    equations: &'e EquationsOfMotion<'e>,
    builder: TapeBuilder<'e>,
}

impl<'e> EquationLowering<'e> {
    /// Creates a builder for a tape with the inputs `names`; other names are resolved by the
    /// equations.
    pub fn new(equations: &'e EquationsOfMotion<'e>, names: &[String]) -> Self {
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        Self {
            equations,
            builder: TapeBuilder::new(&names, |name: &str| equations.name_binding(name)),
        }
    }

    /// Adds an output and returns its number.
    ///
    /// # Errors
    /// Returns an error that names what the model does not give.
    pub fn add_output(&mut self, expr: &Expr) -> Result<usize, PlantError> {
        self.builder.add_output(expr).map_err(|unbound| missing_name_error(self.equations, unbound))
    }

    /// Adds a formula to an existing output, or a new output if `output` is `None`.
    ///
    /// # Errors
    /// Returns an error that names what the model does not give.
    pub fn add_to_output(
        &mut self,
        output: Option<usize>,
        expr: &Expr,
    ) -> Result<usize, PlantError> {
        self.builder
            .add_to_output(output, expr)
            .map_err(|unbound| missing_name_error(self.equations, unbound))
    }

    /// Adds the derivative of an output with respect to a name; `None` if it is zero.
    pub fn add_derivative(&mut self, output: usize, name: &str) -> Option<usize> {
        self.builder.add_derivative(output, name)
    }

    /// Adds an entry of the mass matrix; `None` if the law has none there, which means zero.
    ///
    /// # Errors
    /// Returns an error that names what the model does not give.
    pub fn add_mass_entry(&mut self, row: Axis, column: Axis) -> Result<Option<usize>, PlantError> {
        let equations = self.equations;
        equations.law().mass.get(&(row, column)).map(|expr| self.add_output(expr)).transpose()
    }

    /// Adds the mass matrix over some axes; returns its outputs row by row.
    ///
    /// # Errors
    /// Returns an error that names what the model does not give.
    pub fn add_mass_matrix(&mut self, axes: &[Axis]) -> Result<Vec<Option<usize>>, PlantError> {
        let pairs = axes.iter().flat_map(|&row| axes.iter().map(move |&column| (row, column)));
        pairs.map(|(row, column)| self.add_mass_entry(row, column)).collect()
    }

    /// Adds the accelerations that effects contribute on each of some axes.
    ///
    /// # Errors
    /// Returns an error that names what the model does not give.
    pub fn add_effect_accelerations(
        &mut self,
        axes: &[Axis],
    ) -> Result<Vec<Option<usize>>, PlantError> {
        let equations = self.equations;
        axes.iter()
            .map(|&axis| {
                equations.added_acceleration(axis).map(|sum| self.add_output(&sum)).transpose()
            })
            .collect()
    }

    /// Returns the finished tape, without operations that no output needs.
    pub fn finish(self) -> Tape {
        self.builder.finish()
    }

    /// Returns the finished tape in two parts, as [`TapeBuilder::finish_hoisted`] does.
    pub fn finish_hoisted(self, from: usize) -> (Tape, Tape) {
        self.builder.finish_hoisted(from)
    }
}

fn missing_name_error(
    equations: &EquationsOfMotion<'_>,
    UnboundName(name): UnboundName,
) -> PlantError {
    PlantError::Missing {
        law: equations.law().name.clone(),
        name,
        model: equations.model().name.clone(),
    }
}
