//! Unexplained remainder of a hypothesis: segments of a trial in which the prediction errors are
//! larger or steadier than noise.

use std::collections::BTreeMap;

use sistership_model::trial::{Channel, Trial};

use super::linearised_trials::LinearisedTrials;
use super::outcome::UnexplainedSegment;
use super::thresholds::THRESHOLDS;
use sistership_filtering::{
    AxisDiscrepancies, LinearisedPart, column_responses, prediction_errors,
};
use sistership_identification::refine::RefineError;

/// Returns segments that the columns at `parameters` leave unexplained, under the expected
/// discrepancy; the largest first. `effects` are the errors of the parameters due to the laws of
/// the effects.
///
/// # Errors
/// Returns an error if the noise of a channel is unknown.
pub(super) fn find_unexplained(
    workspace: &LinearisedTrials<'_>,
    discrepancies: &AxisDiscrepancies,
    parameters: &[f64],
    effects: &[f64],
    clean: Option<&BTreeMap<String, f64>>,
) -> Result<Vec<UnexplainedSegment>, RefineError> {
    let of_trial = |(place, trial): (usize, &&Trial)| {
        let parts: Vec<&LinearisedPart> = workspace.linearised_parts()[place].iter().collect();
        let errors: Vec<PartErrors> = parts
            .iter()
            .map(|part| {
                PartErrors::new(workspace, part, discrepancies, (parameters, Some(effects)))
            })
            .collect::<Result<_, _>>()?;
        Ok(unexplained_by_errors((workspace, &trial.name), &parts, &errors, clean))
    };
    let each: Vec<Vec<UnexplainedSegment>> =
        workspace.trials.iter().enumerate().map(of_trial).collect::<Result<_, RefineError>>()?;
    let mut found: Vec<UnexplainedSegment> = each.into_iter().flatten().collect();
    found.sort_by(|a, b| b.rms_over_noise.total_cmp(&a.rms_over_noise));
    Ok(found)
}

/// Prediction errors of a part: what is left, and the part of it that the errors of the laws of
/// effects may cause, which is empty where it is not needed.
pub(super) struct PartErrors {
    pub left: Vec<f64>,
    pub moved: Vec<f64>,
}

impl PartErrors {
    fn new(
        workspace: &LinearisedTrials<'_>,
        part: &LinearisedPart,
        discrepancies: &AxisDiscrepancies,
        (parameters, effects): (&[f64], Option<&[f64]>),
    ) -> Result<Self, RefineError> {
        let (left, _) =
            prediction_errors(&part.combine_columns(parameters), &workspace.noise, discrepancies)?;
        let moved = match effects {
            Some(effects) => {
                column_responses(&part.combine_columns(effects), &workspace.noise, discrepancies)?
            }
            None => Vec::new(),
        };
        Ok(Self { left, moved })
    }
}

/// Returns the unexplained segments of the parts of one trial, by their prediction errors.
pub(super) fn unexplained_by_errors(
    (workspace, trial): (&LinearisedTrials<'_>, &str),
    parts: &[&LinearisedPart],
    errors: &[PartErrors],
    clean: Option<&BTreeMap<String, f64>>,
) -> Vec<UnexplainedSegment> {
    let limit = |channel: Channel| {
        let seen = clean.and_then(|clean| clean.get(channel.name())).copied().unwrap_or_default();
        THRESHOLDS.remainder.limit.max(THRESHOLDS.remainder.margin * seen)
    };
    let of = |(channel, sums): (Channel, BlockSums<'_>)| {
        sums.unexplained_segments(trial, channel, limit(channel))
    };
    let all = parts.iter().zip(errors);
    all.flat_map(|(part, errors)| part_sums(workspace, part, errors)).flat_map(of).collect()
}

/// Returns a whole trial as the segment of a channel; none where the channel was not recorded.
///
/// # Errors
/// Returns an error if the noise of a channel is unknown.
pub(super) fn trial_remainder(
    (workspace, place): (&LinearisedTrials<'_>, usize),
    discrepancies: &AxisDiscrepancies,
    parameters: &[f64],
    channel: &str,
) -> Result<Option<UnexplainedSegment>, RefineError> {
    let parts = &workspace.linearised_parts()[place];
    let sums = channel_sums(workspace, parts, discrepancies, (parameters, None))?;
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
    workspace: &LinearisedTrials<'_>,
    parts: &[LinearisedPart],
    discrepancies: &AxisDiscrepancies,
    parameters: &[f64],
) -> Result<Vec<(Channel, f64)>, RefineError> {
    let of = |(channel, sums): (Channel, BlockSums<'_>)| (channel, sums.largest_rms());
    let sums = channel_sums(workspace, parts, discrepancies, (parameters, None))?;
    Ok(sums.into_iter().map(of).collect())
}

/// Sums of the prediction errors of a channel over blocks of a part of a trial, in standard
/// deviations.
struct BlockSums<'a> {
    part: &'a LinearisedPart,
    /// Number of readings in a block.
    size: usize,
    sums: Vec<f64>,
    /// Sums due to the errors of the laws of the effects found. Empty where they are not needed.
    moved: Vec<f64>,
}

fn channel_sums<'a>(
    workspace: &LinearisedTrials<'_>,
    parts: &'a [LinearisedPart],
    discrepancies: &AxisDiscrepancies,
    (parameters, effects): (&[f64], Option<&[f64]>),
) -> Result<Vec<(Channel, BlockSums<'a>)>, RefineError> {
    let mut all = Vec::new();
    for part in parts {
        let errors = PartErrors::new(workspace, part, discrepancies, (parameters, effects))?;
        all.extend(part_sums(workspace, part, &errors));
    }
    Ok(all)
}

fn part_sums<'a>(
    workspace: &LinearisedTrials<'_>,
    part: &'a LinearisedPart,
    errors: &PartErrors,
) -> Vec<(Channel, BlockSums<'a>)> {
    let block_s = THRESHOLDS.remainder.block * workspace.lpp_m / workspace.speed_m_s;
    let interval = (part.t_s[part.t_s.len() - 1] - part.t_s[0]) / (part.t_s.len() - 1) as f64;
    // The filter reads one of `every` samples: the size of a block is in readings.
    let size = (block_s / (interval * part.every as f64)).round().max(1.0) as usize;
    let judged = part.channels.iter().enumerate();
    judged
        .filter(|(_, (channel, _))| THRESHOLDS.remainder.channels.contains(channel))
        .map(|(place, &(channel, _))| {
            // Errors are in the order of readings, and by channel within each.
            let of = |all: &[f64]| {
                block_sums(all.iter().skip(place).step_by(part.channels.len()).copied(), size)
            };
            (channel, BlockSums { part, size, sums: of(&errors.left), moved: of(&errors.moved) })
        })
        .collect()
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
            root_mean_square(&self.sums[blocks.clone()])
                > limit.hypot(root_mean_square(&self.moved[blocks]))
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
