//! Where a refinement starts: at a version, at the most similar ship, or at what a search finds;
//! and the recipe that follows from it.

use std::sync::Arc;

use sistership_identification::refine::{Member, Prior, Settings};
use sistership_model::trial::Trial;
use sistership_model::version::{
    AcrossLaws, PopulationMember, Recipe, RecipeTrial, SourceVersion, code_revision, sha256,
};
use sistership_model::{Vessel, Zoo};
use sistership_model_selection::{Asked, Ladder, best_start, population};
use sistership_priors::source::{Similarity, best_ranked};
use sistership_store::{Law, Ship, Version};

use crate::archive::Archive;
use crate::champions::SourceModels;
use crate::derive::Progress;
use crate::error::DeriveError;
use crate::library::{self, Library, library};
use crate::line::{alias, alias_of};
use crate::sorted::sorted;

type Result<T> = std::result::Result<T, DeriveError>;

/// Where a refinement starts.
#[derive(Debug)]
pub struct Start {
    /// None where the trials alone make the model.
    pub source: Option<Version>,
    /// The law to fit; the source's where absent.
    pub law: Option<String>,
    /// The ships whose population is the prior; none where something else is.
    pub population: Vec<Version>,
    /// Every setting.
    pub settings: Settings,
    /// How ships ranked, where they were compared.
    pub similarity: Option<Similarity>,
    /// What was tried, where it was searched.
    pub ladder: Option<Ladder>,
}

impl Start {
    /// As a person named it.
    pub fn at(source: Version, law: Option<String>, settings: Settings) -> Self {
        let settings = settings.as_ordered();
        let source = Some(source);
        Self { source, law, population: Vec::new(), settings, similarity: None, ladder: None }
    }

    /// With the ships of a population, where the settings ask for that.
    ///
    /// # Errors
    /// A published model has no version.
    pub async fn with_population(
        self,
        archive: &Archive,
        zoo: &Zoo,
        target: &Vessel,
    ) -> Result<Self> {
        let members = match self.settings.prior {
            Prior::Population => population(zoo, target),
            Prior::Source | Prior::Mixture => Vec::new(),
        };
        Ok(Self { population: published(archive, &members).await?, ..self })
    }

    /// The recipe of a refinement of a ship from here.
    ///
    /// # Errors
    /// A law is not there, or a setting is not finite.
    pub async fn recipe(
        &self,
        archive: &Archive,
        ship: &Ship,
        trials: Vec<RecipeTrial>,
    ) -> Result<Recipe> {
        let (named, law, across) = self.laws(archive).await?;
        let mut population = Vec::new();
        for version in &self.population {
            let law_sha256 = archive.store.laws().get(&version.head.law).await?.sha256;
            population.push(PopulationMember { version: from(version), law_sha256 });
        }
        Ok(Recipe::Refinement {
            source: self.source.as_ref().map(from),
            law: named,
            ship_sha256: sha256(ship.document.as_bytes()),
            law_sha256: law.sha256,
            across,
            population,
            effects_sha256: Some(library_of(archive).await?.sha256.clone()),
            trials,
            settings: sorted(serde_json::to_value(&self.settings)?),
            code_revision: code_revision().to_owned(),
        })
    }

    /// The name of the law where no source tells it, the law that is fitted, and both where they
    /// differ.
    async fn laws(&self, archive: &Archive) -> Result<(Option<String>, Law, Option<AcrossLaws>)> {
        let laws = archive.store.laws();
        let Some(source) = &self.source else {
            let neither = || DeriveError::Lost("neither a source nor a law is named".into());
            let name = self.law.clone().ok_or_else(neither)?;
            let law = laws.get(&name).await?;
            return Ok((Some(name), law, None));
        };
        let source_law = laws.get(&source.head.law).await?;
        match self.law.as_ref().filter(|law| **law != source.head.law) {
            None => Ok((None, source_law, None)),
            Some(law) => {
                let across = AcrossLaws { law: law.clone(), source_law_sha256: source_law.sha256 };
                Ok((None, laws.get(law).await?, Some(across)))
            }
        }
    }
}

