//! The weak form as an estimator: the ridge on its windows, at strengths from the source outwards.

use super::super::candidate::CandidateFit;
use super::super::equations::EquationForm;
use super::super::estimator::Estimator;
use super::super::family::TermFamily;
use super::super::outcome::RefineError;
use super::super::problem::RefinementProblem;
use super::super::progress::{PartProgress, Progress};
use super::super::ridge::RegressionFold;
use super::super::ridge_candidates::{for_each_variant, ridge_candidate};
use super::super::settings::RefinementSettings;
use super::super::thresholds::SELECTION;
use super::super::variant::TermVariant;
use super::WindowSpacing;
use super::thresholds::WEAK;
use sistership_model::law::Law;

/// The weak form.
pub(in super::super) struct WeakForm;

impl Estimator for WeakForm {
    fn resolve_settings(&self, settings: &mut RefinementSettings, _: &Law, length_s: Option<f64>) {
        resolve_windows(settings, length_s, &TermFamily::ALL);
    }

    fn equation_form(&self, settings: &RefinementSettings) -> EquationForm {
        window_form(settings)
    }

    fn add_candidates(
        &self,
        problem: &RefinementProblem<'_>,
        variants: &[TermVariant],
        candidates: &mut Vec<CandidateFit>,
        progress: Progress<'_>,
    ) -> Result<(), RefineError> {
        let mut strengths =
            |at: (usize, &TermVariant), folds: &[RegressionFold<'_>], told: PartProgress<'_>| {
                by_strength(problem, at, folds, told, candidates)
            };
        for_each_variant(problem, variants, progress, &mut strengths)
    }
}

/// Fills in windows and strengths, and `families` if the settings name none. Estimators that start
/// from the weak form use it too.
pub(in super::super) fn resolve_windows(
    settings: &mut RefinementSettings,
    length_s: Option<f64>,
    families: &[TermFamily],
) {
    settings.window_s = settings.window_s.or(length_s);
    settings.hop_s = settings.hop_s.or(settings.window_s.map(|s| WEAK.hop * s));
    settings.fill_selection(families);
}

/// Returns the windows of the settings as the method that makes rows.
pub(in super::super) fn window_form(settings: &RefinementSettings) -> EquationForm {
    let length_s = settings.window_s.unwrap_or(0.0);
    let hop_s = settings.hop_s.unwrap_or(WEAK.hop * length_s);
    EquationForm::Windows(WindowSpacing { length_s, hop_s })
}

/// Adds one candidate for each strength of the prior, from the source outwards.
fn by_strength(
    problem: &RefinementProblem<'_>,
    at: (usize, &TermVariant),
    folds: &[RegressionFold<'_>],
    told: PartProgress<'_>,
    candidates: &mut Vec<CandidateFit>,
) -> Result<(), RefineError> {
    let strengths = family_strengths(problem, at.1.family, candidates);
    // A single trial cannot be held out, so that it allows only the strengths nearest to the
    // source.
    let allowed = if problem.training.len() == 1 {
        strengths.len().min(WEAK.strengths_of_one_trial)
    } else {
        strengths.len()
    };
    let roll = problem.settings.roll_strength.unwrap_or(1.0);
    for (k, &lambda) in strengths.iter().take(allowed).enumerate() {
        let name = format!("{}, lambda {lambda:.0e}", at.1.family.name());
        told(k as f64 / allowed as f64, &format!("{name}: simulating held-out manoeuvres"))?;
        let choices = at.1.common_choices(lambda, roll)?;
        candidates.push(ridge_candidate(problem, (name, lambda), at, choices, folds)?);
    }
    Ok(())
}

/// The strengths with which a family of terms is tried. Asymmetric terms, which most ships do not
/// have, are tried only near the best strength of the other terms.
fn family_strengths(
    problem: &RefinementProblem<'_>,
    family: TermFamily,
    candidates: &[CandidateFit],
) -> Vec<f64> {
    let all = &problem.settings.strengths;
    let known =
        candidates.iter().filter_map(|one| Some((one.option.lambda_min?, one.option.error?)));
    let best =
        known.min_by(|a, b| a.1.total_cmp(&b.1)).filter(|_| family == TermFamily::Asymmetric);
    let Some((best, _)) = best else { return all.clone() };
    let far = SELECTION.near_strength * (1.0 + f64::EPSILON.sqrt());
    let is_near = |strength: &&f64| (*strength / best).max(best / *strength) <= far;
    all.iter().filter(is_near).copied().collect()
}
