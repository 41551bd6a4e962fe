//! Families of ships: what their members are refined from, what they teach, and the refinement of all of them.

mod asked;
mod drift;
mod frame;
mod kept;
mod learned;
mod order;
mod refined;
mod standing;

pub use asked::{Asked, PriorChoice, Rule, Start, order_refinement};
pub use drift::{Drift, TrialResidual};
pub use learned::{LearnJob, learn};
pub use order::{Order, PriorName};
pub use refined::FamilyRecipe;
pub use standing::Standing;

pub(crate) use asked::queue;
pub(crate) use frame::Frames;
pub(crate) use kept::statistics_of;
pub(crate) use learned::{LEARN, trials_of};
pub(crate) use order::{BULK, Chunk, Loaded};
pub(crate) use refined::{Gathered, derived, refined};
