//! Checks of a learned correction besides trials held out at random.

use rayon::prelude::*;
use sistership_assessment::uncertainty::student_quantile;
use sistership_identification::refine::{RefinementSettings, RefinementSpec, fit_model};
use sistership_learned::{
    BranchCheck, BranchChoice, BranchKind, BranchSettings, CorrectionTraining, HeldOutFold,
    HeldOutTrials, KindEvaluation, TrainError, evaluate_folds, train_corrected_model,
};
use sistership_model::Model;
use sistership_model::trial::Trial;
use sistership_simulation::Ship;
use sistership_simulation::manoeuvre::{
    ManoeuvreSettings, StandardManoeuvres, simulate_standard_manoeuvres,
};

use crate::extremes::extreme_trials;
use crate::foundation::CorrectionBase;
use crate::scatter::scatter_ratio;
use crate::simulation_check::simulation_fault;

/// A kind of correction that was best on held-out trials.
pub(super) struct Correction<'a> {
    /// Base model and trials of the correction.
    pub foundation: &'a CorrectionBase<'a>,
    /// Held-out trials on which it was best.
    pub on: HeldOutTrials<'a>,
    /// The kind.
    pub kind: BranchKind,
    /// Longest step of simulations, s.
    pub step_s: f64,
}

impl Correction<'_> {
    /// Returns the choice after the checks, the cheapest first, up to the first one that is not
    /// passed.
    ///
    /// # Errors
    /// Returns an error if the correction cannot be trained.
    pub fn run_checks(&self, mut choice: BranchChoice) -> Result<BranchChoice, TrainError> {
        let model = &self.foundation.refinement.model;
        let training = BranchSettings::default().with_kind(self.kind);
        // Trained on the thinned trials of the choice; the check of simulations trains on all
        // samples.
        let training = training.complete_training(model, self.on.law, self.on.trials)?;
        type Check<'b> = &'b dyn Fn() -> Result<BranchCheck, TrainError>;
        let tried = choice.tried.iter().find(|tried| tried.kind == self.kind).cloned();
        let level = || Ok(check_significance(tried.as_ref(), self.on.trials.len()));
        let sails = || self.check_simulations();
        let certainty = || self.check_certainty(&training);
        let elsewhere = || self.check_extremes(&training);
        // Checks are closures, so that an expensive one runs only if all before it are passed.
        let checks: [Check<'_>; 4] = [&level, &sails, &certainty, &elsewhere];
        for check in checks {
            let check = check()?;
            let passed = check.passed;
            choice.reason += &describe_check(&check);
            choice.checks.push(check);
            if !passed {
                choice.taken = None;
                break;
            }
        }
        Ok(choice)
    }

    /// Checks that the correction, trained on all trials, completes the records that every model
    /// must complete.
    fn check_simulations(&self) -> Result<BranchCheck, TrainError> {
        let CorrectionBase { refinement, trials, .. } = *self.foundation;
        let settings = BranchSettings::default().with_kind(self.kind);
        let training = settings.complete_training(&refinement.model, self.on.law, trials)?;
        let model = train_corrected_model(
            &refinement.model.without_correction(),
            self.on.law,
            trials,
            &training,
        )?;
        let of = |model: &Model| simulation_fault(model, self.on.law, trials).is_some();
        let count = |fails: bool| if fails { 1.0 } else { 0.0 };
        let (own, both) = (count(of(&refinement.model)), count(of(&model)));
        Ok(compare_values("simulations outside the trials that fail", own, both))
    }

    /// Checks that the models of folds scatter no more in the standard manoeuvres with the
    /// correction.
    fn check_certainty(&self, training: &CorrectionTraining) -> Result<BranchCheck, TrainError> {
        let pair = |fold: &HeldOutFold| {
            let both = self.on.corrected_model(fold, training)?;
            Ok((self.standard_manoeuvres(&fold.foundation)?, self.standard_manoeuvres(&both)?))
        };
        let pairs: Vec<(StandardManoeuvres, StandardManoeuvres)> =
            self.on.folds.par_iter().map(pair).collect::<Result<_, TrainError>>()?;
        let (own, both): (Vec<_>, Vec<_>) = pairs.into_iter().unzip();
        let ratio = scatter_ratio(&own, &both);
        Ok(compare_values("relative variance of the standard manoeuvres over folds", 1.0, ratio))
    }

    fn standard_manoeuvres(&self, model: &Model) -> Result<StandardManoeuvres, TrainError> {
        let mut ship = Ship::new(model, self.on.law)?;
        ship.disable_excursions();
        let settings = ManoeuvreSettings { figures_only: true, ..ManoeuvreSettings::default() };
        Ok(simulate_standard_manoeuvres(&ship, &settings))
    }

    /// Checks that the correction is no worse on the trials of the largest and smallest rudder
    /// angles and speeds, held out of both base model and correction.
    fn check_extremes(&self, training: &CorrectionTraining) -> Result<BranchCheck, TrainError> {
        let what = "held-out trials of the extreme rudder angles and speeds";
        let held_out = extreme_trials(self.foundation.trials);
        let folds: Vec<HeldOutFold> =
            held_out.into_par_iter().filter_map(|places| self.refit_without(places)).collect();
        let on = HeldOutTrials { folds: &folds, ..self.on };
        Ok(evaluate_folds(&on, training, self.step_s)?.map_or_else(
            || {
                compare_values(
                    "held-out trials of the extreme rudder angles and speeds: there are \
                               none",
                    0.0,
                    0.0,
                )
            },
            |judged| compare_values(what, judged.foundation, judged.branch),
        ))
    }

    /// The base model refined without some trials; `None` if the others give no model.
    fn refit_without(&self, held_out: Vec<usize>) -> Option<HeldOutFold> {
        let CorrectionBase { request, trials, .. } = *self.foundation;
        // The others are fitted by the same request, with nothing held out.
        let others = trials.iter().enumerate().filter(|(place, _)| !held_out.contains(place));
        let others: Vec<&Trial> = others.map(|(_, trial)| *trial).collect();
        let settings = RefinementSettings { held_out: Vec::new(), ..request.settings.clone() };
        let request = RefinementSpec { trials: &others, settings: &settings, ..request };
        let foundation = fit_model(&request).ok()?.without_correction();
        Some(HeldOutFold { foundation, held_out })
    }
}

/// Checks that the gain on trials held out at random is significant (95 %).
fn check_significance(tried: Option<&KindEvaluation>, trials: usize) -> BranchCheck {
    let what = "held-out trials, 95 % bound";
    // A single trial has no standard error: nothing is significant.
    tried.and_then(|tried| Some((tried, tried.standard_error?))).map_or_else(
        || compare_values(what, 0.0, f64::MAX),
        |(tried, standard_error)| {
            let sure = student_quantile(trials.max(2) - 1) * standard_error;
            compare_values(what, tried.foundation, tried.branch + sure)
        },
    )
}

/// The check that an error or count with the correction is not above the one without it.
fn compare_values(what: &str, foundation: f64, branch: f64) -> BranchCheck {
    let passed = branch <= foundation;
    BranchCheck { what: what.to_owned(), foundation, branch, passed }
}

/// A check as part of a sentence.
fn describe_check(check: &BranchCheck) -> String {
    let BranchCheck { what, foundation, branch, passed } = check;
    let end = if *passed { "" } else { ": it is not used" };
    format!("; {what}: {branch:.3e} with it and {foundation:.3e} without{end}")
}
