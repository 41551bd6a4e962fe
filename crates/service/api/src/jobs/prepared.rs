//! Inputs of a refinement: its trials, its source model, its recipe.

use std::sync::Arc;

use sistership_identification::refine::Prior;
use sistership_jobs::archive::parse_vessel;
use sistership_jobs::start::{RefinementStart, most_similar_source, select_start};
use sistership_model::Vessel;
use sistership_model::version::{RecipeTrial, VersionRecipe};

use super::outcome::Result;
use super::progress::{JobProgress, report_progress};
use crate::app::App;
use sistership_jobs::request::{RefinementJob, SourceChoice};

/// Share of the job's progress that the model selection takes; the selected candidate is fitted
/// once more.
pub(super) const SELECTION_SHARE: f64 = 0.6;

/// A recipe, and how its source model was selected.
pub(super) struct PreparedRefinement {
    pub recipe: VersionRecipe,
    pub start: RefinementStart,
}

/// Reads the trials, selects the source model, and writes the recipe of a refinement.
pub(super) async fn prepare_refinement(
    app: &App,
    asked: &RefinementJob,
    progress: &JobProgress,
) -> Result<PreparedRefinement> {
    let ship = app.store().ships().get(&asked.ship).await?;
    let trials = recipe_trials(app, &asked.trials).await?;
    let target = parse_vessel(&ship.name, &ship.document)?;
    let start = refinement_start(app, asked, target, &trials, progress).await?;
    let recipe = start.refinement_recipe(app.archive(), &ship, trials).await?;
    Ok(PreparedRefinement { recipe, start })
}

async fn refinement_start(
    app: &App,
    asked: &RefinementJob,
    target: Vessel,
    trials: &[RecipeTrial],
    progress: &JobProgress,
) -> Result<RefinementStart> {
    let (law, settings) = (asked.law.clone(), asked.settings.clone());
    // A named version is the source model as it is; the zoo is read only for a prior from a
    // population of ships.
    if let SourceChoice::Version { ship, number } = &asked.source {
        let version = app.store().versions().get(ship, *number).await?;
        let start = RefinementStart::from_version(version, law, settings);
        if start.settings.prior != Prior::Population {
            return Ok(start);
        }
        let zoo = app.zoo_around(&target).await?;
        return Ok(start.with_population(app.archive(), &zoo, &target).await?);
    }
    let zoo = app.zoo_around(&target).await?;
    if asked.search {
        report_progress(progress, 0.02, "selecting source, law and method")?;
        let told = progress.clone();
        let scaled = move |fraction: f64, what: &str| told.report(SELECTION_SHARE * fraction, what);
        let scaled = Arc::new(scaled);
        return Ok(select_start(app.archive(), zoo, target, trials, settings, scaled).await?);
    }
    report_progress(progress, 0.03, "selecting the source")?;
    let (near, named) = (Arc::clone(&zoo), target.clone());
    let (version, similarity) = most_similar_source(app.archive(), near, named, trials).await?;
    let start = RefinementStart {
        similarity: Some(similarity),
        ..RefinementStart::from_version(version, law, settings)
    };
    Ok(start.with_population(app.archive(), &zoo, &target).await?)
}

pub(super) async fn recipe_trials(app: &App, ids: &[String]) -> Result<Vec<RecipeTrial>> {
    let mut trials = Vec::with_capacity(ids.len());
    for id in ids {
        let trial = app.store().trials().get(id).await?;
        trials.push(RecipeTrial { name: trial.name, sha256: trial.sha256 });
    }
    Ok(trials)
}
