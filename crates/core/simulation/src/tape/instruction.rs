//! A tape as it is kept: instructions in the order in which they are evaluated.

use super::{Op, Slot};

/// What a tape does at one place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Instruction {
    /// One operation.
    Op(Op),
    /// A result, and added to it one after the other the products of the [terms](Tape::terms) from
    /// a place to another.
    Products {
        /// What the products are added to.
        first: Slot,
        /// The place of the first term.
        from: u32,
        /// The place after the last one.
        to: u32,
    },
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

    /// What it does, in this order; each reads results of earlier ones by their place.
    pub fn instructions(&self) -> &[Instruction] {
        &self.instructions
    }

    /// The pairs of factors of sums of products, by which [`Instruction::Products`] counts.
    pub fn terms(&self) -> &[[Slot; 2]] {
        &self.terms
    }

    /// The place of the instruction that gives an output.
    pub fn slot(&self, output: usize) -> Slot {
        self.outputs[output]
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
