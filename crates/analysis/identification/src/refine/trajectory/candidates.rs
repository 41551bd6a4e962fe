//! The trajectory form as candidates of a refinement.

use std::collections::BTreeMap;

use nalgebra::DVector;
use rayon::prelude::*;
use sistership_model::Model;
use sistership_simulation::sensitivity::SensitiveSystem;

use super::super::candidate::{CandidateFit, best_candidate};
use super::super::measure::PriorMeasure;
use super::super::outcome::RefineError;
use super::super::problem::RefinementProblem;
use super::super::progress::{FitIterate, Progress, report_progress};
use super::super::ridge::{RegressionFold, RidgeChoices};
use super::super::simulated::simulate_training;
use super::super::variant::TermVariant;
use super::fit::TrajectoryFit;
use super::normal::{NormalEquations, SegmentSimulation, SegmentSums};
use super::parameters::{BoundedParameter, free_parameters};
use super::prior::WeakFormPrior;
use super::segments::{ComparisonPlan, SegmentLengths, compared_states, divide_into_segments};
use super::solve::PenalisedEquations;
use super::thresholds::TRAJECTORY;
use sistership_numerics::{RegressionMoments, merge_trials};
use sistership_priors::transfer::prepare_ship;

/// The fit of one variant by the trajectory form.
struct TrajectoryDescent<'a> {
    problem: &'a RefinementProblem<'a>,
    variant: &'a TermVariant,
    /// Place of the variant among all.
    index: usize,
    choices: &'a RidgeChoices,
    passing: SegmentSimulation<'a>,
    /// Names of the coefficients.
    names: Vec<String>,
    /// Parameters that are fitted besides.
    parameters: Vec<BoundedParameter>,
}

/// Coefficients and unknowns of parameters, with residuals and sensitivities of all segments there.
struct Linearisation {
    at: DVector<f64>,
    pass: SegmentSums,
}

/// Adds candidates of the trajectory form, started from the best of the weak form; if all of these
/// diverge on held-out manoeuvres, from the first one, which is closest to the source.
///
/// # Errors
/// Returns an error if a trial lacks a channel, or if it was cancelled.
pub(super) fn add_from_weak_form(
    problem: &RefinementProblem<'_>,
    variants: &[TermVariant],
    candidates: &mut Vec<CandidateFit>,
    progress: Progress<'_>,
) -> Result<(), RefineError> {
    let first =
        || candidates.iter().position(|candidate| candidate.solution.ridge_choices().is_some());
    let Some(start) = best_candidate(candidates).or_else(first).map(|start| &candidates[start])
    else {
        return Ok(());
    };
    let Some((index, choices)) = start.solution.ridge_choices() else { return Ok(()) };
    let (index, choices, error) = (index, choices.clone(), start.option.error);
    let variant = &variants[index];
    report_progress(progress, 0.6, "fitting trajectories, starting from the weak form")?;
    let cutting = segment_lengths(problem);
    let model = variant.model_at(&weak_form(variant, &choices, &|_| true)?.1);
    let system = SensitiveSystem::new(&model, problem.law)?;
    // Residuals fall on whole steps.
    let stride = (cutting.residual_s / cutting.step_s).round().max(1.0) as usize;
    // Channels without a deviation over the trials, or without a state in the system, are not
    // compared.
    let compared = compared_states(system.state_places(), &problem.deviations);
    let plan = ComparisonPlan { compared, stride, step_s: cutting.step_s };
    let segments =
        divide_into_segments(&problem.training, problem.law, system.input_names(), cutting, &plan)?;
    if segments.is_empty() {
        return Ok(());
    }
    // The ship is needed for its physical range only.
    let ship = prepare_ship(&model, problem.law, &problem.training)?;
    // Without thresholds at first, which are set from the residuals of the first simulations.
    let thresholds = vec![f64::INFINITY; plan.compared.len()];
    let trials = problem.training.len();
    let passing = SegmentSimulation {
        segments: &segments,
        plan: &plan,
        envelope: *ship.envelope(),
        thresholds,
        trials,
    };
    let names = system.names().to_vec();
    let parameters = free_parameters(&variant.model, problem.law);
    TrajectoryDescent { problem, variant, index, choices: &choices, passing, names, parameters }
        .add_candidates(error, candidates, progress)
}