/// This program's library of effects, which the store keeps from now on if it did not.
///
/// # Errors
/// The store does not answer.
pub async fn library_of(archive: &Archive) -> Result<&'static Library> {
    library::keep(&archive.store).await?;
    library().map_err(DeriveError::File)
}

/// The best start of all that can be tried.
///
/// # Errors
/// It was cancelled, or nothing could be simulated to its end.
pub async fn searched(
    archive: &Archive,
    zoo: Arc<Zoo>,
    target: Vessel,
    trials: &[RecipeTrial],
    settings: Settings,
    progress: Progress,
) -> Result<Start> {
    let models = Arc::new(SourceModels::read(archive, &zoo).await?);
    let trials = archive.trials(trials).await?;
    let known = Arc::clone(&models);
    let best = tokio::task::spawn_blocking(move || {
        let trials: Vec<&Trial> = trials.iter().collect();
        let (zoo, target, champions) = (&*zoo, &target, &known.champions);
        let asked = Asked { zoo, target, champions, trials: &trials, settings: &settings };
        best_start(&asked, &|fraction, what| progress(fraction, what))
    })
    .await??;
    let entrant = best.entrant;
    let source = match &entrant.source_law {
        None => None,
        Some(_) => {
            let ship = &entrant.source.ship;
            Some(source_version(archive, &models, (ship, &entrant.source.name)).await?)
        }
    };
    Ok(Start {
        source,
        law: Some(entrant.law.name.clone()),
        population: published(archive, &best.population).await?,
        settings: best.settings,
        similarity: Some(models.explained(best.similarity)),
        ladder: Some(best.ladder),
    })
}

/// The best eligible ship of the store, measured on the trials.
///
/// # Errors
/// None is eligible.
pub async fn most_similar(
    archive: &Archive,
    zoo: Arc<Zoo>,
    target: Vessel,
    trials: &[RecipeTrial],
) -> Result<(Version, Similarity)> {
    let models = Arc::new(SourceModels::read(archive, &zoo).await?);
    let trials = archive.trials(trials).await?;
    let known = Arc::clone(&models);
    let best = move || {
        let similarity = known.rank(&zoo, &target, None, &trials.iter().collect::<Vec<_>>());
        best_ranked(&similarity).cloned().map(|best| (best, similarity))
    };
    let (best, similarity) = tokio::task::spawn_blocking(best)
        .await?
        .map_err(|reasons| DeriveError::Lost(reasons.to_string()))?;
    let model = best.model.as_deref().unwrap_or(&best.ship);
    Ok((source_version(archive, &models, (&best.ship, model)).await?, similarity))
}

/// The version that a ship gives as a source: its champion, else its published model.
async fn source_version(
    archive: &Archive,
    models: &SourceModels,
    (ship, model): (&str, &str),
) -> Result<Version> {
    match models.version(archive, ship).await? {
        Some(champion) => Ok(champion),
        None => published_version(archive, model).await,
    }
}

fn from(source: &Version) -> SourceVersion {
    SourceVersion {
        ship: source.head.model.clone(),
        number: source.head.number,
        sha256: source.head.sha256.clone(),
    }
}

/// The versions of the published models of a population.
async fn published(archive: &Archive, members: &[Member]) -> Result<Vec<Version>> {
    let mut versions = Vec::new();
    for member in members {
        versions.push(published_version(archive, &member.model.name).await?);
    }
    Ok(versions)
}

/// The version of a published model.
async fn published_version(archive: &Archive, name: &str) -> Result<Version> {
    let (ship, model) = name.split_once('/').unwrap_or((name, ""));
    let found = alias(&archive.store, ship, &alias_of(model)).await?;
    let missing = || {
        DeriveError::Lost(format!(
            "the model `{name}` has no version; start the server again to make it"
        ))
    };
    let number = found.ok_or_else(missing)?.version_number;
    Ok(archive.store.versions().get(ship, number).await?)
}
