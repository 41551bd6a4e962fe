//! The ships of which a population is made.

use sistership_estimate::refine::Member;
use sistership_model::{Model, Vessel, Zoo};
use sistership_sources::source::similar;

use crate::thresholds::SEARCH;

/// Other ships of the zoo with their published models, by rank of similarity, whatever their
/// category. Refined models are left out: what one ship's trials say is no part of another's
/// provenance unless it is its source.
pub fn population(zoo: &Zoo, target: &Vessel) -> Vec<Member> {
    let ranking = similar(zoo, target, None, &[]).ranking;
    let others = ranking.iter().filter(|ranked| ranked.ship != target.name());
    let models = others.filter_map(|ranked| zoo.published(zoo.vessel(&ranked.ship)?, None).ok());
    let member = |model: Model| Some(Member { law: zoo.law(&model.law)?.clone(), model });
    models.filter_map(member).take(SEARCH.population).collect()
}
