//! Tape: formulas as one flat list of operations, evaluated for a block of lanes at a time.
//!
//! Lowering shares common subexpressions and folds constants, so that a model's coefficients and
//! particulars cost nothing per step. Lanes are states, trials, ships or tangent directions in
//! lockstep.

mod derive;
mod eval;
mod fuse;
mod hoist;
mod instruction;
mod listing;
mod lower;
mod op;
mod slots;
mod tangent;
#[cfg(test)]
mod testing;

pub use instruction::{Instruction, Tape};
pub use lower::{Binding, TapeBuilder, Unbound};
pub use op::{Op, Slot};
pub use slots::{Lanes, Slots};
pub use tangent::{Direction, Slopes};
