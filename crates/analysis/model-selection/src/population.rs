//! The ships of a population.

use sistership_identification::refine::PopulationShip;
use sistership_model::vessel::Status;
use sistership_model::{Model, Vessel, Zoo};
use sistership_priors::similarity::RankedSource;
use sistership_priors::source::{SimilarityRanking, rank_similar};

use crate::candidate::POPULATION_LAW;
use crate::thresholds::SEARCH;

/// Returns other ships of the zoo with their published models, by rank of similarity, of all
/// categories. Estimates from particulars are excluded, since they show what formulas have in
/// common, not ships. Refined models are excluded, since the trials of one ship belong to another's
/// provenance only if it is its source.
pub fn similar_population(zoo: &Zoo, target: &Vessel) -> Vec<PopulationShip> {
    let ranking = rank_similar(zoo, target, None, &[]).ranking;
    let others = ranking.iter().filter(|ranked| ranked.ship != target.name());
    let models = others.filter_map(|ranked| published_model(zoo, zoo.vessel(&ranked.ship)?));
    let member = |model: Model| Some(PopulationShip { law: zoo.law(&model.law)?.clone(), model });
    models.filter_map(member).take(SEARCH.population).collect()
}

/// Returns the ship of a population at the states of whose manoeuvres all are evaluated: the first
/// that is eligible as a source, otherwise the most similar one. Its law must differ from the law
/// that is fitted. The choice does not depend on other possible sources: at the states of a poor
/// model a population has other accelerations.
pub fn envelope_source<'a>(
    population: &'a [PopulationShip],
    similarity: &SimilarityRanking,
) -> Option<&'a Model> {
    let across = || population.iter().map(|of| &of.model).filter(|of| of.law != POPULATION_LAW);
    let eligible = |ranked: &RankedSource| across().find(|of| of.ship == ranked.ship);
    similarity.eligible_sources().find_map(eligible).or_else(|| across().next())
}

/// The first published model of a vessel.
fn published_model(zoo: &Zoo, vessel: &Vessel) -> Option<Model> {
    let measured = vessel.file.models.iter().find(|model| model.status == Status::Published)?;
    zoo.published_model(vessel, Some(&measured.name)).ok()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use std::collections::BTreeMap;

    use sistership_priors::source::rank_similar_with;

    use super::*;

    #[test]
    fn a_population_is_of_published_models_of_other_ships() {
        let zoo = Zoo::load_embedded().unwrap();
        let all = similar_population(&zoo, zoo.vessel("kcs").unwrap());
        assert!(all.iter().all(|of| of.model.status == Status::Published));
        let has = |ship: &str| all.iter().any(|of| of.model.ship == ship);
        assert!(has("mariner") && !has("kcs"));
        assert!(!has("seiun-maru"), "an estimate from particulars");
    }

    #[test]
    fn all_are_asked_at_the_states_of_an_eligible_member_of_another_law() {
        let zoo = Zoo::load_embedded().unwrap();
        for ship in ["kvlcc2", "kcs", "mariner"] {
            let target = zoo.vessel(ship).unwrap();
            let all = similar_population(&zoo, target);
            let similarity = rank_similar_with(&zoo, target, None, &[], &BTreeMap::new());
            let at = envelope_source(&all, &similarity).unwrap();
            assert!(at.law != POPULATION_LAW && at.status == Status::Published);
            assert!(similarity.eligible_sources().any(|ranked| ranked.ship == at.ship), "{ship}");
            let ineligible = SimilarityRanking { ranking: Vec::new(), ..similarity };
            assert_eq!(envelope_source(&all, &ineligible).unwrap().name, all[0].model.name);
        }
    }
}
