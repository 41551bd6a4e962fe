//! All fits of a model's coefficients that are worth weighing, each with what it gives where a trial is left out.

use sistership_model::law::Law;
use sistership_model::trial::Trial;
use sistership_model::{Model, particulars};

use super::family::Family;
use super::outcome::RefineError;
use super::selection::{Task, resolved};
use super::settings::{Method, Settings};
use crate::bands::Sampling;

/// Strengths of the weak form from which trajectories start, and which are weighed themselves.
const STRENGTHS: [f64; 6] = [10.0, 1.0, 0.3, 0.1, 0.03, 0.01];

/// A fit by the weak form or by trajectories.
pub(crate) struct Alternative {
    /// What it is, for people.
    pub label: String,
    /// Fitted on all trials.
    pub all: Model,
    /// Fitted without each trial.
    pub without: Vec<Model>,
}

/// The fits of a model's coefficients, with its own as the source, whose simulations of trials left out do not stop.
///
/// # Errors
/// Says which trial or channel is at fault.
pub(crate) fn alternatives(model: &Model, law: &Law, trials: &[&Trial], restart_s: f64) -> Result<Vec<Alternative>, RefineError> {
    let settings = Settings {
        method: Method::Trajectory,
        families: vec![Family::Own],
        strengths: STRENGTHS.to_vec(),
        folds: trials.len(),
        restart_s: Some(restart_s),
        bands: Sampling { samples: 0, ..Sampling::default() },
        ..Settings::default()
    };
    let settings = resolved(&settings, particulars::value(&model.particulars, "lpp_m"), trials);
    let task = Task::of_model(model, law, trials, settings);
    let variants = task.variants()?;
    let mut options = task.options(&variants, &|_, _| true)?;
    task.by_trajectory(&variants, &mut options, &|_, _| true)?;
    let left_out = options.into_iter().filter(|trying| trying.option.error.is_some() && !trying.left_out.is_empty());
    let one = |trying: super::selection::Trying| {
        let all = task.fitted(&trying.taken, &variants)?.map(|fit| task.model_with(&fit.coefficients));
        Ok(all.map(|all| Alternative { label: trying.option.step, all, without: trying.left_out }))
    };
    left_out.filter_map(|trying| one(trying).transpose()).collect()
}
