//! Residual over time, for plots: before and after, against the variable that explains most of it.

use sistership_model::Trial;
use sistership_model::trial::Channel;

use super::hypothesis::JudgedHypothesis;
use super::linearised_trials::LinearisedTrials;
use super::outcome::{DiscrepancyLevel, ResidualSeries};
use super::search::HypothesisSearch;
use super::thresholds::THRESHOLDS;
use sistership_filtering::{FilterColumns, SmoothedDiscrepancies, smooth_discrepancies};
use sistership_identification::refine::RefineError;

/// Returns the residuals of every trial: of the given model, and with the effects found.
///
/// # Errors
/// Returns an error that names what a trial lacks.
pub(super) fn residual_series(
    search: &HypothesisSearch<'_>,
    settled: &HypothesisSearch<'_>,
    best: &JudgedHypothesis,
) -> Result<Vec<ResidualSeries>, RefineError> {
    let before = LinearisedTrials::new(
        &search.calibrated_model,
        FilterColumns::default(),
        search.trials,
        search.least_step_s,
    )?;
    let columns = FilterColumns { nuisance: Vec::new(), candidates: best.candidates.clone() };
    let after = LinearisedTrials::new(
        &settled.calibrated_model,
        columns,
        search.trials,
        search.least_step_s,
    )?;
    // The largest level constrains the smoothed discrepancy least.
    let level = search.levels[search.levels.len() - 1];
    let of = |workspace: &LinearisedTrials<'_>,
              trial: usize|
     -> Result<Vec<SmoothedDiscrepancies>, RefineError> {
        let parts = workspace.linearised_parts()[trial].iter();
        parts
            .map(|part| {
                smooth_discrepancies(part, &workspace.noise, &search.level_discrepancies(level))
            })
            .collect()
    };
    let mut all = Vec::new();
    for (place, trial) in search.trials.iter().enumerate() {
        let samples: Vec<usize> =
            before.linearised_parts()[place].iter().flat_map(|part| part.samples.clone()).collect();
        let (before_it, after_it) = (of(&before, place)?, of(&after, place)?);
        for axis in 0..before.axes().len() {
            all.push(trial_series(
                trial,
                before.axes()[axis].velocity_name(),
                &samples,
                axis,
                [&before_it, &after_it],
            ));
        }
    }
    set_best_variables(search.trials, &mut all);
    Ok(all)
}

fn trial_series(
    trial: &Trial,
    channel: &str,
    samples: &[usize],
    axis: usize,
    [before, after]: [&[SmoothedDiscrepancies]; 2],
) -> ResidualSeries {
    let stride = samples.len().div_ceil(THRESHOLDS.series.points).max(1);
    let thin = |values: Vec<f64>| values.into_iter().step_by(stride).collect::<Vec<f64>>();
    let joined = |parts: &[SmoothedDiscrepancies]| {
        thin(parts.iter().flat_map(|part| part.values[axis].clone()).collect())
    };
    let band = before
        .iter()
        .flat_map(|part| part.deviations[axis].iter().map(|sd| THRESHOLDS.series.band * sd))
        .collect();
    ResidualSeries {
        trial: trial.name.clone(),
        channel: channel.to_owned(),
        t_s: thin(samples.iter().map(|&k| trial.t_s[k]).collect()),
        before: joined(before),
        after: joined(after),
        band: thin(band),
        against: String::new(),
        variable: Vec::new(),
    }
}

/// Sets each channel's series against the variable that explains most of it over all trials.
fn set_best_variables(trials: &[&Trial], all: &mut [ResidualSeries]) {
    // Equal neighbours are removed first, so that fewer names are sorted.
    let mut channels: Vec<String> = all.iter().map(|series| series.channel.clone()).collect();
    channels.dedup();
    channels.sort_unstable();
    channels.dedup();
    for channel in channels {
        let of: Vec<&ResidualSeries> =
            all.iter().filter(|series| series.channel == channel).collect();
        let share = |variable: &Channel| {
            let pairs: Option<Vec<Vec<(f64, f64)>>> =
                of.iter().map(|series| variable_pairs(trials, series, *variable)).collect();
            explained_share(pairs?.into_iter().flatten().collect())
        };
        let shares = THRESHOLDS
            .series
            .variables
            .iter()
            .filter_map(|variable| Some((share(variable)?, *variable)));
        let Some((_, best)) = shares.max_by(|a, b| a.0.total_cmp(&b.0)) else { continue };
        for series in all.iter_mut().filter(|series| series.channel == channel) {
            let pairs = variable_pairs(trials, series, best).unwrap_or_default();
            (series.against, series.variable) =
                (best.name().to_owned(), pairs.into_iter().map(|(variable, _)| variable).collect());
        }
    }
}

/// A variable and the residual at the times of a series.
fn variable_pairs(
    trials: &[&Trial],
    series: &ResidualSeries,
    variable: Channel,
) -> Option<Vec<(f64, f64)>> {
    let values = recorded_values(trials, series, variable)?;
    Some(values.into_iter().zip(series.before.iter().copied()).collect())
}

/// A variable at the times of a series; a heading within one turn.
pub(super) fn recorded_values(
    trials: &[&Trial],
    series: &ResidualSeries,
    variable: Channel,
) -> Option<Vec<f64>> {
    let trial = trials.iter().find(|trial| trial.name == series.trial)?;
    let values = trial.channel(variable)?;
    let at = |t_s: &f64| values[trial.t_s.partition_point(|t| t < t_s).min(values.len() - 1)];
    let turned = |value: f64| {
        if variable == Channel::Psi { value.rem_euclid(std::f64::consts::TAU) } else { value }
    };
    Some(series.t_s.iter().map(|t| turned(at(t))).collect())
}

/// Share of the variance of the second value that lies between classes of the first.
fn explained_share(mut pairs: Vec<(f64, f64)>) -> Option<f64> {
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (first, last) = (pairs.first()?.0, pairs.last()?.0);
    if last - first < 1e-9 {
        return None;
    }
    let mean =
        |part: &[(f64, f64)]| part.iter().map(|pair| pair.1).sum::<f64>() / part.len() as f64;
    let all = mean(&pairs);
    let total: f64 = pairs.iter().map(|pair| (pair.1 - all).powi(2)).sum();
    // Classes of equal count, as the pairs are sorted by the variable.
    let classes = pairs.chunks(pairs.len().div_ceil(THRESHOLDS.series.classes));
    let between: f64 = classes.map(|class| class.len() as f64 * (mean(class) - all).powi(2)).sum();
    (total > 0.0).then(|| between / total)
}

/// Level of the unexplained part of each acceleration, before and after.
pub(super) fn discrepancy_levels(
    search: &HypothesisSearch<'_>,
    workspace: &LinearisedTrials<'_>,
    before: &JudgedHypothesis,
    after: &JudgedHypothesis,
) -> Vec<DiscrepancyLevel> {
    let at = |judged: &JudgedHypothesis| {
        search.level_discrepancies(search.levels[judged.level.min(search.levels.len() - 1)])
    };
    let (before, after) = (at(before), at(after));
    let is_known = search.model.uncertainty.is_some();
    let one = |(place, axis): (usize, &sistership_model::coefficient::Axis)| DiscrepancyLevel {
        channel: axis.velocity_name().to_owned(),
        expected: is_known.then(|| search.expected[place].deviation),
        before: before[place].deviation,
        after: after[place].deviation,
    };
    workspace.axes().iter().enumerate().map(one).collect()
}
