//! Tape in its final form: instructions in the order of their evaluation.

use super::{ResultSlot, TapeOp};

/// One instruction of a tape.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TapeInstruction {
    /// One operation.
    Op(TapeOp),
    /// A result plus the products of a range of the [terms](Tape::terms), added one after the
    /// other.
    Products {
        /// Slot to which the products are added.
        first: ResultSlot,
        /// Index of the first term.
        from: u32,
        /// Index after the last term.
        to: u32,
    },
}

/// List of instructions with named inputs and numbered outputs.
#[derive(Debug, Clone, Default)]
pub struct Tape {
    pub(super) inputs: Vec<String>,
    pub(super) instructions: Vec<TapeInstruction>,
    /// Pairs of factors of the sums of products.
    pub(super) terms: Vec<[ResultSlot; 2]>,
    pub(super) outputs: Vec<ResultSlot>,
}

impl Tape {
    /// Names of the inputs, in the order of their values.
    pub fn input_names(&self) -> &[String] {
        &self.inputs
    }

    /// Instructions in the order of their evaluation; each reads earlier results by their slots.
    pub fn instructions(&self) -> &[TapeInstruction] {
        &self.instructions
    }

    /// Pairs of factors of the sums of products, which [`Instruction::Products`] indexes.
    pub fn product_terms(&self) -> &[[ResultSlot; 2]] {
        &self.terms
    }

    /// Slot of the instruction that computes an output.
    pub fn output_slot(&self, output: usize) -> ResultSlot {
        self.outputs[output]
    }

    /// Number of instructions.
    pub fn len(&self) -> usize {
        self.instructions.len()
    }

    /// Returns true if the tape has no instructions.
    pub fn is_empty(&self) -> bool {
        self.instructions.is_empty()
    }

    /// Value of an output that does not depend on the inputs; `None` for any other output.
    pub fn constant_output(&self, output: usize) -> Option<f64> {
        match self.instructions[self.outputs[output] as usize] {
            TapeInstruction::Op(TapeOp::Constant(value)) => Some(value),
            _ => None,
        }
    }
}