/// Lengths by which trials are divided into segments, rounded to whole sampling intervals.
fn segment_lengths(problem: &RefinementProblem<'_>) -> SegmentLengths {
    let given = &problem.settings;
    let interval = problem.interval_s();
    let step_s = interval * (given.step_s.unwrap_or(interval) / interval).round().max(1.0);
    let segment_s = given.segment_s.unwrap_or(TRAJECTORY.fallback_steps * step_s);
    SegmentLengths {
        segment_s,
        residual_s: given.residual_s.unwrap_or(TRAJECTORY.fallback_stride * step_s).max(step_s),
        step_s,
    }
}

/// The statistics of some trials, and the weak form's coefficients on them.
fn weak_form(
    variant: &TermVariant,
    choices: &RidgeChoices,
    keep: &dyn Fn(usize) -> bool,
) -> Result<(Vec<RegressionMoments>, BTreeMap<String, f64>), RefineError> {
    let moments = merge_trials(&variant.moments, keep).ok_or_else(|| {
        RefineError::Data("a fold has no samples; give more or longer trials".into())
    })?;
    let solved = RegressionFold::new(&variant.blocks, &variant.model, &moments, &[]).solve(choices);
    Ok((moments, solved.into_iter().map(|(name, fitted)| (name, fitted.value)).collect()))
}

