//! Similarity of ships of the zoo to a new one, and their eligibility as its source.

mod characteristic;
mod eligibility;

pub use characteristic::{CharacteristicVector, Definition, NormalisedComponents};
pub use eligibility::{
    Eligibility, EligibilityLimits, ModelHead, RankedSource, SourceCandidate, Trend, rank,
};
