//! Selection of the source model of a refinement: `auto`, a ship, or one of its models.

use std::borrow::Cow;
use std::collections::BTreeMap;

use serde::Serialize;
use sistership_model::categories::{category_group, known_categories};
use sistership_model::law::Law;
use sistership_model::trial::{Channel, Trial};
use sistership_model::{FileError, Model, Vessel, Zoo};

use crate::similarity::{
    CharacteristicVector, EligibilityLimits, ModelHead, RankedSource, SourceCandidate,
    VectorDefinition, component_particular, rank_candidates,
};
use crate::transfer::{transfer_model, trial_approach};
use crate::trend::{TrendError, trend_correlation};

/// Ranking of similar ships for a target.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SimilarityRanking {
    /// Name of the target.
    pub target: String,
    /// Category of the target.
    #[serde(skip)]
    pub category: String,
    /// Definition of the characteristic vector.
    pub definition: VectorDefinition,
    /// Vector of the target.
    pub vector: BTreeMap<String, f64>,
    /// Candidates, most similar first.
    pub ranking: Vec<RankedSource>,
}

impl SimilarityRanking {
    /// Returns the particulars that give components which the target's vector lacks.
    pub fn missing_particulars(&self) -> Vec<&'static str> {
        let vector =
            CharacteristicVector { definition: self.definition, values: self.vector.clone() };
        let missing = vector.missing_components();
        missing.into_iter().filter_map(component_particular).collect()
    }

    /// Ships that pass every step, most similar first.
    pub fn eligible_sources(&self) -> impl Iterator<Item = &RankedSource> {
        self.ranking.iter().filter(|ranked| ranked.eligible)
    }
}

/// Error of the selection of a source.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SourceError {
    /// No ship of the ranking passes every step.
    #[error("no ship of the zoo is an eligible source for `{target}`; {reasons}")]
    NotEligible {
        /// The target.
        target: String,
        /// Each ship with the step that it failed.
        reasons: String,
    },
    /// The zoo's own file of the best ship is invalid.
    #[error(transparent)]
    Zoo(#[from] FileError),
}

/// Definition by which ships are compared with a target: Mei's where the target has all of its
/// components, otherwise Kanazawa's.
pub fn definition_for(target: &Vessel) -> VectorDefinition {
    let complete = CharacteristicVector::from_vessel(target, VectorDefinition::Mei2019)
        .missing_components()
        .is_empty();
    if complete { VectorDefinition::Mei2019 } else { VectorDefinition::Kanazawa2023 }
}

/// Ranks the zoo for a target. Default definition: that of [`definition_for`]. With `trials`, the
/// third step of eligibility is measured.
pub fn rank_similar(
    zoo: &Zoo,
    target: &Vessel,
    definition: Option<VectorDefinition>,
    trials: &[&Trial],
) -> SimilarityRanking {
    rank_similar_with(zoo, target, definition, trials, &BTreeMap::new())
}

/// Ranks the zoo for a target, where some ships have a better model than their published one, by
/// their names.
pub fn rank_similar_with(
    zoo: &Zoo,
    target: &Vessel,
    definition: Option<VectorDefinition>,
    trials: &[&Trial],
    champions: &BTreeMap<String, Model>,
) -> SimilarityRanking {
    let definition = definition.unwrap_or_else(|| definition_for(target));
    let head = |vessel: &Vessel| match champions.get(vessel.name()) {
        Some(champion) => {
            Some(ModelHead { name: champion.name.clone(), law: champion.law.clone() })
        }
        None => published_head(vessel),
    };
    let candidates: Vec<SourceCandidate<'_>> =
        zoo.vessels().map(|vessel| SourceCandidate { vessel, model: head(vessel) }).collect();
    let measured = |vessel: &Vessel| {
        // Looked up also without trials, so that an invalid model is reported in any case.
        let model = match champions.get(vessel.name()) {
            Some(champion) => champion.clone(),
            None => zoo.published_model(vessel, None)?,
        };
        if trials.is_empty() {
            return Ok(None);
        }
        trend_on(zoo, target, &model, trials).map(Some)
    };
    SimilarityRanking {
        target: target.name().to_owned(),
        category: target.file.category.clone(),
        definition,
        vector: CharacteristicVector::from_vessel(target, definition).values,
        ranking: rank_candidates(
            target,
            &candidates,
            definition,
            &EligibilityLimits::default(),
            &measured,
        ),
    }
}

/// Name and law of a vessel's first model, in the form of [`Model::published`].
fn published_head(vessel: &Vessel) -> Option<ModelHead> {
    let model = vessel.file.models.first()?;
    Some(ModelHead { name: format!("{}/{}", vessel.name(), model.name), law: model.law.clone() })
}

