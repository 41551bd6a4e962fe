//! Families of ships: starting models of the members, the prior of the family, and the refinement
//! of all members.

mod asked;
mod choices;
mod drift;
mod family_drift;
mod frame;
mod kept;
mod learned;
mod member;
mod members;
mod order;
mod recent_drift;
mod refined;
mod standing;

pub use asked::{Asked, OrderError, order_refinement};
pub use choices::{PriorChoice, Rule, Start};
pub use drift::{Drift, TrialResidual, left_of_newest};
pub use family_drift::{FamilyDrift, MemberDrift};
pub use frame::{Framed, Frames};
pub use kept::statistics_of;
pub use learned::{LEARN, LearnJob, learn, trials_of};
pub use member::{Member, Outcome, kept, member, refine};
pub use order::{BULK, Chunk, Loaded, Order};
pub use refined::{Gathered, derived, refined};
pub use standing::Standing;
