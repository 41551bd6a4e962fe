//! Patterns of the remainder: accelerations that go with the heading, the time of a trial, the
//! speed, the rudder or the revolutions, or that oscillate, and that are too small for any one
//! segment to stand out.
//!
//! Each is a test of its own: columns of one acceleration, with coefficients, effects and the
//! errors of their forms integrated out, and the information divided by the level of the same test
//! on the clean trials of the model. Under the model a Bayes factor exceeds `B` with a probability
//! of at most `1/B` (Markov's inequality, as its expectation is one), so that among `M` tests that
//! each have to exceed `M B` the probability of any false alarm is at most `1/B`.

use std::collections::BTreeMap;

use rayon::prelude::*;
use sistership_model::trial::Channel;
use sistership_model::uncertainty::FalseAlarmLevel;

use super::coefficient_prior::CoefficientPrior;
use super::discount::PATTERN_KEYS;
use super::evidence::{MarginalInformation, NormalPrior, not_positive_error};
use super::form_errors::form_error_columns;
use super::linearised_trials::LinearisedTrials;
use super::thresholds::THRESHOLDS;
use sistership_filtering::{
    AxisColumn, AxisDiscrepancies, EffectCandidate, FilterGains, GramMatrix, LinearisedPart,
    TrialReadings,
};
use sistership_identification::refine::RefineError;

/// Kind of a pattern.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum PatternKind {
    Heading,
    Time,
    Speed,
    Rudder,
    Revolutions,
    /// A period, by `L/U`; each trial has its own amplitude and phase.
    Period(f64),
}

impl PatternKind {
    /// All kinds, with the periods that are evaluated.
    fn all() -> impl Iterator<Item = Self> {
        let fixed = [Self::Heading, Self::Time, Self::Speed, Self::Rudder, Self::Revolutions];
        fixed.into_iter().chain(THRESHOLDS.patterns.periods.map(Self::Period))
    }

    pub fn name(self) -> &'static str {
        match self {
            Self::Heading => "psi",
            Self::Time => "t",
            Self::Speed => "u",
            Self::Rudder => "delta",
            Self::Revolutions => "n",
            Self::Period(_) => "period",
        }
    }
}

/// A test of one acceleration.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pattern {
    pub kind: PatternKind,
    pub axis: usize,
    /// First of its columns among those of all patterns.
    first: usize,
    count: usize,
}

impl Pattern {
    /// Key of its level on clean trials; one for all periods.
    fn level_key(self, workspace: &LinearisedTrials<'_>) -> String {
        let axis = workspace.axes()[self.axis].velocity_name();
        format!("{PATTERN_KEYS}{}/{axis}", self.kind.name())
    }

    fn columns(self) -> Vec<usize> {
        (self.first..self.first + self.count).collect()
    }
}

/// Information of trials on all patterns.
pub(super) struct PatternInformation {
    pub patterns: Vec<Pattern>,
    total: MarginalInformation,
    /// Each trial alone.
    each: Vec<MarginalInformation>,
}

