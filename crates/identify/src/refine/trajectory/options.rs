//! The trajectory form as options of a refinement.

use std::collections::BTreeMap;

use nalgebra::DVector;
use sistership_dynamics::error::standard_deviations;
use sistership_dynamics::sensitivity::SensitiveSystem;
use sistership_model::Model;
use sistership_model::quantity::Quantity;

use super::super::outcome::RefineError;
use super::super::published::{Choices, Fold};
use super::super::selection::{Glimpse, Progress, Taken, Task, Trying, step};
use super::super::variant::{Variant, merged};
use super::Cut;
use super::errors::Bend;
use super::normal::{Normal, Pass, Passing};
use super::prior::Prior;
use super::segments::{Plan, compared, cut};
use super::solve::Held;
use crate::regression::Moments;
use crate::transfer::ready;

/// Pulls towards the weak form that are tried, strongest first, each from where the one before has ended, until [the best is
/// past](is_past_best). A stronger one would give the weak form.
const PULLS: [f64; 6] = [10.0, 1.0, 0.1, 0.01, 1e-3, 1e-4];
/// How strongly the source holds trajectories, at most, however much of it the weak form needs.
const SOURCE: f64 = 0.01;
/// So many times the error of another is clearly worse.
const CLEARLY: f64 = 1.02;
/// Huber's threshold in robust standard deviations of a state's residuals.
const HUBER: f64 = 3.0;
/// A median needs no more than so many times fewer segments, where there are many.
const SOME: usize = 4;
/// Most steps.
const STEPS: usize = 12;
/// Steps end when one gains, or would gain, less than this share.
const ENOUGH: f64 = 2e-3;

/// What the trajectory form makes of one variant.
pub(in super::super) struct Trajectory<'a> {
    task: &'a Task<'a>,
    variant: &'a Variant,
    /// Its place among all.
    index: usize,
    choices: &'a Choices,
    passing: Passing<'a>,
    names: Vec<String>,
}

/// Coefficients with the pass at them.
struct Reached {
    at: DVector<f64>,
    pass: Pass,
}

impl Task<'_> {
    /// Adds options of the trajectory form, started from the best option of the weak form; where every option stops while manoeuvres
    /// are simulated, from the first, which the source holds most.
    pub(in super::super) fn by_trajectory(
        &self,
        variants: &[Variant],
        options: &mut Vec<Trying>,
        progress: Progress<'_>,
    ) -> Result<(), RefineError> {
        let first = || options.iter().position(|trying| matches!(trying.taken, Taken::Ridge { .. }));
        let start = super::super::finish::best(options).or_else(first).map(|start| &options[start]);
        let Some(Trying { taken: Taken::Ridge { variant: index, choices }, option, .. }) = start else { return Ok(()) };
        let (index, choices, error) = (*index, choices.clone(), option.error);
        let variant = &variants[index];
        step(progress, 0.6, "trajectories from the weak form")?;
        let cutting = self.cut();
        let model = self.model_at(variant, &weak_form(variant, &choices, &|_| true)?.1);
        let system = SensitiveSystem::new(&model, self.law).map_err(|e| RefineError::Law(e.to_string()))?;
        let stride = (cutting.residual_s / cutting.step_s).round().max(1.0) as usize;
        let compared = compared(system.states(), &standard_deviations(&self.training));
        let plan = Plan { compared, stride, step_s: cutting.step_s };
        let segments = cut(&self.training, self.law, system.input_names(), cutting, &plan)?;
        if segments.is_empty() {
            return Ok(());
        }
        let ship = ready(&model, self.law, &self.training).map_err(RefineError::Law)?;
        let thresholds = vec![f64::INFINITY; plan.compared.len()];
        let trials = self.training.len();
        let passing = Passing { segments: &segments, plan: &plan, envelope: *ship.envelope(), thresholds, trials };
        let names = system.names().to_vec();
        Trajectory { task: self, variant, index, choices: &choices, passing, names }.options(error, options, progress)
    }

    fn cut(&self) -> Cut {
        let given = &self.settings;
        let interval = self.training.iter().map(|trial| trial.interval_s()).fold(f64::INFINITY, f64::min).max(1e-3);
        let step_s = interval * (given.step_s.unwrap_or(interval) / interval).round().max(1.0);
        let segment_s = given.segment_s.unwrap_or(120.0 * step_s);
        Cut { segment_s, residual_s: given.residual_s.unwrap_or(4.0 * step_s).max(step_s), step_s }
    }

    /// The variant's model with other coefficients.
    pub(in super::super) fn model_at(&self, variant: &Variant, values: &BTreeMap<String, f64>) -> Model {
        let mut model = variant.model.clone();
        let all = values.iter().map(|(name, value)| (name.clone(), Quantity::new(*value, "refined")));
        model.coefficients.extend(all);
        model
    }
}

