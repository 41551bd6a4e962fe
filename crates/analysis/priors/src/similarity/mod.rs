//! Similarity of ships of the zoo to a new one, and their eligibility as its source.

mod characteristic;
mod eligibility;

pub use characteristic::{
    CharacteristicVector, NormalisedComponents, VectorDefinition, component_particular,
};
pub use eligibility::{
    Eligibility, EligibilityLimits, ModelHead, RankedSource, SourceCandidate, TrendMeasure,
    rank_candidates,
};
