//! Formulas of the equations of motion on a tape.

use sistership_formula::Expr;
use sistership_model::coefficient::Axis;

use super::definition::EquationsOfMotion;
use super::refusal::PlantError;
use crate::tape::{Tape, TapeBuilder, Unbound};

/// A tape of a view of the equations of motion, while it is built. Outputs are numbered in the
/// order in which they are added.
pub struct Lowering<'e> {
    equations: &'e EquationsOfMotion<'e>,
    builder: TapeBuilder<'e>,
}

impl<'e> Lowering<'e> {
    /// A tape that takes `names`; everything else is what it stands for in the equations.
    pub fn new(equations: &'e EquationsOfMotion<'e>, names: &[String]) -> Self {
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        Self { equations, builder: TapeBuilder::new(&names, |name: &str| equations.binding(name)) }
    }

    /// Adds an output and returns its number.
    ///
    /// # Errors
    /// Names what the model does not give.
    pub fn output(&mut self, expr: &Expr) -> Result<usize, PlantError> {
        self.builder.output(expr).map_err(|unbound| missing(self.equations, unbound))
    }

    /// Adds a formula to an output that may be there already.
    ///
    /// # Errors
    /// Names what the model does not give.
    pub fn sum(&mut self, output: Option<usize>, expr: &Expr) -> Result<usize, PlantError> {
        self.builder.sum(output, expr).map_err(|unbound| missing(self.equations, unbound))
    }

    /// Adds the derivative of an output by a name; `None` where it is zero.
    pub fn derivative(&mut self, output: usize, name: &str) -> Option<usize> {
        self.builder.derivative(output, name)
    }

    /// An entry of the mass matrix; `None` where the law has none there, which is zero.
    ///
    /// # Errors
    /// Names what the model does not give.
    pub fn mass(&mut self, row: Axis, column: Axis) -> Result<Option<usize>, PlantError> {
        let equations = self.equations;
        equations.law().mass.get(&(row, column)).map(|expr| self.output(expr)).transpose()
    }

    /// The mass matrix over some axes, row by row.
    ///
    /// # Errors
    /// Names what the model does not give.
    pub fn mass_matrix(&mut self, axes: &[Axis]) -> Result<Vec<Option<usize>>, PlantError> {
        let pairs = axes.iter().flat_map(|&row| axes.iter().map(move |&column| (row, column)));
        pairs.map(|(row, column)| self.mass(row, column)).collect()
    }

    /// What effects add to the acceleration of each of some axes.
    ///
    /// # Errors
    /// Names what the model does not give.
    pub fn additions(&mut self, axes: &[Axis]) -> Result<Vec<Option<usize>>, PlantError> {
        let equations = self.equations;
        axes.iter()
            .map(|&axis| equations.addition(axis).map(|sum| self.output(&sum)).transpose())
            .collect()
    }

    /// The finished tape, without operations that no output needs.
    pub fn finish(self) -> Tape {
        self.builder.finish()
    }

    /// The finished tape in two parts, as [`TapeBuilder::finish_hoisted`].
    pub fn finish_hoisted(self, from: usize) -> (Tape, Tape) {
        self.builder.finish_hoisted(from)
    }
}

fn missing(equations: &EquationsOfMotion<'_>, Unbound(name): Unbound) -> PlantError {
    PlantError::Missing {
        law: equations.law().name.clone(),
        name,
        model: equations.model().name.clone(),
    }
}