impl TrajectoryDescent<'_> {
    /// Adds a candidate for each pull; `weak` is the error of the weak form from which they start.
    fn add_candidates(
        mut self,
        weak: Option<f64>,
        candidates: &mut Vec<CandidateFit>,
        progress: Progress<'_>,
    ) -> Result<(), RefineError> {
        let prior = self.weak_form_prior(&|_| true)?;
        // Thresholds are fixed at the weak form, so that the cost of the residuals is the same
        // function for every pull.
        self.passing.thresholds = self.huber_thresholds(&prior.weak)?;
        // Each fold has the prior of its own training trials, without its held-out ones.
        let priors: Vec<WeakFormPrior> = (0..self.problem.fold_count())
            .into_par_iter()
            .map(|fold| self.weak_form_prior(&|t| self.problem.is_fitted(t, fold)))
            .collect::<Result<_, _>>()?;
        // Each pull starts at the result of the stronger one before it.
        let mut reached = self.linearise_at(prior.weak.clone())?;
        // Pulls towards a typical ship do not begin at the weak form: strong ones may be worse than
        // it, and weaker ones better.
        let first = weak.filter(|_| prior.has_weak_form());
        let mut errors = vec![first.unwrap_or(f64::INFINITY)];
        for pull in TRAJECTORY.pulls {
            let label = format!("trajectory, {}, pull {pull:.0e}", self.variant.family.name());
            report_progress(progress, 0.7, &label)?;
            reached = self.descend(&prior, pull, reached)?;
            report_progress(progress, 0.7, &format!("{label}: simulating held-out manoeuvres"))?;
            let models: Vec<Model> = priors
                .par_iter()
                .enumerate()
                .map(|(fold, prior)| self.fold_model(fold, prior, pull, &reached))
                .collect();
            let simulated =
                simulate_training(self.problem, &models, &|trial| self.problem.fold_of(trial))?;
            let fit = self.trajectory_fit(&prior, pull, &reached);
            let candidate = CandidateFit::new(
                self.problem,
                (label, Some(pull)),
                fit,
                self.names.len() + self.parameters.len(),
                simulated,
            );
            errors.push(candidate.option.error.unwrap_or(f64::INFINITY));
            candidates.push(CandidateFit { left_out: models, ..candidate });
            // Weaker pulls cost a descent each.
            if is_past_best(&errors) || is_below_noise(&prior, pull, &reached.pass) {
                break;
            }
        }
        Ok(())
    }

    /// Huber's thresholds from the residuals of every few blocks of segments.
    fn huber_thresholds(&self, at: &DVector<f64>) -> Result<Vec<f64>, RefineError> {
        let system = self.system_at(at)?;
        Ok(self
            .passing
            .residual_sizes(&system, TRAJECTORY.median_stride)
            .into_iter()
            .map(huber_threshold)
            .collect())
    }

    /// The prior by the weak form on some trials.
    fn weak_form_prior(&self, keep: &dyn Fn(usize) -> bool) -> Result<WeakFormPrior, RefineError> {
        let (moments, values) = weak_form(self.variant, self.choices, keep)?;
        // Coefficient of the weak form, and of the source.
        let values = |name: &str| {
            (values.get(name).copied().unwrap_or_default(), self.variant.model.coefficient(name))
        };
        let lambda = self
            .choices
            .iter()
            .flatten()
            .map(|choice| choice.lambda)
            .fold(0.0, f64::max)
            // The strength that the weak form needs may be far too large for trajectories.
            .min(TRAJECTORY.source_share);
        let prior =
            WeakFormPrior::new(&self.names, &self.variant.blocks, &moments, &values, lambda)
                .with_parameters(&self.parameters);
        Ok(match &self.problem.measure {
            PriorMeasure::Typical(deviations) => {
                prior.without_weak_form(&self.names, deviations, &self.parameters)
            }
            _ => prior,
        })
    }

    /// Coefficients and parameters by name.
    fn named_values(&self, at: &DVector<f64>) -> BTreeMap<String, f64> {
        let own = self.parameter_unknowns(at);
        let parameters = own.map(|(one, unknown)| (one.name.clone(), one.value(unknown)));
        self.names.iter().cloned().zip(at.iter().copied()).chain(parameters).collect()
    }

    /// Parameters with their unknowns, which follow the coefficients.
    fn parameter_unknowns<'b>(
        &'b self,
        at: &'b DVector<f64>,
    ) -> impl Iterator<Item = (&'b BoundedParameter, f64)> {
        self.parameters.iter().zip(at.iter().skip(self.names.len()).copied())
    }

    /// The system at coefficients and unknowns.
    fn system_at(&self, at: &DVector<f64>) -> Result<SensitiveSystem, RefineError> {
        let model = self.variant.model_at(&self.named_values(at));
        let parameters: Vec<String> = self.parameters.iter().map(|one| one.name.clone()).collect();
        Ok(SensitiveSystem::with_parameters(&model, self.problem.law, &parameters)?)
    }

    /// Simulates all segments with coefficients and unknowns.
    fn run_segments(&self, at: &DVector<f64>) -> Result<SegmentSums, RefineError> {
        let mut sums = self.passing.simulate_segments(&self.system_at(at)?);
        sums.rescale(&self.slopes(at));
        Ok(sums)
    }

    /// Derivatives of coefficients and parameters by their unknowns.
    fn slopes(&self, at: &DVector<f64>) -> DVector<f64> {
        let own = self.parameter_unknowns(at).map(|(one, unknown)| one.slope(unknown));
        let all = std::iter::repeat_n(1.0, self.names.len()).chain(own);
        DVector::from_iterator(at.len(), all)
    }

    /// The linearisation at coefficients.
    fn linearise_at(&self, at: DVector<f64>) -> Result<Linearisation, RefineError> {
        Ok(Linearisation { pass: self.run_segments(&at)?, at })
    }

    /// Descends from coefficients to the least cost nearby.
    fn descend(
        &self,
        prior: &WeakFormPrior,
        pull: f64,
        mut here: Linearisation,
    ) -> Result<Linearisation, RefineError> {
        let mut damping = TRAJECTORY.damping;
        // The cost of the prior is part of the comparison of steps, not of the segments' sums.
        let mut held =
            PenalisedEquations::new(&sum_trials(&here.pass, |_| true), prior, pull, &here.at);
        for _ in 0..TRAJECTORY.steps {
            let model = || self.variant.model_at(&self.named_values(&here.at));
            self.problem.notify_observer(&FitIterate {
                evaluations: 0,
                objective: held.cost,
                model: &model,
            });
            // A step that promises less than the least gain ends the descent, as does one without a
            // solution.
            let Some(step) = held
                .damped_step(damping)
                .filter(|step| held.predicted_gain(step) > TRAJECTORY.least_gain)
            else {
                break;
            };
            let there = self.linearise_at(&here.at + step)?;
            let next =
                PenalisedEquations::new(&sum_trials(&there.pass, |_| true), prior, pull, &there.at);
            if next.cost.is_finite() && next.cost < held.cost {
                let gained = 1.0 - next.cost / held.cost;
                (here, held) = (there, next);
                damping *= TRAJECTORY.damping_falls;
                // An accepted step that gains little ends the descent as well.
                if gained < TRAJECTORY.least_gain {
                    break;
                }
            } else {
                // A refused step is shortened by a stronger damping from the same linearisation.
                damping = (damping * TRAJECTORY.damping_grows).max(TRAJECTORY.damping_least);
                if damping > TRAJECTORY.damping_most {
                    break;
                }
            }
        }
        Ok(here)
    }

    /// The model of a fold: one Gauss-Newton step from the fit on all trials, with the fold's
    /// training trials and their weak form.
    fn fold_model(
        &self,
        fold: usize,
        prior: &WeakFormPrior,
        pull: f64,
        reached: &Linearisation,
    ) -> Model {
        // The sums by trial are kept, so that no further simulation is needed.
        let normal = sum_trials(&reached.pass, |trial| self.problem.is_fitted(trial, fold));
        let held = PenalisedEquations::new(&normal, prior, pull, &reached.at);
        let at = held
            .damped_step(TRAJECTORY.fold_damping)
            .map_or_else(|| reached.at.clone(), |step| &reached.at + step);
        self.variant.model_at(&self.named_values(&at))
    }

    /// The fit at coefficients, with the data of its errors.
    fn trajectory_fit(
        &self,
        prior: &WeakFormPrior,
        pull: f64,
        Linearisation { at, pass }: &Linearisation,
    ) -> TrajectoryFit {
        let normal = sum_trials(pass, |_| true);
        TrajectoryFit {
            variant: self.index,
            choices: self.choices.clone(),
            names: self.names.clone(),
            parameters: self.parameters.clone(),
            slopes: self.slopes(at),
            at: at.clone(),
            held: PenalisedEquations::new(&normal, prior, pull, at),
            gradients: pass.gradients.clone(),
            cost: normal.cost,
            count: normal.count,
            prior: prior.clone(),
            pull,
        }
    }
}

