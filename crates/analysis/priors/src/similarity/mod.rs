//! Which ship of the zoo is most like a new one, and whether it may serve as its source.

mod characteristic;
mod eligibility;

pub use characteristic::{CharacteristicVector, Definition, NormalisedComponents};
pub use eligibility::{
    Eligibility, EligibilityLimits, ModelHead, RankedSource, SourceCandidate, Trend, rank,
};
