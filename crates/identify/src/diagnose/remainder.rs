//! What a hypothesis leaves: stretches of a trial in which the prediction errors are larger or steadier than noise.

use nalgebra::DVector;
use sistership_model::trial::Channel;

use super::outcome::Unexplained;
use super::workspace::Workspace;
use crate::residual::{Discrepancies, Linearised, whitened};

/// Prediction errors are added up over so long, in the times in which the ship sails her length: what lasts stands out.
const BLOCK: f64 = 0.6;
/// Blocks that are judged together.
const BLOCKS: usize = 6;
/// Root mean square of the sums, in deviations, above which a stretch is not noise.
const LIMIT: f64 = 3.0;

/// Stretches that the columns at `parameters` leave unexplained, under the discrepancy that is expected.
pub(super) fn unexplained(
    workspace: &Workspace<'_>,
    discrepancies: &Discrepancies,
    parameters: &DVector<f64>,
) -> Vec<Unexplained> {
    let block_s = BLOCK * workspace.lpp_m / workspace.speed_m_s;
    let mut found = Vec::new();
    for (trial, parts) in workspace.trials.iter().zip(workspace.linear()) {
        for part in parts {
            let errors = errors(workspace, part, discrepancies, parameters);
            for (place, &(channel, _)) in part.channels.iter().enumerate() {
                if matches!(channel, Channel::U | Channel::V | Channel::R | Channel::P | Channel::Psi) {
                    found.extend(stretches(&trial.name, channel, part, &errors[place], block_s));
                }
            }
        }
    }
    found.sort_by(|a, b| b.rms_over_noise.total_cmp(&a.rms_over_noise));
    found
}

/// Prediction errors in deviations, by channel.
fn errors(
    workspace: &Workspace<'_>,
    part: &Linearised,
    discrepancies: &Discrepancies,
    parameters: &DVector<f64>,
) -> Vec<Vec<f64>> {
    let (rows, _) = whitened(part, &workspace.noise, discrepancies);
    let width = 1 + part.sizes.columns;
    let mut errors = vec![Vec::with_capacity(part.samples.len()); part.channels.len()];
    for (index, row) in rows.chunks_exact(width).enumerate() {
        let explained: f64 = row[1..].iter().zip(parameters.iter()).map(|(column, value)| column * value).sum();
        errors[index % part.channels.len()].push(row[0] - explained);
    }
    errors
}

/// Runs of blocks above the limit, each as one stretch.
fn stretches(trial: &str, channel: Channel, part: &Linearised, errors: &[f64], block_s: f64) -> Vec<Unexplained> {
    let interval = (part.t_s[part.t_s.len() - 1] - part.t_s[0]) / (part.t_s.len() - 1) as f64;
    let size = (block_s / interval).round().max(1.0) as usize;
    let sums: Vec<f64> = errors.chunks(size).map(|block| block.iter().sum::<f64>() / (block.len() as f64).sqrt()).collect();
    let rms = |from: usize, to: usize| (sums[from..to].iter().map(|s| s * s).sum::<f64>() / (to - from) as f64).sqrt();
    let mut found = Vec::new();
    let mut open: Option<(usize, usize)> = None;
    for from in 0..sums.len().saturating_sub(BLOCKS - 1) {
        let to = from + BLOCKS;
        let is_large = rms(from, to) > LIMIT;
        open = match (open, is_large) {
            (Some((start, end)), true) if from <= end => Some((start, to)),
            (Some(stretch), true) => {
                found.push(stretch);
                Some((from, to))
            }
            (None, true) => Some((from, to)),
            (kept, false) => kept,
        };
    }
    found.extend(open);
    let time = |block: usize| part.t_s[(block * size).min(part.t_s.len() - 1)];
    let stretch = |(from, to): (usize, usize)| Unexplained {
        channel: channel.name().to_owned(),
        rms_over_noise: rms(from, to),
        trial: trial.to_owned(),
        from_s: time(from),
        to_s: time(to),
    };
    found.into_iter().map(stretch).collect()
}