/// Values of a kind of pattern along a part, for each interval.
fn pattern_values(
    kind: PatternKind,
    workspace: &LinearisedTrials<'_>,
    record: &TrialReadings<'_>,
    part: &LinearisedPart,
) -> Vec<Vec<f64>> {
    let channel = |channel: Channel| record.trial.channel(channel);
    let middle = |values: &dyn Fn(usize) -> f64| {
        let ends = part.samples.windows(2);
        ends.map(|ends| 0.5 * (values(ends[0]) + values(ends[1]))).collect::<Vec<f64>>()
    };
    let powers = |values: Option<&[f64]>, of: &dyn Fn(f64) -> [f64; 2]| {
        let one = |place: usize| middle(&|k| values.map_or(0.0, |values| of(values[k])[place]));
        vec![one(0), one(1)]
    };
    // Each variable has a term of first and one of higher order, so that a dependence that is not
    // proportional is found too, and both are of the order of one in a usual manoeuvre.
    let (first_s, duration_s) = (record.trial.t_s[0], record.trial.duration_s().max(1e-9));
    match kind {
        PatternKind::Heading => (1..=THRESHOLDS.patterns.harmonics)
            .flat_map(|harmonic| {
                powers(channel(Channel::Psi), &|psi| {
                    let (sine, cosine) = (f64::from(harmonic) * psi).sin_cos();
                    [cosine, sine]
                })
            })
            .collect(),
        PatternKind::Time => powers(Some(&record.trial.t_s), &|t_s| {
            // A step at half time and a drift: damage and fouling or heating.
            let share = 2.0 * (t_s - first_s) / duration_s - 1.0;
            [share.signum(), share]
        }),
        PatternKind::Speed => powers(channel(Channel::U), &|u| {
            let slower = (1.0 - u / workspace.speed_m_s) / THRESHOLDS.patterns.speed;
            [slower, slower * slower]
        }),
        PatternKind::Rudder => powers(channel(Channel::Delta), &|delta| {
            // What is proportional to the rudder is a coefficient of every law already.
            let share = delta / THRESHOLDS.patterns.rudder_rad;
            [share * share.abs(), share.powi(3)]
        }),
        PatternKind::Revolutions => powers(channel(Channel::N), &|n| {
            let share = n.abs() / workspace.highest_revolutions().max(1e-9);
            [share, share * share]
        }),
        PatternKind::Period(period) => {
            let pace = std::f64::consts::TAU * workspace.speed_m_s / (period * workspace.lpp_m);
            powers(Some(&record.trial.t_s), &|t_s| {
                let (sine, cosine) = (pace * (t_s - first_s)).sin_cos();
                [cosine, sine]
            })
        }
    }
}

/// Columns of all patterns along a part, with a standard deviation of one.
fn pattern_columns(
    workspace: &LinearisedTrials<'_>,
    record: &TrialReadings<'_>,
    part: &LinearisedPart,
) -> (Vec<Pattern>, Vec<AxisColumn>) {
    let typical = workspace.motion_scales().accelerations;
    let (mut patterns, mut columns) = (Vec::new(), Vec::new());
    for kind in PatternKind::all() {
        let values = pattern_values(kind, workspace, record, part);
        for (axis, typical) in typical.iter().enumerate() {
            patterns.push(Pattern { kind, axis, first: columns.len(), count: values.len() });
            let size = THRESHOLDS.patterns.size * typical;
            let scaled = |values: &Vec<f64>| AxisColumn {
                axis,
                values: values.iter().map(|value| size * value).collect(),
            };
            columns.extend(values.iter().map(scaled));
        }
    }
    (patterns, columns)
}

impl PatternInformation {
    /// Information of all trials. `present` are the effects, whose columns follow those of the
    /// coefficients; `each` is the prior of both for each trial by itself, `all` that for all
    /// together; without it the trials are added as they are by themselves.
    ///
    /// # Errors
    /// Returns an error if the noise of a channel is unknown, or the information is not positive.
    pub fn new(
        workspace: &LinearisedTrials<'_>,
        discrepancies: &AxisDiscrepancies,
        present: &[EffectCandidate],
        (each, all): (&[CoefficientPrior], Option<&CoefficientPrior>),
    ) -> Result<Self, RefineError> {
        let of_trial = |trial: usize| trial_gram(workspace, trial, discrepancies, present);
        let grams: Vec<(Vec<Pattern>, GramMatrix)> = (0..workspace.trials.len())
            .into_par_iter()
            .map(of_trial)
            .collect::<Result<_, RefineError>>()?;
        let patterns = grams.first().map(|(patterns, _)| patterns.clone()).unwrap_or_default();
        let width = grams.first().map_or(0, |(_, gram)| gram.products.nrows());
        let total = GramMatrix::sum_parts(grams.iter().map(|(_, gram)| gram), width);
        let alone = |((_, gram), known): (&(Vec<Pattern>, GramMatrix), &CoefficientPrior)| {
            MarginalInformation::new(gram, known)
        };
        let each: Vec<MarginalInformation> =
            grams.iter().zip(each).map(alone).collect::<Result<_, _>>()?;
        let sum = || each.iter().cloned().reduce(MarginalInformation::add_information);
        let total = match all {
            Some(all) => MarginalInformation::new(&total, all)?,
            None => sum().ok_or_else(not_positive_error)?,
        };
        Ok(Self { patterns, total, each })
    }

