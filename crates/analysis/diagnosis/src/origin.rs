//! Origin of an unexplained remainder: a force that the equations of motion lack, or an instrument.
//!
//! A force in one direction affects all readings that follow from it, the heading before the sway
//! velocity where the ship turns easily. So each acceleration alone, and each instrument alone, is
//! assumed to be more random than it is known to be, and the one that makes the trials most
//! probable is first: the likelihood of a Gauss-Markov model by prediction errors (Maybeck 1979,
//! Stochastic models, estimation and control, vol. 1, section 5.6; Schweppe 1965, IEEE Trans.
//! Inform. Theory 11, 61-70), maximised over one standard deviation.

use rayon::prelude::*;
use sistership_model::trial::Channel;

use super::changes::trials_with_remainder;
use super::choose::ConvergedChoice;
use super::outcome::{OriginKind, RemainderOrigin, UnexplainedSegment};
use super::select::{column_changes, remainder_discrepancies};
use super::thresholds::THRESHOLDS;
use sistership_filtering::{AxisDiscrepancies, InstrumentNoise, LinearisedPart, part_deviances};
use sistership_identification::refine::RefineError;

/// Deviance of each trial with a remainder.
type TrialDeviances = Vec<f64>;

/// Trials with a remainder, with the effects found, ready for the filter.
struct OpenTrials {
    /// Parts of all trials, one trial after the other.
    parts: Vec<LinearisedPart>,
    /// Index of the trial of each part.
    trials: Vec<usize>,
    count: usize,
}

/// A possible origin: an acceleration or an instrument with a larger standard deviation.
struct OriginCandidate {
    of: OriginKind,
    channel: String,
    /// Gain in the logarithm of the probability of each trial.
    gains: Vec<f64>,
}

/// Returns origins by their evidence, the most evident first: those above `least`. Of many trials
/// with a remainder, those with the largest are examined.
///
/// # Errors
/// Returns an error if the noise of a channel is unknown.
pub(super) fn remainder_origins(
    settled: &ConvergedChoice<'_>,
    remaining: &[UnexplainedSegment],
    least: f64,
) -> Result<Vec<RemainderOrigin>, RefineError> {
    let trials = OpenTrials::new(settled, remaining);
    if trials.count == 0 {
        return Ok(Vec::new());
    }
    let workspace = &settled.base.workspace;
    let (noise, discrepancies) =
        (&workspace.noise, remainder_discrepancies(&settled.search, workspace));
    // The deviance with the known randomness is the reference of all gains.
    let known = trials.trial_deviances(noise, &discrepancies)?;
    let gained = |of: OriginKind, channel: &str, each: Result<Vec<TrialDeviances>, RefineError>| {
        Ok(OriginCandidate { of, channel: channel.to_owned(), gains: best_gains(&known, &each?) })
    };
    let acceleration = |axis: usize| {
        let factors = THRESHOLDS.origin.factors.par_iter();
        let of = |factor: &f64| {
            trials.trial_deviances(noise, &amplify_discrepancy(&discrepancies, axis, *factor))
        };
        let velocity = workspace.axes()[axis].velocity_name();
        gained(OriginKind::Acceleration, velocity, factors.map(of).collect())
    };
    let readings = |channel: &Channel| {
        let factors = THRESHOLDS.origin.factors.par_iter();
        let of = |factor: &f64| {
            trials.trial_deviances(&amplify_noise(noise, *channel, *factor), &discrepancies)
        };
        gained(OriginKind::Readings, channel.name(), factors.map(of).collect())
    };
    let alternatives: Vec<OriginCandidate> = (0..discrepancies.len())
        .map(acceleration)
        .chain(noise.keys().map(readings))
        .collect::<Result<_, RefineError>>()?;
    Ok(rank_origins(&alternatives, least))
}

impl OpenTrials {
    fn new(settled: &ConvergedChoice<'_>, remaining: &[UnexplainedSegment]) -> Self {
        let workspace = &settled.base.workspace;
        let parameters = column_changes(&settled.best);
        let place = |name: &String| workspace.trials.iter().position(|trial| trial.name == *name);
        let places =
            trials_with_remainder(remaining).iter().filter_map(place).collect::<Vec<usize>>();
        let asked = &places[..places.len().min(THRESHOLDS.origin.asked)];
        let (mut parts, mut trials) = (Vec::new(), Vec::new());
        for (trial, &place) in asked.iter().enumerate() {
            for part in &workspace.linearised_parts()[place] {
                parts.push(part.combine_columns(&parameters));
                trials.push(trial);
            }
        }
        Self { parts, trials, count: asked.len() }
    }

