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

pub use asked::{BulkRefinementRequest, OrderError, order_refinement};
pub use choices::{PriorChoice, Rule, Start};
pub use drift::{Drift, TrialResidual, residuals_of_newest};
pub use family_drift::{FamilyDrift, MemberDrift};
pub use frame::{StartingModel, StartingModels};
pub use kept::trial_statistics;
pub use learned::{LearnJob, PRIOR_JOB_KIND, learn_family_prior, recipe_trials};
pub use member::{BulkMember, MemberOutcome, load_member, member_outcome, refine_or_explain};
pub use order::{BULK_JOB_KIND, BulkChunk, BulkOrder, LoadedOrder};
pub use refined::{MemberInputs, derive_member, refine_member};
pub use standing::BulkProgress;