/// Returns true if weaker pulls cannot be better. The first error is that of the weak form.
/// Either the last two pulls were no better than one before them, or the last is clearly worse than
/// another pull that is better than the weak form.
fn is_past_best(errors: &[f64]) -> bool {
    let best = |errors: &[f64]| errors.iter().copied().fold(f64::INFINITY, f64::min);
    let [weak, .., before, last] = *errors else { return false };
    let (best, best_before) = (best(errors), best(&errors[..errors.len() - 2]));
    let none_better = best_before.is_finite() && before.min(last) >= best_before;
    none_better || (best < weak && last > TRAJECTORY.clearly_worse * best)
}

/// Returns true if a weaker pull would hold a typical ship less than its deviations are known to: the
/// cost of one deviation is then less than the mean cost of the residuals divided by the number of
/// independent ones, of which there is about one a ship length.
fn is_below_noise(prior: &WeakFormPrior, pull: f64, pass: &SegmentSums) -> bool {
    let normal = sum_trials(pass, |_| true);
    let independent = normal.count / TRAJECTORY.residuals_a_length;
    let noise = normal.cost / normal.count.max(1.0) / independent.max(1.0);
    prior.typical_strength(pull).is_some_and(|strength| strength < noise)
}

/// Normal equations of some trials together.
fn sum_trials(pass: &SegmentSums, keep: impl Fn(usize) -> bool) -> NormalEquations {
    let mut all =
        NormalEquations::zeros(pass.trials.first().map_or(0, |normal| normal.gradient.len()));
    pass.trials
        .iter()
        .enumerate()
        .filter(|(trial, _)| keep(*trial))
        .for_each(|(_, normal)| all.add(normal));
    all
}

/// Huber's threshold from absolute residuals, by their median as a robust standard deviation;
/// infinite without residuals.
fn huber_threshold(mut sizes: Vec<f64>) -> f64 {
    let middle = sizes.len() / 2;
    if sizes.is_empty() {
        return f64::INFINITY;
    }
    let (_, &mut median, _) = sizes.select_nth_unstable_by(middle, f64::total_cmp);
    // 1.4826 times the median absolute value is the standard deviation of a normal distribution.
    if median > 0.0 { TRAJECTORY.huber * 1.4826 * median } else { f64::INFINITY }
}

#[cfg(test)]
mod tests {
    use super::is_past_best;

    #[test]
    fn weaker_pulls_are_tried_until_they_are_worse() {
        // Of the weak form, then of pulls.
        assert!(!is_past_best(&[1.0]));
        assert!(
            !is_past_best(&[1.0, 1.2]),
            "one that is worse than the weak form may be followed by better ones"
        );
        assert!(is_past_best(&[1.0, 1.2, 1.1]));
        assert!(!is_past_best(&[1.0, 0.9, 0.91]), "hardly worse");
        assert!(is_past_best(&[1.0, 0.9, 0.91, 0.905]));
        assert!(is_past_best(&[1.0, 0.9, 0.95]));
        assert!(
            !is_past_best(&[f64::INFINITY, f64::INFINITY, f64::INFINITY]),
            "nothing has sailed yet"
        );
        assert!(is_past_best(&[f64::INFINITY, 0.9, f64::INFINITY]));
    }
}
