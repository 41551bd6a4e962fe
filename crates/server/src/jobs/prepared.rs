//! What a refinement is made of: its trials, its source, its recipe.

use std::collections::BTreeMap;

use sistership_choice::{Asked, Ladder, best_start};
use sistership_estimate::refine::Settings;
use sistership_estimate::source::{Similarity, best_source, similar};
use sistership_model::trial::Trial as Recording;
use sistership_model::version::{
    AcrossLaws, Recipe, RecipeTrial, SourceVersion, code_revision, sha256,
};
use sistership_model::{Vessel, Zoo};
use sistership_pipeline::archive::vessel;
use sistership_pipeline::champions::champions;
use sistership_pipeline::derive::DeriveError;
use sistership_pipeline::library::{self, Library, library};
use sistership_pipeline::line::{alias, alias_of};
use sistership_pipeline::sorted::sorted;
use sistership_store::{Law, Version};

use super::outcome::{JobError, Result, failed};
use super::progress::{Progress, tell};
use super::request::{RefinementJob, SourceChoice};
use crate::app::App;

/// How much of a job the search is: it fits what is refined once more.
pub(super) const SEARCHED: f64 = 0.6;

/// A recipe, and how its source was chosen.
pub(super) struct Prepared {
    pub recipe: Recipe,
    /// None where the trials alone make the model.
    pub source: Option<Version>,
    pub similarity: Option<Similarity>,
    pub ladder: Option<Ladder>,
}

/// Where a refinement starts.
struct Start {
    source: Option<Version>,
    /// The law to fit; the source's where absent.
    law: Option<String>,
    settings: Settings,
    similarity: Option<Similarity>,
    ladder: Option<Ladder>,
}

pub(super) async fn prepare(
    app: &App,
    asked: &RefinementJob,
    progress: &Progress,
) -> Result<Prepared> {
    let ship = app.store().ships().get(&asked.ship).await?;
    let trials = trials(app, &asked.trials).await?;
    let target = vessel(&ship.name, &ship.document)?;
    let start = start(app, asked, target, &trials, progress).await?;
    let (named, law, across) = laws(app, &start).await?;
    let from = |source: &Version| SourceVersion {
        ship: source.head.model.clone(),
        number: source.head.number,
        sha256: source.head.sha256.clone(),
    };
    let recipe = Recipe::Refinement {
        source: start.source.as_ref().map(from),
        law: named,
        ship_sha256: sha256(ship.document.as_bytes()),
        law_sha256: law.sha256,
        across,
        effects_sha256: Some(library_of(app).await?.sha256.clone()),
        trials,
        settings: sorted(serde_json::to_value(&start.settings).map_err(failed)?),
        code_revision: code_revision().to_owned(),
    };
    let Start { source, similarity, ladder, .. } = start;
    Ok(Prepared { recipe, source, similarity, ladder })
}

async fn start(
    app: &App,
    asked: &RefinementJob,
    target: Vessel,
    trials: &[RecipeTrial],
    progress: &Progress,
) -> Result<Start> {
    let (law, settings) = (asked.law.clone(), asked.settings.clone());
    let as_asked = |source, similarity| Start {
        source: Some(source),
        law,
        settings,
        similarity,
        ladder: None,
    };
    match &asked.source {
        SourceChoice::Version { ship, number } => {
            Ok(as_asked(app.store().versions().get(ship, *number).await?, None))
        }
        SourceChoice::Auto if asked.search => {
            tell(progress, 0.02, "searching source, law and method")?;
            searched(app, target, trials, &asked.settings, progress).await
        }
        SourceChoice::Auto => {
            tell(progress, 0.03, "choosing the source")?;
            let (version, similarity) = choose(app, target, trials).await?;
            Ok(as_asked(version, Some(similarity)))
        }
    }
}

