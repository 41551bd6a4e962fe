//! Unexplained remainder of a hypothesis: segments of a trial in which the prediction errors are
//! larger or steadier than noise.

use std::collections::BTreeMap;

use nalgebra::{Cholesky, DMatrix, DVector};
use rayon::prelude::*;
use sistership_model::trial::Channel;

use super::evidence::not_positive_error;
use super::form_errors::form_error_columns;
use super::linearised_trials::LinearisedTrials;
use super::outcome::UnexplainedSegment;
use super::thresholds::THRESHOLDS;
use sistership_filtering::{
    AxisDiscrepancies, EffectCandidate, LinearisedPart, column_responses, whiten_part,
};
use sistership_identification::refine::RefineError;

/// Model of the readings, of which the remainder is asked.
#[derive(Clone, Copy)]
pub(super) struct FittedColumns<'a> {
    /// Value of each column.
    pub parameters: &'a [f64],
    /// Errors of these due to the laws of the effects.
    pub effects: &'a [f64],
    /// Effects that are present, whose forms may differ from the true ones. Their columns follow
    /// those of the coefficients.
    pub present: &'a [EffectCandidate],
}

/// Returns segments that the columns at their parameters leave unexplained, under the expected
/// discrepancy; the largest first.
///
/// # Errors
/// Returns an error if the noise of a channel is unknown.
pub(super) fn find_unexplained(
    workspace: &LinearisedTrials<'_>,
    discrepancies: &AxisDiscrepancies,
    fitted: FittedColumns<'_>,
    clean: Option<&BTreeMap<String, f64>>,
) -> Result<Vec<UnexplainedSegment>, RefineError> {
    let of_trial = |place: usize| {
        let parts = &workspace.linearised_parts()[place];
        unexplained_in_trial((workspace, place), parts, discrepancies, fitted, clean)
    };
    let each: Vec<Vec<UnexplainedSegment>> =
        (0..workspace.trials.len()).into_par_iter().map(of_trial).collect::<Result<_, _>>()?;
    let mut found: Vec<UnexplainedSegment> = each.into_iter().flatten().collect();
    found.sort_by(|a, b| b.rms_over_noise.total_cmp(&a.rms_over_noise));
    Ok(found)
}

