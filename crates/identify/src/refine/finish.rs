//! The end of a refinement: the best option is taken, and everything that its user must be able to defend is gathered.

use sistership_dynamics::Ship;
use sistership_dynamics::manoeuvre::{ManoeuvreSettings, StandardManoeuvres, standard};
use sistership_dynamics::metrics::{Recognised, recorded_track};
use sistership_dynamics::recorded::{Recorded, Replay, ReplaySettings, replay_all};
use sistership_dynamics::validity::covered;
use sistership_model::Model;
use sistership_model::posterior::Posterior;
use sistership_model::quantity::Quantity;
use sistership_model::trial::Trial;

use super::blocks::Blocks;
use super::cma_es::SearchReport;
use super::family::Family;
use super::outcome::{CoefficientChange, HeldOut, Manoeuvres, MeasuredManoeuvre, RefineError, Refinement};
use super::posterior::Errors;
use super::published::{Choices, Fit, Fold, fit};
use super::selection::{Progress, Taken, Task, Trying, step};
use super::settings::Settings;
use super::variant::{Variant, merged};
use crate::bands::bands;
use crate::regression::Choice;
use crate::transfer::ready;

/// What an option gives with its standard manoeuvres, or why it may not be taken.
type Accepted = Result<(Option<Fit>, StandardManoeuvres), String>;

