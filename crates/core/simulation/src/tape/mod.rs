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

pub use instruction::{Tape, TapeInstruction};
pub use lower::{NameBinding, TapeBuilder, UnboundName};
pub use op::{ResultSlot, TapeOp};
pub use slots::{LaneValues, TapeResults};
pub use tangent::{InputDirection, LocalSlopes};
