//! Detection limits: the smallest size of an effect that these trials and this model would still
//! have shown.
//!
//! An effect of a given value changes the evidence for it, and for every other that resembles it, by
//! the information on its columns; chance adds a known spread. The limit is the smallest size at
//! which the evidence is sufficient, and above every other's, with a probability of 90 %: the
//! minimum detectable value of a test with given error probabilities (Currie 1968, Anal Chem 40,
//! 586-593). The model alone competes, too, with any other level of the random accelerations.

mod expected_evidence;
mod size_grid;

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use sistership_model::effect::{ActsOn, EffectParameter};

use super::evidence::MarginalInformation;
use super::filtered_base::FilteredBase;
use super::outcome::{DetectionLimit, LimitedBy};
use super::search::HypothesisSearch;
use super::thresholds::THRESHOLDS;
use super::values::form_target;
use expected_evidence::{InformationView, WeighedCandidate};
use sistership_filtering::EffectCandidate;
use sistership_identification::refine::RefineError;
use size_grid::SizeGrid;

/// Returns the limits of every listed effect and of each of its parameters whose absence is zero,
/// from a base without effects at one of its levels.
///
/// # Errors
/// Returns an error if the information is not positive.
pub(super) fn detection_limits(
    search: &HypothesisSearch<'_>,
    base: &FilteredBase<'_>,
    level: usize,
    least_evidence: f64,
) -> Result<Vec<DetectionLimit>, RefineError> {
    let all = DetectionAnalysis::new(search, base, level, least_evidence)?;
    let listed = (0..all.candidates.len()).into_par_iter().filter(|&at| all.is_listed(at));
    Ok(listed.flat_map_iter(|place| all.candidate_limits(place)).collect())
}

/// All candidates on these trials, with the coefficients integrated out.
struct DetectionAnalysis<'a> {
    search: &'a HypothesisSearch<'a>,
    candidates: Vec<&'a EffectCandidate>,
    /// Indices of the columns of each in the information.
    places: Vec<Vec<usize>>,
    /// Information divided by false-alarm levels.
    discounted: InformationView,
    /// Information of the trials.
    plain: InformationView,
    /// Information if the coefficients were known.
    of_known: InformationView,
    /// The model alone at each level of the discrepancy.
    alone: Vec<AloneLevel>,
    level: usize,
    least_evidence: f64,
}

/// The model alone at a level of the discrepancy.
struct AloneLevel {
    /// Logarithm of its probability on these trials.
    log_evidence: f64,
    /// Information by which an effect that is present reduces it: half the square of its size by
    /// this.
    information: DMatrix<f64>,
}

impl<'a> DetectionAnalysis<'a> {
    fn new(
        search: &'a HypothesisSearch<'a>,
        base: &FilteredBase<'_>,
        level: usize,
        least_evidence: f64,
    ) -> Result<Self, RefineError> {
        let candidates = search.other_candidates(&[]);
        let columns: Vec<Vec<usize>> = candidates
            .iter()
            .map(|candidate| base.workspace.columns().matching_columns(candidate))
            .collect();
        let size = search.nuisance.len();
        let select: Vec<usize> = (0..size).chain(columns.iter().flatten().copied()).collect();
        let mut first = 0;
        // Columns are consecutive in the reduced information.
        let place = |columns: &Vec<usize>| {
            first += columns.len();
            (first - columns.len()..first).collect()
        };
        let places: Vec<Vec<usize>> = columns.iter().map(place).collect();
        let total = base.total_products(level).select_columns(&select);
        // Without integration: the products of the effects' columns themselves.
        let of_known = total.products.view_range(1 + size.., 1 + size..).into_owned();
        let at = |level: usize| {
            let total = base.total_products(level).select_columns(&select);
            let reduced = MarginalInformation::new(&total, &search.fixed)?;
            let log_evidence = base.levels[level].level.log_prior - 0.5 * reduced.deviance;
            Ok(AloneLevel { log_evidence, information: reduced.information })
        };
        let alone: Vec<AloneLevel> =
            (0..base.levels.len()).map(at).collect::<Result<_, RefineError>>()?;
        let information = alone[level].information.clone();
        let view = |information: DMatrix<f64>, discount: &dyn Fn(&EffectCandidate) -> f64| {
            InformationView::new(search, information, (&candidates, &places), discount)
        };
        Ok(Self {
            discounted: view(information.clone(), &|candidate| {
                search.candidate_discount(candidate)
            }),
            plain: view(information, &|_| 1.0),
            of_known: view(of_known, &|_| 1.0),
            search,
            candidates,
            places,
            alone,
            level,
            least_evidence,
        })
    }

    fn is_listed(&self, place: usize) -> bool {
        place < self.search.listed.len()
    }

    /// Limits of a candidate's parameters.
    fn candidate_limits(&self, place: usize) -> Vec<DetectionLimit> {
        let candidate = self.candidates[place];
        let parameters = candidate.form.parameters.iter().enumerate();
        let one = |(own, (name, parameter)): (usize, (&String, &EffectParameter))| {
            if parameter.absent != 0.0 {
                return None;
            }
            let usual = parameter.prior_mean.abs() + parameter.prior_deviation;
            let is_discounted = self.search.candidate_discount(candidate) > 1.0;
            let view = if is_discounted { &self.discounted } else { &self.plain };
            let size = self.smallest_shown_size(view, (place, own));
            Some(DetectionLimit {
                effect: candidate.effect.clone(),
                form: candidate.form.file.name.clone(),
                parameter: name.clone(),
                size,
                usual,
                limited_by: self.limiting_cause(place, own, usual, size),
            })
        };
        parameters.filter_map(one).collect()
    }

