//! Start of a refinement: a version, the most similar ship, or the result of a model selection; and
//! the recipe that follows from it.

use std::sync::Arc;

use sistership_identification::refine::{PopulationShip, Prior, RefinementSettings};
use sistership_model::trial::Trial;
use sistership_model::version::{
    AcrossLaws, PopulationMember, RecipeTrial, SourceVersion, VersionRecipe, code_revision,
    sha256_hex,
};
use sistership_model::{Vessel, Zoo};
use sistership_model_selection::{
    Preference, SelectionReport, StartRequest, best_start, similar_population,
};
use sistership_priors::source::{SimilarityRanking, best_ranked};
use sistership_store::{Law, Ship, Version};

use crate::aliases::{find_alias, published_alias};
use crate::archive::Archive;
use crate::champions::SourceModels;
use crate::derive::ProgressCallback;
use crate::error::DeriveError;
use crate::library::{self, EffectLibrary, embedded_library};
use crate::sorted_json::sort_keys;

type Result<T> = std::result::Result<T, DeriveError>;

/// Start of a refinement.
#[derive(Debug)]
pub struct RefinementStart {
    /// The source model; `None` if the model is identified from the trials alone.
    pub source: Option<Version>,
    /// The law to fit; by default the source's.
    pub law: Option<String>,
    /// Versions of the population that is the prior; empty with another prior.
    pub population: Vec<Version>,
    /// Every setting.
    pub settings: RefinementSettings,
    /// Ranking of the ships, if they were compared.
    pub similarity: Option<SimilarityRanking>,
    /// Selection report, if the start was selected.
    pub ladder: Option<SelectionReport>,
}

impl RefinementStart {
    /// Creates the start that a person named.
    pub fn from_version(
        source: Version,
        law: Option<String>,
        settings: RefinementSettings,
    ) -> Self {
        // Nothing was compared, so there is neither a ranking nor a selection report.
        let source = Some(source);
        Self { source, law, population: Vec::new(), settings, similarity: None, ladder: None }
    }

    /// Adds the versions of a population, if the settings have that prior.
    ///
    /// # Errors
    /// Returns an error if a published model has no version.
    pub async fn with_population(
        self,
        archive: &Archive,
        zoo: &Zoo,
        target: &Vessel,
    ) -> Result<Self> {
        let members = match self.settings.prior {
            Prior::Population => similar_population(zoo, target),
            Prior::Source | Prior::Mixture => Vec::new(),
        };
        Ok(Self { population: population_versions(archive, &members).await?, ..self })
    }

    /// Returns the recipe of a refinement of a ship with this start.
    ///
    /// # Errors
    /// Returns an error if a law is missing, or if a setting is not finite.
    pub async fn refinement_recipe(
        &self,
        archive: &Archive,
        ship: &Ship,
        trials: Vec<RecipeTrial>,
    ) -> Result<VersionRecipe> {
        let (named, law, across) = self.resolve_laws(archive).await?;
        let mut population = Vec::new();
        for version in &self.population {
            let law_sha256 = archive.store.laws().get(&version.head.law).await?.sha256;
            // Each member has the law of its own published model.
            population.push(PopulationMember { version: version_reference(version), law_sha256 });
        }
        Ok(VersionRecipe::Refinement {
            source: self.source.as_ref().map(version_reference),
            law: named,
            ship_sha256: sha256_hex(ship.document.as_bytes()),
            law_sha256: law.sha256,
            across,
            population,
            effects_sha256: stored_library(archive).await?.sha256.clone(),
            trials,
            settings: sort_keys(serde_json::to_value(&self.settings)?),
            code_revision: code_revision().to_owned(),
        })
    }

    /// Returns the name of the law if there is no source, the law that is fitted, and both laws if
    /// they differ.
    async fn resolve_laws(
        &self,
        archive: &Archive,
    ) -> Result<(Option<String>, Law, Option<AcrossLaws>)> {
        let laws = archive.store.laws();
        let Some(source) = &self.source else {
            let neither = || DeriveError::Lost("give a source or a law".into());
            // Without a source the law must be named; it is identified from the trials alone.
            let name = self.law.clone().ok_or_else(neither)?;
            let law = laws.get(&name).await?;
            return Ok((Some(name), law, None));
        };
        let source_law = laws.get(&source.head.law).await?;
        match self.law.as_ref().filter(|law| **law != source.head.law) {
            None => Ok((None, source_law, None)),
            Some(law) => {
                // The source has another law: its accelerations are the prior, so both laws are
                // inputs.
                let across = AcrossLaws { law: law.clone(), source_law_sha256: source_law.sha256 };
                Ok((None, laws.get(law).await?, Some(across)))
            }
        }
    }
}