/// The statistics of some trials, and the weak form's coefficients on them.
fn weak_form(
    variant: &Variant,
    choices: &Choices,
    keep: &dyn Fn(usize) -> bool,
) -> Result<(Vec<Moments>, BTreeMap<String, f64>), RefineError> {
    let moments = merged(&variant.moments, keep).ok_or_else(|| RefineError::Data("a fold has no sample".into()))?;
    let solved = Fold::new(&variant.blocks, &variant.model, &moments, &[]).solve(choices);
    Ok((moments, solved.into_iter().map(|(name, fitted)| (name, fitted.value)).collect()))
}

impl Trajectory<'_> {
    /// Options after the weak form's, which has an error.
    fn options(mut self, weak: Option<f64>, options: &mut Vec<Trying>, progress: Progress<'_>) -> Result<(), RefineError> {
        let prior = self.prior(&|_| true)?;
        self.passing.thresholds = self.thresholds(&prior.weak)?;
        let priors: Vec<Prior> =
            (0..self.task.fold_count()).map(|fold| self.prior(&|t| self.inside(t, fold))).collect::<Result<_, _>>()?;
        let mut reached = self.reached(prior.weak.clone())?;
        let mut errors = vec![weak.unwrap_or(f64::INFINITY)];
        for pull in PULLS {
            let label = format!("trajectory, {}, pull {pull:.0e}", self.variant.family.name());
            step(progress, 0.7, &label)?;
            reached = self.descend(&prior, pull, reached)?;
            step(progress, 0.7, &format!("{label}: simulating manoeuvres left out"))?;
            let models: Vec<Model> =
                priors.iter().enumerate().map(|(fold, prior)| self.left_out(fold, prior, pull, &reached)).collect();
            let simulated = self.task.simulate_training(&models, &|trial| self.task.fold_of(trial))?;
            let taken = Taken::Reached(Box::new(self.bend(&prior, pull, &reached)));
            let trying = self.task.trying(label, Some(pull), taken, self.names.len(), simulated);
            errors.push(trying.option.error.unwrap_or(f64::INFINITY));
            options.push(Trying { left_out: models, ..trying });
            if is_past_best(&errors) {
                break;
            }
        }
        Ok(())
    }

    /// Huber's thresholds from every [`SOME`]th segment.
    fn thresholds(&self, at: &DVector<f64>) -> Result<Vec<f64>, RefineError> {
        let model = self.task.model_at(self.variant, &self.values(at));
        let system = SensitiveSystem::new(&model, self.task.law).map_err(|e| RefineError::Law(e.to_string()))?;
        Ok(self.passing.sizes(&system, SOME).into_iter().map(threshold).collect())
    }

    fn inside(&self, trial: usize, fold: usize) -> bool {
        self.task.training.len() == 1 || self.task.fold_of(trial) != fold
    }

    /// What the weak form says on some trials.
    fn prior(&self, keep: &dyn Fn(usize) -> bool) -> Result<Prior, RefineError> {
        let (moments, values) = weak_form(self.variant, self.choices, keep)?;
        let values = |name: &str| (values.get(name).copied().unwrap_or_default(), self.variant.model.coefficient(name));
        let lambda = self.choices.iter().flatten().map(|choice| choice.lambda).fold(0.0, f64::max).min(SOURCE);
        Ok(Prior::new(&self.names, &self.variant.blocks, &moments, &values, lambda))
    }

    fn values(&self, at: &DVector<f64>) -> BTreeMap<String, f64> {
        self.names.iter().cloned().zip(at.iter().copied()).collect()
    }

    fn pass(&self, at: &DVector<f64>) -> Result<Pass, RefineError> {
        let model = self.task.model_at(self.variant, &self.values(at));
        let system = SensitiveSystem::new(&model, self.task.law).map_err(|e| RefineError::Law(e.to_string()))?;
        Ok(self.passing.pass(&system))
    }

    fn reached(&self, at: DVector<f64>) -> Result<Reached, RefineError> {
        Ok(Reached { pass: self.pass(&at)?, at })
    }

    /// From coefficients to the least cost nearby.
    fn descend(&self, prior: &Prior, pull: f64, mut here: Reached) -> Result<Reached, RefineError> {
        let mut damping = 1e-3;
        let mut held = Held::new(&total(&here.pass, |_| true), prior, pull, &here.at);
        for _ in 0..STEPS {
            let model = || self.task.model_at(self.variant, &self.values(&here.at));
            self.task.glimpse(&Glimpse { evaluations: 0, objective: held.cost, model: &model });
            let Some(step) = held.step(damping).filter(|step| held.foretold(step) > ENOUGH) else { break };
            let there = self.reached(&here.at + step)?;
            let next = Held::new(&total(&there.pass, |_| true), prior, pull, &there.at);
            if next.cost.is_finite() && next.cost < held.cost {
                let gained = 1.0 - next.cost / held.cost;
                (here, held) = (there, next);
                damping *= 0.1;
                if gained < ENOUGH {
                    break;
                }
            } else {
                damping = (damping * 30.0).max(1e-2);
                if damping > 1e6 {
                    break;
                }
            }
        }
        Ok(here)
    }

    /// The model of a fold: one step from where all trials are fitted, on the trials inside it and their weak form.
    fn left_out(&self, fold: usize, prior: &Prior, pull: f64, reached: &Reached) -> Model {
        let normal = total(&reached.pass, |trial| self.inside(trial, fold));
        let held = Held::new(&normal, prior, pull, &reached.at);
        let at = held.step(1e-6).map_or_else(|| reached.at.clone(), |step| &reached.at + step);
        self.task.model_at(self.variant, &self.values(&at))
    }

    /// The fit at coefficients.
    fn bend(&self, prior: &Prior, pull: f64, Reached { at, pass }: &Reached) -> Bend {
        let normal = total(pass, |_| true);
        Bend {
            variant: self.index,
            choices: self.choices.clone(),
            names: self.names.clone(),
            at: at.clone(),
            held: Held::new(&normal, prior, pull, at),
            gradients: pass.gradients.clone(),
            cost: normal.cost,
            count: normal.count,
            prior: prior.clone(),
            pull,
        }
    }
}

