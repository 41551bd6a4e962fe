//! The tape: formulas as one flat list of operations, evaluated for a block of lanes at a time.
//!
//! Lowering shares common subexpressions and folds constants, so that a model's coefficients and particulars cost
//! nothing per step. Lanes are states, trials, ships or tangent directions in lockstep.

mod derive;
mod eval;
mod hoist;
mod lower;
mod op;

pub use eval::Lanes;
pub use lower::{Binding, TapeBuilder};
pub(crate) use op::Op;
pub use op::Slot;

/// A list of operations with named inputs and numbered outputs.
#[derive(Debug, Clone, Default)]
pub struct Tape {
    inputs: Vec<String>,
    ops: Vec<Op>,
    outputs: Vec<Slot>,
}

impl Tape {
    /// The names of the inputs, in the order in which values are given.
    pub fn inputs(&self) -> &[String] {
        &self.inputs
    }

    /// How many operations it takes.
    pub fn len(&self) -> usize {
        self.ops.len()
    }

    /// Whether it computes nothing.
    pub fn is_empty(&self) -> bool {
        self.ops.is_empty()
    }

    /// The value of an output that does not depend on the inputs.
    pub fn constant_output(&self, output: usize) -> Option<f64> {
        match self.ops[self.outputs[output] as usize] {
            Op::Constant(value) => Some(value),
            _ => None,
        }
    }
}
