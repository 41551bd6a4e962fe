//! The tape: formulas as one flat list of operations, evaluated for a block of lanes at a time.
//!
//! Lowering shares common subexpressions and folds constants, so that a model's coefficients and particulars cost
//! nothing per step. Lanes are states, trials, ships or tangent directions in lockstep.

mod derive;
mod eval;
mod fuse;
mod hoist;
mod listing;
mod lower;
mod op;
mod slots;
mod tangent;
#[cfg(test)]
mod testing;

pub(crate) use fuse::Instruction;
use listing::Listing;
pub use lower::{Binding, TapeBuilder};
pub(crate) use op::Op;
pub use op::Slot;
pub use slots::{Lanes, Slots};

/// A list of instructions with named inputs and numbered outputs.
#[derive(Debug, Clone, Default)]
pub struct Tape {
    inputs: Vec<String>,
    instructions: Vec<Instruction>,
    /// Factors of the sums of products.
    terms: Vec<[Slot; 2]>,
    outputs: Vec<Slot>,
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