/// Returns the unexplained segments of the parts of one trial.
///
/// # Errors
/// Returns an error if the noise of a channel is unknown.
pub(super) fn unexplained_in_trial(
    (workspace, place): (&LinearisedTrials<'_>, usize),
    parts: &[LinearisedPart],
    discrepancies: &AxisDiscrepancies,
    fitted: FittedColumns<'_>,
    clean: Option<&BTreeMap<String, f64>>,
) -> Result<Vec<UnexplainedSegment>, RefineError> {
    let limit = |channel: Channel| {
        let seen = clean.and_then(|clean| clean.get(channel.name())).copied().unwrap_or_default();
        THRESHOLDS.remainder.limit.max(THRESHOLDS.remainder.margin * seen)
    };
    let trial = &workspace.trials[place].name;
    let sums = channel_sums((workspace, place), parts, discrepancies, fitted)?;
    let of = |(channel, sums): (Channel, BlockSums<'_>)| {
        sums.unexplained_segments(trial, channel, limit(channel))
    };
    Ok(sums.into_iter().flat_map(of).collect())
}

/// Returns a whole trial as the segment of a channel; none where the channel was not recorded.
///
/// # Errors
/// Returns an error if the noise of a channel is unknown.
pub(super) fn trial_remainder(
    (workspace, place): (&LinearisedTrials<'_>, usize),
    discrepancies: &AxisDiscrepancies,
    fitted: FittedColumns<'_>,
    channel: &str,
) -> Result<Option<UnexplainedSegment>, RefineError> {
    let parts = &workspace.linearised_parts()[place];
    let sums = channel_sums((workspace, place), parts, discrepancies, fitted)?;
    let own = sums.iter().filter(|(known, _)| known.name() == channel);
    let all: Vec<f64> = own.flat_map(|(_, sums)| sums.sums.iter().copied()).collect();
    let times = || parts.iter().flat_map(|part| part.t_s.iter().copied());
    let ends = times().next().zip(times().next_back()).filter(|_| !all.is_empty());
    Ok(ends.map(|(from_s, to_s)| UnexplainedSegment {
        channel: channel.to_owned(),
        rms_over_noise: root_mean_square(&all),
        trial: workspace.trials[place].name.clone(),
        from_s,
        to_s,
    }))
}

/// Returns the largest remainder of any segment of a trial, by channel.
///
/// # Errors
/// Returns an error if the noise of a channel is unknown.
pub(super) fn largest_per_channel(
    (workspace, place): (&LinearisedTrials<'_>, usize),
    parts: &[LinearisedPart],
    discrepancies: &AxisDiscrepancies,
    parameters: &[f64],
) -> Result<Vec<(Channel, f64)>, RefineError> {
    let of = |(channel, sums): (Channel, BlockSums<'_>)| (channel, sums.largest_rms());
    let fitted = FittedColumns { parameters, effects: &[], present: &[] };
    let sums = channel_sums((workspace, place), parts, discrepancies, fitted)?;
    Ok(sums.into_iter().map(of).collect())
}

/// Sums of the prediction errors of a channel over blocks of a part of a trial, in standard
/// deviations.
struct BlockSums<'a> {
    part: &'a LinearisedPart,
    /// Number of readings in a block.
    size: usize,
    sums: Vec<f64>,
    /// Sums due to the errors of the laws of the effects found. Empty where there are none.
    moved: Vec<f64>,
}

fn channel_sums<'a>(
    (workspace, place): (&LinearisedTrials<'_>, usize),
    parts: &'a [LinearisedPart],
    discrepancies: &AxisDiscrepancies,
    fitted: FittedColumns<'_>,
) -> Result<Vec<(Channel, BlockSums<'a>)>, RefineError> {
    let block_s = THRESHOLDS.remainder.block * workspace.lpp_m / workspace.speed_m_s;
    let mut all = Vec::new();
    let left = remaining_errors((workspace, place), parts, discrepancies, fitted)?;
    for (part, left) in parts.iter().zip(left) {
        let interval = (part.t_s[part.t_s.len() - 1] - part.t_s[0]) / (part.t_s.len() - 1) as f64;
        // The filter reads one of `every` samples: the size of a block is in readings.
        let size = (block_s / (interval * part.every as f64)).round().max(1.0) as usize;
        let moved = match fitted.effects.iter().any(|error| *error != 0.0) {
            true => column_responses(
                &part.combine_columns(fitted.effects),
                &workspace.noise,
                discrepancies,
            )?,
            false => Vec::new(),
        };
        for (place, &(channel, _)) in part
            .channels
            .iter()
            .enumerate()
            .filter(|(_, (channel, _))| THRESHOLDS.remainder.channels.contains(channel))
        {
            // Errors are in the order of readings, and by channel within each.
            let of = |all: &[f64]| {
                block_sums(all.iter().skip(place).step_by(part.channels.len()).copied(), size)
            };
            all.push((channel, BlockSums { part, size, sums: of(&left), moved: of(&moved) }));
        }
    }
    Ok(all)
}

/// Prediction errors of each part that the columns leave, less what the errors of the forms
/// explain, which are those of one trial.
fn remaining_errors(
    (workspace, place): (&LinearisedTrials<'_>, usize),
    parts: &[LinearisedPart],
    discrepancies: &AxisDiscrepancies,
    fitted: FittedColumns<'_>,
) -> Result<Vec<Vec<f64>>, RefineError> {
    let (record, first) = (&workspace.records()[place], workspace.columns().nuisance.len());
    let whitened = |part: &LinearisedPart| {
        let errors = form_error_columns(workspace, record, part, (first, fitted.present));
        let combined = part.combine_columns(fitted.parameters).append_axis_columns(&errors);
        let (rows, _) = whiten_part(&combined, &workspace.noise, discrepancies)?;
        let width = 2 + errors.len();
        let rows = DMatrix::from_vec(width, rows.len() / width, rows);
        let left = (rows.row(0) - rows.row(1)).transpose();
        Ok((left, rows.rows(2, errors.len()).into_owned()))
    };
    let each: Vec<(DVector<f64>, DMatrix<f64>)> =
        parts.iter().map(whitened).collect::<Result<_, RefineError>>()?;
    let size = each.first().map_or(0, |(_, errors)| errors.nrows());
    if size == 0 {
        return Ok(each.into_iter().map(|(left, _)| left.as_slice().to_vec()).collect());
    }
    // Their sizes under standard normal priors: (E E' + I)^-1 E r.
    let (mut information, mut right) = (DMatrix::identity(size, size), DVector::zeros(size));
    for (left, errors) in &each {
        information += errors * errors.transpose();
        right += errors * left;
    }
    let sizes = Cholesky::new(information).ok_or_else(not_positive_error)?.solve(&right);
    let rest = |(left, errors): (DVector<f64>, DMatrix<f64>)| left - errors.tr_mul(&sizes);
    Ok(each.into_iter().map(|one| rest(one).as_slice().to_vec()).collect())
}

fn block_sums(values: impl Iterator<Item = f64>, size: usize) -> Vec<f64> {
    let values: Vec<f64> = values.collect();
    // Divided by the root of the count: the sum of a block of white errors has variance one.
    values
        .chunks(size)
        .map(|block| block.iter().sum::<f64>() / (block.len() as f64).sqrt())
        .collect()
}

fn root_mean_square(sums: &[f64]) -> f64 {
    (sums.iter().map(|s| s * s).sum::<f64>() / sums.len() as f64).sqrt()
}

impl BlockSums<'_> {
    fn window_starts(&self) -> std::ops::Range<usize> {
        0..self.sums.len().saturating_sub(THRESHOLDS.remainder.blocks - 1)
    }

    fn largest_rms(&self) -> f64 {
        self.window_starts()
            .map(|from| root_mean_square(&self.sums[from..from + THRESHOLDS.remainder.blocks]))
            .fold(0.0, f64::max)
    }

    /// Runs of blocks above the limit, each as one segment.
    fn unexplained_segments(
        &self,
        trial: &str,
        channel: Channel,
        limit: f64,
    ) -> Vec<UnexplainedSegment> {
        let mut found: Vec<(usize, usize)> = Vec::new();
        let is_large = |&from: &usize| {
            let blocks = from..from + THRESHOLDS.remainder.blocks;
            // The allowance for the laws' errors is added to the limit in squares.
            let moved = self.moved.get(blocks.clone()).map_or(0.0, root_mean_square);
            root_mean_square(&self.sums[blocks]) > limit.hypot(moved)
        };
        for from in self.window_starts().filter(is_large) {
            // Overlapping windows above the limit form one run.
            match found.last_mut().filter(|(_, end)| from <= *end) {
                Some((_, end)) => *end = from + THRESHOLDS.remainder.blocks,
                None => found.push((from, from + THRESHOLDS.remainder.blocks)),
            }
        }
        let time = |block: usize| {
            self.part.t_s[(block * self.size * self.part.every).min(self.part.t_s.len() - 1)]
        };
        let stretch = |(from, to): (usize, usize)| UnexplainedSegment {
            channel: channel.name().to_owned(),
            rms_over_noise: root_mean_square(&self.sums[from..to]),
            trial: trial.to_owned(),
            from_s: time(from),
            to_s: time(to),
        };
        found.into_iter().map(|run| stretch(self.trim_run(run, limit))).collect()
    }

    /// Trims blocks at the ends of a run that are included only because of large neighbours.
    fn trim_run(&self, (mut from, mut to): (usize, usize), limit: f64) -> (usize, usize) {
        let is_small = |block: usize| self.sums[block].abs() < limit;
        while to - from > THRESHOLDS.remainder.blocks && is_small(from) {
            from += 1;
        }
        while to - from > THRESHOLDS.remainder.blocks && is_small(to - 1) {
            to -= 1;
        }
        (from, to)
    }
}