impl Task<'_> {
    /// Takes the best option whose model, fitted on all trials, also sails the standard manoeuvres that the source sails.
    pub(super) fn finish(
        &self,
        mut options: Vec<Trying>,
        variants: &[Variant],
        progress: Progress<'_>,
    ) -> Result<Refinement, RefineError> {
        step(progress, 0.9, "standard manoeuvres of the source")?;
        let before = self.standard_manoeuvres(&self.transferred);
        loop {
            let Some(best) = best(&options) else {
                let reasons: Vec<String> = options.iter().filter_map(|o| o.option.reason.clone()).collect();
                return Err(RefineError::Diverged(reasons.join("; ")));
            };
            step(progress, 0.9, &format!("standard manoeuvres of option {}", options[best].option.step))?;
            match self.accepted(&options[best].taken, variants, &before)? {
                Ok((fitted, after)) => return self.take(options, best, (fitted, variants), (before, after), progress),
                Err(reason) => (options[best].option.reason, options[best].option.error) = (Some(reason), None),
            }
        }
    }

    /// What an option gives on all trials, where it keeps the constraints and sails what the source sails; else the reason.
    fn accepted(&self, taken: &Taken, variants: &[Variant], before: &StandardManoeuvres) -> Result<Accepted, RefineError> {
        let fitted = match self.fitted(taken, variants) {
            Err(RefineError::Constraints(reason)) => return Ok(Err(reason)),
            fitted => fitted?,
        };
        let after = self.standard_manoeuvres(&self.model_of(fitted.as_ref()));
        let worse = after.failures.iter().find(|failure| before.failures.is_empty() && !failure.is_empty());
        Ok(match worse {
            Some(failure) => Err(format!("fails a standard manoeuvre that the source sails: {failure}")),
            None => Ok((fitted, after)),
        })
    }

    /// The refined model; the source where nothing was fitted.
    fn model_of(&self, fitted: Option<&Fit>) -> Model {
        let mut model = fitted.map_or_else(|| self.transferred.clone(), |fit| self.model_with(&fit.coefficients));
        model.validity = covered(&self.whole, self.law);
        model
    }

    /// The refinement by an option, with its errors.
    fn take(
        &self,
        mut options: Vec<Trying>,
        best: usize,
        (fitted, variants): (Option<Fit>, &[Variant]),
        (before, after): (StandardManoeuvres, StandardManoeuvres),
        progress: Progress<'_>,
    ) -> Result<Refinement, RefineError> {
        options[best].option.chosen = true;
        let errors = self.errors_of(&options[best].taken, variants)?;
        let fitted = fitted.map(|fit| fit.with_errors(errors));
        let mut model = self.model_of(fitted.as_ref());
        model.posterior = self.posterior(&model, fitted.as_ref(), variants)?;
        let measured = self.measured_manoeuvres(&model);
        step(progress, 0.93, "confidence bands")?;
        let bands = bands(&model, self.law, &ManoeuvreSettings::default(), None, self.settings.bands);
        let manoeuvres = Manoeuvres { source: before, refined: after, bands, measured };
        self.refinement(options, best, model, fitted, manoeuvres)
    }

    /// What an option gives on all trials, without errors.
    pub(super) fn fitted(&self, taken: &Taken, variants: &[Variant]) -> Result<Option<Fit>, RefineError> {
        let (variant, choices) = match taken {
            Taken::Source => return Ok(None),
            Taken::Reached(bend) => return Ok(Some(bend.fit())),
            Taken::Found(fit) => return Ok(Some((**fit).clone())),
            Taken::Ridge { variant, choices } => (&variants[*variant], choices),
        };
        let all = merged(&variant.moments, |_| true).ok_or_else(|| RefineError::Data("the trials have no sample".into()))?;
        let mut fitted = fit(&variant.blocks, &all, &variant.model, choices);
        if variant.limits.is_some() {
            let fold = Fold::new(&variant.blocks, &variant.model, &all, &[]);
            fitted.coefficients = variant.solve(&fold, choices).map_err(RefineError::Constraints)?;
        }
        Ok(Some(fitted))
    }

    /// The joint errors of what an option gives.
    fn errors_of(&self, taken: &Taken, variants: &[Variant]) -> Result<Option<Errors>, RefineError> {
        match taken {
            Taken::Ridge { variant, choices } => self.errors(&variants[*variant], choices),
            Taken::Reached(bend) => {
                let weak = self.errors(&variants[bend.variant], &bend.choices)?;
                Ok(weak.and_then(|weak| bend.errors(&weak)))
            }
            Taken::Source | Taken::Found(_) => Ok(None),
        }
    }

    /// How far the model's coefficients may be from the truth. Those of a source that is kept are as far as the trials say
    /// that they are.
    fn posterior(&self, model: &Model, fitted: Option<&Fit>, variants: &[Variant]) -> Result<Option<Posterior>, RefineError> {
        let errors = match (fitted, variants.iter().find(|variant| variant.family == Family::Own)) {
            (Some(fitted), _) => fitted.errors.clone(),
            (None, Some(own)) => self.errors(own, &held(&own.blocks))?,
            (None, None) => None,
        };
        Ok(errors.and_then(|errors| errors.posterior(model)))
    }

    /// The turning circles and zigzags among the trials, beside what both models make of the recorded rudder.
    fn measured_manoeuvres(&self, refined: &Model) -> Vec<MeasuredManoeuvre> {
        let trials = self.whole.iter().map(|trial| (*trial, true)).chain(self.judged.iter().map(|trial| (*trial, false)));
        let recognised: Vec<(&Trial, bool, Recognised)> =
            trials.filter_map(|(trial, fitted)| Some((trial, fitted, Recognised::of(trial)?))).collect();
        let trials: Vec<&Trial> = recognised.iter().map(|(trial, ..)| *trial).collect();
        let [source, refined] = [&self.transferred, refined].map(|model| self.sailed(model, &trials));
        let one = |(k, (trial, fitted, recognised)): (usize, &(&Trial, bool, Recognised))| {
            let samples: Vec<usize> = (0..trial.len()).collect();
            let simulated = |runs: &[Replay]| {
                let run = runs.get(k).filter(|run| run.stopped.is_none())?;
                recognised.metrics(&run.track, &run.samples)
            };
            Some(MeasuredManoeuvre {
                trial: trial.name.clone(),
                fitted: *fitted,
                measured: recognised.metrics(&recorded_track(trial)?, &samples)?,
                source: simulated(&source),
                refined: simulated(&refined),
            })
        };
        recognised.iter().enumerate().filter_map(one).collect()
    }

    /// Trials from beginning to end by a model; nothing where it cannot sail them.
    fn sailed(&self, model: &Model, trials: &[&Trial]) -> Vec<Replay> {
        let Ok(ship) = ready(model, self.law, trials) else { return Vec::new() };
        let recorded: Vec<Recorded<'_>> = trials.iter().map(|trial| Recorded { trial, coefficients: &[] }).collect();
        replay_all(&ship, &recorded, &ReplaySettings::default()).unwrap_or_default()
    }

    fn standard_manoeuvres(&self, model: &Model) -> StandardManoeuvres {
        match Ship::new(model, self.law) {
            Ok(ship) => standard(&ship, &ManoeuvreSettings::default()),
            Err(error) => StandardManoeuvres { failures: vec![error.to_string()], ..Default::default() },
        }
    }

    fn refinement(
        &self,
        options: Vec<Trying>,
        best: usize,
        model: Model,
        fitted: Option<Fit>,
        manoeuvres: Manoeuvres,
    ) -> Result<Refinement, RefineError> {
        let held_out = self.held_out(&options, best, &model)?;
        let lambdas = options[best].option.lambda.clone();
        let (condition_number, collinear_groups) =
            fitted.as_ref().map_or((1.0, Vec::new()), |fit| (fit.condition_number, fit.collinear_groups.clone()));
        let mut remarks = self.remarks(best, &lambdas);
        if options[best].search.is_some() {
            remarks.push(SEARCHED.to_owned());
        }
        let search = options[best].search.clone().or_else(|| options.iter().find_map(|trying| trying.search.clone()));
        Ok(Refinement {
            ship: self.transferred.ship.clone(),
            source: self.source.to_owned(),
            method: self.settings.method.name().to_owned(),
            coefficients: self.changes(&model, fitted.as_ref()),
            model,
            transferred: self.transferred.clone(),
            settings: self.recorded(search.as_ref()),
            search,
            condition_number,
            collinear_groups,
            held_out,
            options: options.into_iter().map(|trying| trying.option).collect(),
            manoeuvres,
            remarks,
        })
    }

    /// The settings that give the same again: a search that time has ended has its evaluations for a budget.
    fn recorded(&self, search: Option<&SearchReport>) -> Settings {
        let mut settings = self.settings.clone();
        if let (Some(given), Some(search)) = (&mut settings.cma_es, search) {
            (given.evaluations, given.wall_s, given.cpu_s) = (search.evaluations, None, None);
        }
        settings
    }

    fn held_out(&self, options: &[Trying], best: usize, model: &Model) -> Result<HeldOut, RefineError> {
        if self.judged.is_empty() {
            let how = if self.training.len() == 1 {
                "nothing could be left out of a single trial: these are errors on the trial that was fitted".to_owned()
            } else {
                let what = match self.whole.len() {
                    whole if whole == self.training.len() => format!("{whole} trials"),
                    whole => format!("{} parts of {whole} trials", self.training.len()),
                };
                format!("each of {what} simulated by a model fitted without it, in {} folds", self.fold_count())
            };
            return Ok(HeldOut { source: options[0].errors.rmse(), refined: options[best].errors.rmse(), how });
        }
        let source = self.simulate_all(&self.judged, std::slice::from_ref(&self.transferred), &|_| 0)?.total;
        let refined = self.simulate_all(&self.judged, std::slice::from_ref(model), &|_| 0)?.total;
        let names: Vec<&str> = self.judged.iter().map(|trial| trial.name.as_str()).collect();
        Ok(HeldOut {
            source: source.rmse(),
            refined: refined.rmse(),
            how: format!("kept out of fit and choice: {}", names.join(", ")),
        })
    }

    fn changes(&self, model: &Model, fitted: Option<&Fit>) -> Vec<CoefficientChange> {
        let one = |(name, quantity): (&String, &Quantity)| {
            let source = self.transferred.coefficient(name);
            let fitted = fitted.and_then(|fit| fit.coefficients.get(name));
            let prior = fitted.map_or(0.0, |f| f.prior_deviation);
            let unit = self.law.coefficient_dimension(name).map_or_else(|_| "?".to_owned(), |d| d.to_string());
            CoefficientChange {
                name: name.clone(),
                unit,
                source,
                refined: quantity.value,
                standard_error: fitted.map_or(0.0, |f| f.standard_error),
                moved_sd: if prior > 0.0 { (quantity.value - source) / prior } else { 0.0 },
            }
        };
        model.coefficients.iter().map(one).collect()
    }

    fn remarks(&self, best: usize, lambdas: &[f64]) -> Vec<String> {
        let mut remarks = Vec::new();
        let strongest = self.settings.ranges.iter().map(|range| range.lambda_max).fold(0.0, f64::max);
        if lambdas.iter().any(|lambda| *lambda > 0.999 * strongest) {
            let what = "an acceleration took the strongest prior allowed: its coefficients are the source's, scaled as a whole by 1 - alpha";
            remarks.push(format!("{what}, and their standard errors say nothing"));
        }
        remarks.extend(self.measure.words(&self.transferred, self.law));
        if best == 0 {
            remarks.push("no option beat the source on manoeuvres left out: the source is kept as it is".to_owned());
        }
        if self.training.len() == 1 {
            remarks.push("a single trial: only the most conservative range was tried".to_owned());
        }
        let scaled = self.transferred.particulars.iter().filter(|(_, quantity)| quantity.source.starts_with("scaled from"));
        let names: Vec<&str> = scaled.map(|(name, _)| name.as_str()).collect();
        if !names.is_empty() {
            remarks.push(format!("the ship does not state {}: scaled from the source ship", names.join(", ")));
        }
        remarks
    }
}