    /// Evidence for a pattern, with its information divided by `discount`.
    pub fn evidence(&self, pattern: Pattern, discount: f64) -> f64 {
        let priors = vec![NormalPrior { mean: 0.0, deviation: 1.0 }; pattern.count];
        let gain = |says: &MarginalInformation| {
            let says = says.select_columns(&pattern.columns()).divide_by(discount);
            let places: Vec<usize> = (0..pattern.count).collect();
            says.estimate_parameters(&places, &priors).map_or(0.0, |estimate| estimate.gain)
        };
        match pattern.kind {
            // The phase of an oscillation is another one in each trial.
            PatternKind::Period(_) => self.each.iter().map(gain).sum(),
            _ => gain(&self.total),
        }
    }

    /// Improvement of the fit by each pattern relative to that by chance, by the key of its level;
    /// of periods the largest.
    pub fn clean_levels(
        &self,
        workspace: &LinearisedTrials<'_>,
    ) -> BTreeMap<String, FalseAlarmLevel> {
        let rounding = THRESHOLDS.calibration.rounding;
        let mut levels: BTreeMap<String, FalseAlarmLevel> = BTreeMap::new();
        for pattern in &self.patterns {
            let priors = vec![NormalPrior { mean: 0.0, deviation: 1.0 }; pattern.count];
            let ratio = |all: &[&MarginalInformation]| {
                let parts = all
                    .iter()
                    .filter_map(|one| one.explained_and_chance(&pattern.columns(), &priors));
                let sum = parts.fold((0.0, 0.0), |sum, one| (sum.0 + one.0, sum.1 + one.1));
                let is_known = sum.1 > THRESHOLDS.calibration.least_chance;
                let ratio = if is_known { sum.0 / sum.1 } else { 1.0 };
                (rounding * ratio).round() / rounding
            };
            let each = ratio(&self.each.iter().collect::<Vec<_>>());
            let level = FalseAlarmLevel { each, together: ratio(&[&self.total]) };
            let known = levels.entry(pattern.level_key(workspace)).or_insert(level);
            known.each = known.each.max(level.each);
            known.together = known.together.max(level.together);
        }
        levels
    }

    /// Patterns with their evidence beyond the number of tests, the most evident first; those of
    /// which clean trials gave no level are not tested.
    pub fn evident_patterns(
        &self,
        workspace: &LinearisedTrials<'_>,
        discount: &dyn Fn(&str) -> Option<f64>,
        least_evidence: f64,
    ) -> Vec<(Pattern, f64)> {
        // Each test has to exceed the number of tests by the stated factor: see the module.
        let tests = (self.patterns.len() as f64).ln();
        let weigh = |pattern: &Pattern| {
            let discount = discount(&pattern.level_key(workspace))?;
            Some((*pattern, self.evidence(*pattern, discount) - tests))
        };
        let mut found: Vec<(Pattern, f64)> = self.patterns.iter().filter_map(weigh).collect();
        found.retain(|(_, evidence)| *evidence > least_evidence);
        found.sort_by(|a, b| b.1.total_cmp(&a.1));
        found
    }
}

/// Products of a trial: coefficients and effects, then patterns; the errors of forms are integrated
/// out.
fn trial_gram(
    workspace: &LinearisedTrials<'_>,
    trial: usize,
    discrepancies: &AxisDiscrepancies,
    present: &[EffectCandidate],
) -> Result<(Vec<Pattern>, GramMatrix), RefineError> {
    let (record, first) = (&workspace.records()[trial], workspace.columns().nuisance.len());
    let kept: Vec<usize> =
        (0..first + present.iter().map(|one| one.at.len()).sum::<usize>()).collect();
    let (mut patterns, mut gram, mut errors) = (Vec::new(), None::<GramMatrix>, 0);
    for part in workspace.parts_of_trial(trial)?.iter() {
        let forms = form_error_columns(workspace, record, part, (first, present));
        let (own, columns) = pattern_columns(workspace, record, part);
        (patterns, errors) = (own, forms.len());
        let part = part.weight_columns(&kept, &[], &|_| Vec::new());
        let part = part.append_axis_columns(&columns).append_axis_columns(&forms);
        let gains = FilterGains::new(&part, &workspace.noise, discrepancies)?;
        let own = gains.whitened_products(&part);
        match &mut gram {
            Some(sum) => sum.add(&own),
            None => gram = Some(own),
        }
    }
    let gram = gram.ok_or_else(not_positive_error)?;
    Ok((patterns, gram.integrate_last(errors).ok_or_else(not_positive_error)?))
}
