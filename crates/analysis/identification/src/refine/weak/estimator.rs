//! The weak form as an estimator: the ridge on its windows, at strengths from the source outwards.

use super::super::candidate::CandidateFit;
use super::super::equations::Equations;
use super::super::estimator::Estimator;
use super::super::family::Family;
use super::super::outcome::RefineError;
use super::super::problem::Problem;
use super::super::progress::{PartProgress, Progress};
use super::super::ridge::Fold;
use super::super::ridge_candidates::{each_variant, ridge_candidate};
use super::super::settings::Settings;
use super::super::thresholds::SELECTION;
use super::super::variant::Variant;
use super::Windows;
use super::thresholds::WEAK;
use sistership_model::law::Law;

/// The weak form.
pub(in super::super) struct WeakForm;

impl Estimator for WeakForm {
    fn resolve(&self, settings: &mut Settings, _: &Law, length_s: Option<f64>) {
        resolve(settings, length_s, &Family::ALL);
    }

    fn equations(&self, settings: &Settings) -> Equations {
        equations(settings)
    }

    fn candidates(
        &self,
        problem: &Problem<'_>,
        variants: &[Variant],
        candidates: &mut Vec<CandidateFit>,
        progress: Progress<'_>,
    ) -> Result<(), RefineError> {
        let mut strengths = |at: (usize, &Variant), folds: &[Fold<'_>], told: PartProgress<'_>| {
            by_strength(problem, at, folds, told, candidates)
        };
        each_variant(problem, variants, progress, &mut strengths)
    }
}

/// Fills in windows and strengths, and `families` if the settings name none. Estimators that start
/// from the weak form use it too.
pub(in super::super) fn resolve(
    settings: &mut Settings,
    length_s: Option<f64>,
    families: &[Family],
) {
    settings.window_s = settings.window_s.or(length_s);
    settings.hop_s = settings.hop_s.or(settings.window_s.map(|s| WEAK.hop * s));
    settings.fill_selection(families);
}

/// Returns the windows of the settings as the method that makes rows.
pub(in super::super) fn equations(settings: &Settings) -> Equations {
    let length_s = settings.window_s.unwrap_or(0.0);
    let hop_s = settings.hop_s.unwrap_or(WEAK.hop * length_s);
    Equations::Windows(Windows { length_s, hop_s, in_means: settings.economical })
}

/// Adds one candidate for each strength of the prior, from the source outwards.
fn by_strength(
    problem: &Problem<'_>,
    at: (usize, &Variant),
    folds: &[Fold<'_>],
    told: PartProgress<'_>,
    candidates: &mut Vec<CandidateFit>,
) -> Result<(), RefineError> {
    let strengths = strengths(problem, at.1.family, candidates);
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
        told(k as f64 / allowed as f64, &format!("{name}: simulating manoeuvres left out"))?;
        let choices = at.1.common_choices(lambda, roll)?;
        candidates.push(ridge_candidate(problem, (name, lambda), at, choices, folds)?);
    }
    Ok(())
}

/// The strengths with which a family of terms is tried. Asymmetric terms, which most ships do not
/// have, are tried only near the best strength of the other terms.
fn strengths(problem: &Problem<'_>, family: Family, candidates: &[CandidateFit]) -> Vec<f64> {
    let all = &problem.settings.strengths;
    let known =
        candidates.iter().filter_map(|one| Some((one.option.lambda_min?, one.option.error?)));
    let best = known.min_by(|a, b| a.1.total_cmp(&b.1)).filter(|_| family == Family::Asymmetric);
    let Some((best, _)) = best else { return all.clone() };
    let far = SELECTION.near_strength * (1.0 + f64::EPSILON.sqrt());
    let is_near = |strength: &&f64| (*strength / best).max(best / *strength) <= far;
    all.iter().filter(is_near).copied().collect()
}
