//! Families of ships: starting models of the members, the prior of the family, and the refinement
//! of all members.

mod bulk_progress;
mod choices;
mod drift;
mod family_drift;
mod family_prior;
mod frame;
mod member;
mod members;
mod order;
mod recent_drift;
mod refined;
mod request;
mod stored_statistics;

pub use bulk_progress::BulkProgress;
pub use choices::{PriorChoice, Rule, Start};
pub use drift::{Drift, TrialResidual, residuals_of_newest};
pub use family_drift::{FamilyDrift, MemberDrift};
pub use family_prior::{LearnJob, PRIOR_JOB_KIND, learn_family_prior, recipe_trials};
pub use frame::{StartingModel, StartingModels};
pub use member::{BulkMember, MemberOutcome, load_member, member_outcome, refine_or_explain};
pub use order::{BULK_JOB_KIND, BulkChunk, BulkOrder, LoadedOrder};
pub use refined::{MemberInputs, derive_member, refine_member};
pub use request::{BulkRefinementRequest, OrderError, order_refinement};
pub use stored_statistics::trial_statistics;