/// Returns this program's library of effects, after storing it.
///
/// # Errors
/// Returns an error if the store does not answer.
pub async fn stored_library(archive: &Archive) -> Result<&'static EffectLibrary> {
    library::store_library(&archive.store).await?;
    embedded_library().map_err(DeriveError::File)
}

/// Selects the best start of all candidates.
///
/// # Errors
/// Returns an error if it was cancelled, or if no candidate could be simulated to the end.
pub async fn select_start(
    archive: &Archive,
    zoo: Arc<Zoo>,
    target: Vessel,
    trials: &[RecipeTrial],
    settings: RefinementSettings,
    progress: ProgressCallback,
) -> Result<RefinementStart> {
    let models = Arc::new(SourceModels::for_zoo(archive, &zoo).await?);
    let trials = archive.read_trials(trials).await?;
    let known = Arc::clone(&models);
    let best = tokio::task::spawn_blocking(move || {
        let trials: Vec<&Trial> = trials.iter().collect();
        let (zoo, target, champions) = (&*zoo, &target, &known.champions);
        let asked = StartRequest {
            zoo,
            target,
            champions,
            trials: &trials,
            settings: &settings,
            preference: Preference::default(),
        };
        best_start(&asked, &|fraction, what| progress(fraction, what))
    })
    .await??;
    let entrant = best.entrant;
    // A candidate without a source law is a blank model, identified from the trials alone.
    let source = match &entrant.source_law {
        None => None,
        Some(_) => {
            let ship = &entrant.source.ship;
            Some(source_version(archive, &models, (ship, &entrant.source.name)).await?)
        }
    };
    Ok(RefinementStart {
        source,
        law: Some(entrant.law.name.clone()),
        population: population_versions(archive, &best.population).await?,
        settings: best.settings,
        similarity: Some(models.explain_ineligible(best.similarity)),
        ladder: Some(best.ladder),
    })
}

/// Returns the best eligible source of the store on the trials, with the ranking.
///
/// # Errors
/// Returns an error with the reasons if no ship is eligible.
pub async fn most_similar_source(
    archive: &Archive,
    zoo: Arc<Zoo>,
    target: Vessel,
    trials: &[RecipeTrial],
) -> Result<(Version, SimilarityRanking)> {
    let models = Arc::new(SourceModels::for_zoo(archive, &zoo).await?);
    let trials = archive.read_trials(trials).await?;
    let known = Arc::clone(&models);
    let best = move || {
        let similarity =
            known.rank_sources(&zoo, &target, None, &trials.iter().collect::<Vec<_>>());
        best_ranked(&similarity).cloned().map(|best| (best, similarity))
    };
    let (best, similarity) = tokio::task::spawn_blocking(best)
        .await?
        .map_err(|reasons| DeriveError::Lost(reasons.to_string()))?;
    let model = best.model.as_deref().unwrap_or(&best.ship);
    Ok((source_version(archive, &models, (&best.ship, model)).await?, similarity))
}

/// Returns the version that a ship provides as a source: its champion, else its published model.
async fn source_version(
    archive: &Archive,
    models: &SourceModels,
    (ship, model): (&str, &str),
) -> Result<Version> {
    match models.source_version(archive, ship).await? {
        Some(champion) => Ok(champion),
        None => published_version(archive, model).await,
    }
}

fn version_reference(source: &Version) -> SourceVersion {
    SourceVersion {
        ship: source.head.model.clone(),
        number: source.head.number,
        sha256: source.head.sha256.clone(),
    }
}

/// Returns the versions of the published models of a population.
async fn population_versions(
    archive: &Archive,
    members: &[PopulationShip],
) -> Result<Vec<Version>> {
    let mut versions = Vec::new();
    for member in members {
        versions.push(published_version(archive, &member.model.name).await?);
    }
    Ok(versions)
}

/// Returns the version of a published model.
async fn published_version(archive: &Archive, name: &str) -> Result<Version> {
    let (ship, model) = name.split_once('/').unwrap_or((name, ""));
    let found = find_alias(&archive.store, ship, &published_alias(model)).await?;
    // The server creates the versions of published models when it starts.
    let missing = || {
        DeriveError::Lost(format!(
            "the model `{name}` has no version; restart the server, which creates it"
        ))
    };
    let number = found.ok_or_else(missing)?.version_number;
    Ok(archive.store.versions().get(ship, number).await?)
}