    fn trial_deviances(
        &self,
        noise: &InstrumentNoise,
        discrepancies: &AxisDiscrepancies,
    ) -> Result<TrialDeviances, RefineError> {
        let parts: Vec<&LinearisedPart> = self.parts.iter().collect();
        let mut all = vec![0.0; self.count];
        let each = part_deviances(&parts, noise, discrepancies)?;
        self.trials.iter().zip(each).for_each(|(&trial, deviance)| all[trial] += deviance);
        Ok(all)
    }
}

/// Discrepancies of which one is larger.
fn amplify_discrepancy(
    discrepancies: &AxisDiscrepancies,
    axis: usize,
    factor: f64,
) -> AxisDiscrepancies {
    let mut amplified = discrepancies.clone();
    amplified[axis].deviation *= factor;
    amplified[axis].white *= factor;
    amplified
}

/// Instruments of which one has more noise.
fn amplify_noise(noise: &InstrumentNoise, channel: Channel, factor: f64) -> InstrumentNoise {
    let mut noisier = noise.clone();
    noisier.entry(channel).and_modify(|instrument| {
        instrument.deviation *= factor;
        // The drift of a velocity is an acceleration, which is a separate candidate.
        if !VELOCITIES.contains(&channel) {
            instrument.drift *= factor;
        }
    });
    noisier
}

const VELOCITIES: [Channel; 4] = [Channel::U, Channel::V, Channel::R, Channel::P];

/// Gain of each trial by the factor by which all together gain most.
fn best_gains(known: &TrialDeviances, each: &[TrialDeviances]) -> Vec<f64> {
    let gains = |by: &TrialDeviances| -> Vec<f64> {
        // Half the difference of deviances is the gain in log likelihood.
        known.iter().zip(by).map(|(known, by)| 0.5 * (known - by)).collect()
    };
    let all = each.iter().map(gains);
    all.max_by(|a, b| a.iter().sum::<f64>().total_cmp(&b.iter().sum())).unwrap_or_default()
}

fn rank_origins(alternatives: &[OriginCandidate], least: f64) -> Vec<RemainderOrigin> {
    let is_first = |one: &OriginCandidate, trial: usize| {
        one.gains[trial] > 0.0
            && alternatives.iter().all(|other| other.gains[trial] <= one.gains[trial])
    };
    let of = |one: &OriginCandidate| RemainderOrigin {
        of: one.of,
        channel: one.channel.clone(),
        evidence: one.gains.iter().sum(),
        first_in: (0..one.gains.len()).filter(|trial| is_first(one, *trial)).count(),
        trials: one.gains.len(),
    };
    let mut all: Vec<RemainderOrigin> =
        alternatives.iter().map(of).filter(|one| one.evidence > least).collect();
    all.sort_by(|a, b| b.evidence.total_cmp(&a.evidence));
    all.truncate(THRESHOLDS.origin.shown);
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    fn alternative(channel: &str, gains: &[f64]) -> OriginCandidate {
        let (of, channel) = (OriginKind::Acceleration, channel.to_owned());
        OriginCandidate { of, channel, gains: gains.to_vec() }
    }

    #[test]
    fn the_most_evident_over_all_trials_comes_first() {
        let all = [alternative("r", &[5.0, 9.0]), alternative("v", &[50.0, 8.0])];
        let ranked = rank_origins(&all, 5.0);
        let told = |one: &RemainderOrigin| (one.channel.clone(), one.evidence, one.first_in);
        let told: Vec<(String, f64, usize)> = ranked.iter().map(told).collect();
        assert_eq!(told, [("v".to_owned(), 58.0, 1), ("r".to_owned(), 14.0, 1)]);
    }

    #[test]
    fn what_makes_nothing_more_probable_is_not_told() {
        assert!(rank_origins(&[alternative("u", &[4.0, -1.0])], 5.0).is_empty());
        assert_eq!(best_gains(&vec![10.0, 20.0], &[vec![4.0, 30.0], vec![8.0, 18.0]]), [1.0, 1.0]);
    }
}