/// What a search leaves out.
const SEARCHED: &str = "a search gives no standard errors and no confidence bands; its fits with trials left out start at the \
     optimum for all of them, so that errors on trials left out are somewhat too small unless the budget is large";

/// Choices that keep the source.
fn held(blocks: &Blocks) -> Choices {
    blocks.blocks.iter().map(|block| vec![Choice { lambda: 1e9, alpha: 0.0 }; block.axes.len()]).collect()
}

/// The option with the least error; an earlier one wins unless a later one is better by more than one per cent, and against
/// one with fewer coefficients by more than two standard errors of the difference over the trials (Breiman et al. 1984,
/// Classification and regression trees, section 3.4.3).
pub(super) fn best(options: &[Trying]) -> Option<usize> {
    let mut best: Option<(usize, f64)> = None;
    for (index, error) in options.iter().enumerate().filter_map(|(index, o)| Some((index, o.option.error?))) {
        let better = |(at, least): (usize, f64)| error < 0.99 * least && clearly(&options[index], &options[at]);
        if error.is_finite() && best.is_none_or(better) {
            best = Some((index, error));
        }
    }
    best.map(|(index, _)| index)
}

/// Whether an option may replace one that has fewer coefficients; the source has none of its own to count.
fn clearly(new: &Trying, old: &Trying) -> bool {
    if old.size == 0 || new.size <= old.size || new.each.len() != old.each.len() || new.each.len() < 2 {
        return true;
    }
    let gains: Vec<f64> = old.each.iter().zip(&new.each).map(|(old, new)| old - new).collect();
    let count = gains.len() as f64;
    let mean = gains.iter().sum::<f64>() / count;
    let variance = gains.iter().map(|gain| (gain - mean).powi(2)).sum::<f64>() / (count - 1.0);
    mean > 2.0 * (variance / count).sqrt()
}
