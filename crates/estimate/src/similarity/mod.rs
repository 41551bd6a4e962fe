//! Which ship of the zoo is most like a new one, and whether she may serve as her source.

mod characteristic;
mod eligibility;

pub use characteristic::{CharacteristicVector, Definition};
pub use eligibility::{
    Eligibility, EligibilityLimits, ModelHead, RankedSource, SourceCandidate, Trend, rank,
};
