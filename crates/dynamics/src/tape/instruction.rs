//! A tape as it is kept: instructions in the order in which they are evaluated.

use super::{Op, Slot};

/// What a tape does at one place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Instruction {
    /// One operation.
    Op(Op),
    /// A result, and added to it one after the other the products of the [terms](Tape) from a place
    /// to another.
    Products { first: Slot, from: u32, to: u32 },
}

/// A list of instructions with named inputs and numbered outputs.
#[derive(Debug, Clone, Default)]
pub struct Tape {
    pub(super) inputs: Vec<String>,
    pub(super) instructions: Vec<Instruction>,
    /// Factors of the sums of products.
    pub(super) terms: Vec<[Slot; 2]>,
    pub(super) outputs: Vec<Slot>,
}

impl Tape {
    /// The names of the inputs, in the order in which values are given.
    pub fn inputs(&self) -> &[String] {
        &self.inputs
    }

    /// How many instructions it takes.
    pub fn len(&self) -> usize {
        self.instructions.len()
    }

    /// Whether it computes nothing.
    pub fn is_empty(&self) -> bool {
        self.instructions.is_empty()
    }

    /// The value of an output that does not depend on the inputs.
    pub fn constant_output(&self, output: usize) -> Option<f64> {
        match self.instructions[self.outputs[output] as usize] {
            Instruction::Op(Op::Constant(value)) => Some(value),
            _ => None,
        }
    }
}
