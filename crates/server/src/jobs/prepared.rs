//! What a refinement is made of: its trials, its source, its recipe.

use sistership_estimate::source::{Similarity, best_source, similar};
use sistership_model::trial::Trial as Recording;
use sistership_model::version::{
    AcrossLaws, Recipe, RecipeTrial, SourceVersion, code_revision, sha256,
};
use sistership_model::{Vessel, Zoo};
use sistership_pipeline::archive::vessel;
use sistership_pipeline::derive::DeriveError;
use sistership_pipeline::library::{self, Library, library};
use sistership_pipeline::line::{alias, alias_of};
use sistership_pipeline::sorted::sorted;
use sistership_store::Version;

use super::outcome::{JobError, Result, failed};
use super::progress::{Progress, tell};
use super::request::{RefinementJob, SourceChoice};
use crate::app::App;

/// A recipe, and how its source was chosen.
pub(super) struct Prepared {
    pub recipe: Recipe,
    pub source: Version,
    pub similarity: Option<Similarity>,
}

pub(super) async fn prepare(
    app: &App,
    asked: &RefinementJob,
    progress: &Progress,
) -> Result<Prepared> {
    let ship = app.store().ships().get(&asked.ship).await?;
    let trials = trials(app, &asked.trials).await?;
    let target = vessel(&ship.name, &ship.document)?;
    let (source, similarity) = match &asked.source {
        SourceChoice::Version { ship, number } => {
            (app.store().versions().get(ship, *number).await?, None)
        }
        SourceChoice::Auto => {
            tell(progress, 0.03, "choosing the source")?;
            let (version, similarity) = choose(app, target, &trials).await?;
            (version, Some(similarity))
        }
    };
    let source_law = app.store().laws().get(&source.head.law).await?;
    let (law, across) = match asked.law.as_ref().filter(|law| **law != source.head.law) {
        None => (source_law, None),
        Some(law) => {
            let across = AcrossLaws { law: law.clone(), source_law_sha256: source_law.sha256 };
            (app.store().laws().get(law).await?, Some(across))
        }
    };
    let recipe = Recipe::Refinement {
        source: SourceVersion {
            ship: source.head.model.clone(),
            number: source.head.number,
            sha256: source.head.sha256.clone(),
        },
        ship_sha256: sha256(ship.document.as_bytes()),
        law_sha256: law.sha256,
        across,
        effects_sha256: Some(library_of(app).await?.sha256.clone()),
        trials,
        settings: sorted(serde_json::to_value(&asked.settings).map_err(failed)?),
        code_revision: code_revision().to_owned(),
    };
    Ok(Prepared { recipe, source, similarity })
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
    let (ship, model) = name.split_once('/').unwrap_or((&name, ""));
    let found = alias(app.store(), ship, &alias_of(model)).await?;
    let found = found.ok_or_else(|| {
        failed(format!("the model `{name}` has no version; start the server again to make it"))
    })?;
    Ok((app.store().versions().get(ship, found.version_number).await?, similarity))
}

fn best(zoo: &Zoo, target: &Vessel, trials: &[Recording]) -> Result<(String, Similarity)> {
    let similarity = similar(zoo, target, None, &trials.iter().collect::<Vec<_>>());
    let model = best_source(zoo, &similarity).map_err(failed)?;
    Ok((model.name, similarity))
}