/// Whether weaker pulls would be worse still: after the weak form, whose error is the first, the last two were no better than one
/// before them, or the last is clearly worse than another pull.
fn is_past_best(errors: &[f64]) -> bool {
    let best = |errors: &[f64]| errors.iter().copied().fold(f64::INFINITY, f64::min);
    let [weak, .., before, last] = *errors else { return false };
    let (best, best_before) = (best(errors), best(&errors[..errors.len() - 2]));
    let none_better = best_before.is_finite() && before.min(last) >= best_before;
    none_better || (best < weak && last > CLEARLY * best)
}

/// Sums over some trials.
fn total(pass: &Pass, keep: impl Fn(usize) -> bool) -> Normal {
    let mut all = Normal::zeros(pass.trials.first().map_or(0, |normal| normal.gradient.len()));
    pass.trials.iter().enumerate().filter(|(trial, _)| keep(*trial)).for_each(|(_, normal)| all.add(normal));
    all
}

/// Huber's threshold from absolute residuals: their median, as that of a normal distribution.
fn threshold(mut sizes: Vec<f64>) -> f64 {
    sizes.sort_by(f64::total_cmp);
    let median = sizes.get(sizes.len() / 2).copied().unwrap_or(0.0);
    if median > 0.0 { HUBER * 1.4826 * median } else { f64::INFINITY }
}

#[cfg(test)]
mod tests {
    use super::is_past_best;

    #[test]
    fn weaker_pulls_are_tried_until_they_are_worse() {
        // Of the weak form, then of pulls.
        assert!(!is_past_best(&[1.0]));
        assert!(!is_past_best(&[1.0, 1.2]), "one that is worse than the weak form may be followed by better ones");
        assert!(is_past_best(&[1.0, 1.2, 1.1]));
        assert!(!is_past_best(&[1.0, 0.9, 0.91]), "hardly worse");
        assert!(is_past_best(&[1.0, 0.9, 0.91, 0.905]));
        assert!(is_past_best(&[1.0, 0.9, 0.95]));
        assert!(!is_past_best(&[f64::INFINITY, f64::INFINITY, f64::INFINITY]), "nothing has sailed yet");
        assert!(is_past_best(&[f64::INFINITY, 0.9, f64::INFINITY]));
    }
}