/// The name of the law where no source tells it, the law that is fitted, and both laws where they differ.
async fn laws(app: &App, start: &Start) -> Result<(Option<String>, Law, Option<AcrossLaws>)> {
    let laws = app.store().laws();
    let Some(source) = &start.source else {
        let name =
            start.law.clone().ok_or_else(|| failed("neither a source nor a law is named"))?;
        let law = laws.get(&name).await?;
        return Ok((Some(name), law, None));
    };
    let source_law = laws.get(&source.head.law).await?;
    match start.law.as_ref().filter(|law| **law != source.head.law) {
        None => Ok((None, source_law, None)),
        Some(law) => {
            let across = AcrossLaws { law: law.clone(), source_law_sha256: source_law.sha256 };
            Ok((None, laws.get(law).await?, Some(across)))
        }
    }
}

/// The best start of all that can be tried.
async fn searched(
    app: &App,
    target: Vessel,
    trials: &[RecipeTrial],
    settings: &Settings,
    progress: &Progress,
) -> Result<Start> {
    let zoo = app.zoo_around(&target).await?;
    let found = champions(app.archive(), &zoo, &target).await?;
    let trials = app.archive().trials(trials).await?;
    let (models, mut versions): (BTreeMap<_, _>, BTreeMap<_, _>) = found
        .into_iter()
        .map(|(ship, (model, version))| ((ship.clone(), model), (ship, version)))
        .unzip();
    let (settings, told) = (settings.clone(), progress.clone());
    let best = move || {
        let trials: Vec<&Recording> = trials.iter().collect();
        let asked = Asked {
            zoo: &zoo,
            target: &target,
            champions: &models,
            trials: &trials,
            settings: &settings,
        };
        best_start(&asked, &|fraction, what| told.tell(SEARCHED * fraction, what))
    };
    let best = app.compute(best).await?.map_err(DeriveError::Refine)?;
    let entrant = best.entrant;
    let source = match (&entrant.source_law, versions.remove(&entrant.source.ship)) {
        (None, _) => None,
        (Some(_), Some(champion)) => Some(champion),
        (Some(_), None) => Some(published_version(app, &entrant.source.name).await?),
    };
    Ok(Start {
        source,
        law: Some(entrant.law.name.clone()),
        settings: best.settings,
        similarity: Some(best.similarity),
        ladder: Some(best.ladder),
    })
}

/// This program's library of effects, which the store keeps from now on if it did not.
pub(super) async fn library_of(app: &App) -> Result<&'static Library> {
    library::keep(app.store()).await?;
    library().map_err(|error| JobError::from(DeriveError::File(error)))
}

pub(super) async fn trials(app: &App, ids: &[String]) -> Result<Vec<RecipeTrial>> {
    let mut trials = Vec::with_capacity(ids.len());
    for id in ids {
        let trial = app.store().trials().get(id).await?;
        trials.push(RecipeTrial { name: trial.name, sha256: trial.sha256 });
    }
    Ok(trials)
}

/// The best eligible ship of the zoo, measured on the trials.
async fn choose(
    app: &App,
    target: Vessel,
    trials: &[RecipeTrial],
) -> Result<(Version, Similarity)> {
    let zoo = app.zoo_around(&target).await?;
    let trials = app.archive().trials(trials).await?;
    let (name, similarity) = app.compute(move || best(&zoo, &target, &trials)).await??;
    Ok((published_version(app, &name).await?, similarity))
}

/// The version of a published model.
async fn published_version(app: &App, name: &str) -> Result<Version> {
    let (ship, model) = name.split_once('/').unwrap_or((name, ""));
    let found = alias(app.store(), ship, &alias_of(model)).await?;
    let found = found.ok_or_else(|| {
        failed(format!("the model `{name}` has no version; start the server again to make it"))
    })?;
    Ok(app.store().versions().get(ship, found.version_number).await?)
}

fn best(zoo: &Zoo, target: &Vessel, trials: &[Recording]) -> Result<(String, Similarity)> {
    let similarity = similar(zoo, target, None, &trials.iter().collect::<Vec<_>>());
    let model = best_source(zoo, &similarity).map_err(failed)?;
    Ok((model.name, similarity))
}