    /// Cause that prevents an effect of a usual size from being shown; none where it is shown.
    fn limiting_cause(
        &self,
        place: usize,
        own: usize,
        usual: f64,
        size: Option<f64>,
    ) -> Option<LimitedBy> {
        let shows = |size: Option<f64>| size.is_some_and(|size| size <= usual);
        if shows(size) {
            return None;
        }
        // Causes are excluded in turn: without the discount, then with known coefficients.
        if shows(self.smallest_shown_size(&self.plain, (place, own))) {
            return Some(LimitedBy::Model);
        }
        let known = shows(self.smallest_shown_size(&self.of_known, (place, own)));
        let reads = form_target(self.candidates[place]) == ActsOn::Measurement;
        Some(if known || !reads { LimitedBy::Trials } else { LimitedBy::Sensors })
    }

    /// Smallest size of one parameter that is shown; none where no size is.
    fn smallest_shown_size(
        &self,
        view: &InformationView,
        (place, own): (usize, usize),
    ) -> Option<f64> {
        let rivals = self.competing_candidates(view, (place, own));
        let seen = self.unit_response(view, place, (place, own));
        SizeGrid::new(&self.candidates[place].form.parameters[own]).smallest_shown(|value| {
            self.is_shown((view, place), value, &seen, &rivals)
                && self.beats_alone((place, own), value)
        })
    }

    fn is_shown(
        &self,
        (view, place): (&InformationView, usize),
        value: f64,
        seen: &DVector<f64>,
        rivals: &[(&WeighedCandidate, DVector<f64>)],
    ) -> bool {
        let Some(own) = &view.weighed[place] else { return false };
        let expected = own.expected_evidence(&(seen * value));
        // Evidence that is exceeded with the probability of the quantile.
        let sure = expected.mean - THRESHOLDS.limits.quantile * expected.deviation;
        let is_behind = |(rival, seen): &(&WeighedCandidate, DVector<f64>)| {
            rival.expected_evidence(&(seen * value)).mean < sure
        };
        sure > self.least_evidence && rivals.iter().all(is_behind)
    }

    /// Returns true if the model alone is less probable at every level of the discrepancy.
    fn beats_alone(&self, (place, own): (usize, usize), value: f64) -> bool {
        let column = self.places[place][own];
        // The evidence of the model alone falls with the square of the effect's size.
        let alone = |level: &AloneLevel| {
            level.log_evidence - 0.5 * value.powi(2) * level.information[(column, column)]
        };
        let here = &self.alone[self.level];
        let seen = self.unit_response(&self.plain, place, (place, own)) * value;
        self.plain.weighed[place].as_ref().is_some_and(|weighed| {
            let expected = weighed.expected_evidence(&seen);
            let sure = expected.mean - THRESHOLDS.limits.quantile * expected.deviation;
            let with = alone(here) + sure;
            self.alone.iter().all(|level| with > alone(level) + self.least_evidence)
        })
    }

    /// Response of a candidate's columns to a unit of a parameter.
    fn unit_response(
        &self,
        view: &InformationView,
        by: usize,
        (place, own): (usize, usize),
    ) -> DVector<f64> {
        let column = self.places[place][own];
        let rows = self.places[by].iter().map(|&row| view.information[(row, column)]);
        DVector::from_iterator(self.places[by].len(), rows)
    }

    /// Other candidates that respond to a parameter, with their response to a unit of it.
    fn competing_candidates<'v>(
        &self,
        view: &'v InformationView,
        (place, own): (usize, usize),
    ) -> Vec<(&'v WeighedCandidate, DVector<f64>)> {
        let effect = &self.candidates[place].effect;
        let others =
            (0..self.candidates.len()).filter(|&other| self.candidates[other].effect != *effect);
        let one = |other: usize| {
            Some((view.weighed[other].as_ref()?, self.unit_response(view, other, (place, own))))
        };
        others.filter_map(one).collect()
    }
}

/// Removes the limits of effects that were found.
pub(super) fn excluding(limits: Vec<DetectionLimit>, found: &[String]) -> Vec<DetectionLimit> {
    limits.into_iter().filter(|limit| !found.contains(&limit.effect)).collect()
}

/// Names of the effects of which a usual size would not have been shown in any of their forms, with
/// the cause.
pub(super) fn undetectable_effects(limits: &[DetectionLimit]) -> BTreeMap<String, LimitedBy> {
    let mut open = BTreeMap::new();
    for limit in limits {
        // An effect is reported only if none of its forms would be shown.
        let of_effect = || limits.iter().filter(|other| other.effect == limit.effect);
        if let Some(cause) =
            limit.limited_by.filter(|_| of_effect().all(|l| l.limited_by.is_some()))
        {
            open.entry(limit.effect.clone()).or_insert(cause);
        }
    }
    open
}