/// Trend of a source on the target's trials, restarted after every 20 ship lengths.
fn trend_on(
    zoo: &Zoo,
    target: &Vessel,
    source: &Model,
    trials: &[&Trial],
) -> Result<f64, TrendError> {
    let law = zoo.law(&source.law).ok_or_else(|| TrendError::NoLaw(source.law.clone()))?;
    // A law with roll cannot start from a trial without recorded roll.
    let silent = [Channel::Phi, Channel::P].into_iter().find_map(|channel| {
        let without =
            trials.iter().find(|trial| law.has_roll() && trial.channel(channel).is_none())?;
        Some(TrendError::Roll { trial: without.name.clone(), channel })
    });
    if let Some(reason) = silent {
        return Err(reason);
    }
    let approach = trial_approach(trials);
    let model = transfer_model(source, law, target, approach);
    // Without a length or an approach speed, restarts are 200 s apart.
    let lengths_s = target.particular("lpp_m").zip(approach).map(|(l, a)| 20.0 * l / a.speed_m_s);
    let law = at_own_revolutions(law, &model, trials);
    trend_correlation(&model, &law, trials, lengths_s.unwrap_or(200.0))
}

/// Law of a source, with the source's own revolutions as default where a trial does not record
/// them.
fn at_own_revolutions<'a>(law: &'a Law, source: &Model, trials: &[&Trial]) -> Cow<'a, Law> {
    let is_silent = trials.iter().any(|trial| trial.channel(Channel::N).is_none());
    // The law is copied only if a default has to be added.
    let mut law = Cow::Borrowed(law);
    if is_silent && law.inputs.contains_key(Channel::N.name()) {
        let inputs = &mut law.to_mut().inputs;
        let own = inputs.get_mut(Channel::N.name()).into_iter();
        own.for_each(|input| input.default = input.default.or(source.revolutions_rps));
    }
    law
}

/// Returns the published model of the best eligible source.
///
/// # Errors
/// Returns an error that lists each ship of the ranking with the step that it failed.
pub fn best_source(zoo: &Zoo, similarity: &SimilarityRanking) -> Result<Model, SourceError> {
    let best = best_ranked(similarity)?;
    Ok(zoo.find_model(best.model.as_deref().unwrap_or(&best.ship))?)
}

/// Returns the best eligible ship of a ranking.
///
/// # Errors
/// Returns an error that lists each ship of the ranking with the step that it failed.
pub fn best_ranked(similarity: &SimilarityRanking) -> Result<&RankedSource, SourceError> {
    if let Some(best) = similarity.eligible_sources().next() {
        return Ok(best);
    }
    let why = |ranked: &RankedSource| {
        format!("{}: {}", ranked.ship, ranked.reasons.last().map_or("", String::as_str))
    };
    let reasons: Vec<String> = similarity.ranking.iter().map(why).collect();
    let reasons = reasons.join("; ") + &unknown_category(&similarity.category);
    Err(SourceError::NotEligible { target: similarity.target.clone(), reasons })
}

/// Remark on a category that is in no group.
fn unknown_category(category: &str) -> String {
    if category_group(category).is_some() {
        return String::new();
    }
    let known = known_categories().join(", ");
    format!(
        "; the category `{category}` is unknown and matches only itself; known categories are \
             {known}"
    )
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_ship_of_few_particulars_has_no_correlation_and_is_told_which_to_add() {
        let text = "kind: vessel\nname: few\ntitle: Few\ncategory: dry-cargo\nsources: { a: { \
                    citation: A } }\nparticulars: { source: a, values: { lpp_m: 80, beam_m: 13, \
                    draught_m: 5 } }\n";
        let vessel = Vessel::parse("few.yaml", text).unwrap();
        let ranking = rank_similar(&Zoo::load_embedded().unwrap(), &vessel, None, &[]);
        assert!(ranking.ranking.iter().all(|ship| ship.correlation.is_none()));
        let added = "block_coefficient, displacement_m3, rudder_area_m2, propeller_diameter_m";
        assert_eq!(ranking.missing_particulars().join(", "), added);
    }

    #[test]
    fn revolutions_that_no_trial_records_are_the_source_s_own() {
        let zoo = Zoo::load_embedded().unwrap();
        let source = zoo.find_model("kcs").unwrap();
        let law = zoo.law(&source.law).unwrap();
        let mut trial = Trial::default();
        let at = |trial: &Trial| at_own_revolutions(law, &source, &[trial]).inputs["n"].default;
        assert_eq!(at(&trial), source.revolutions_rps);
        assert!(source.revolutions_rps.is_some());
        trial.channels.insert(Channel::N, vec![1.0]);
        assert_eq!(at(&trial), None, "as recorded");
    }
}
