//! Segments of trials: initial states, inputs along them, and the measured states.

use std::borrow::Cow;
use std::ops::Range;

use sistership_model::effect::input_channel;
use sistership_model::law::Law;
use sistership_model::trial::{Channel, Trial};
use sistership_model::trial_input::{MissingInput, TrialInput, find_input};
use sistership_simulation::error::wrap_angle;
use sistership_simulation::interpolate::MonotoneCubic;
use sistership_simulation::state::{RECORDED_CHANNELS, StateVector, at};

use super::super::outcome::RefineError;
use super::thresholds::TRAJECTORY;

/// Lengths by which trials are divided and compared.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in super::super) struct SegmentLengths {
    /// Length of a segment, s.
    pub segment_s: f64,
    /// Time from one residual to the next, s.
    pub residual_s: f64,
    /// Integration step, s; whole sampling intervals.
    pub step_s: f64,
}

/// One segment.
#[derive(Debug)]
pub(in super::super) struct TrialSegment {
    /// Place of its trial among all.
    pub trial: usize,
    /// The measured state at its start.
    pub start: StateVector,
    /// Inputs at every half step, by input.
    pub inputs: Vec<f64>,
    /// Number of steps.
    pub steps: usize,
    /// Measured values of the compared states at every residual, by state.
    pub measured: Vec<f64>,
}

/// Plan of the comparisons, the same for every segment.
#[derive(Debug)]
pub(in super::super) struct ComparisonPlan {
    /// Compared states: row among the sensitivities, place in the state vector, standard deviation.
    pub compared: Vec<(usize, usize, f64)>,
    /// Steps from one residual to the next.
    pub stride: usize,
    /// Step, s.
    pub step_s: f64,
}

/// Divides trials into segments; a rest with residuals enough is kept.
///
/// # Errors
/// Returns an error with the channel that a trial lacks, or the input that none can record.
pub(in super::super) fn divide_into_segments(
    trials: &[&Trial],
    law: &Law,
    input_names: &[String],
    cut: SegmentLengths,
    plan: &ComparisonPlan,
) -> Result<Vec<TrialSegment>, RefineError> {
    let mut segments = Vec::new();
    for (index, trial) in trials.iter().enumerate() {
        let record = SegmentRecord::new(trial, law, input_names, plan)?;
        for part in trial.segments() {
            let (mut from, end) = (trial.t_s[part.start], trial.t_s[part.end - 1]);
            while end - from >= cut.segment_s.min(TRAJECTORY.least_residuals * cut.residual_s) {
                // Whole steps that end with a comparison; the small term keeps ratios that are
                // whole but for rounding.
                let steps = (cut.segment_s.min(end - from) / plan.step_s + 1e-9).floor() as usize
                    / plan.stride
                    * plan.stride;
                if steps > 0 {
                    segments.push(record.build_segment(index, part.clone(), from, steps));
                }
                from += cut.segment_s;
            }
        }
    }
    // Lanes run in lockstep: those of a length together.
    segments.sort_by_key(|segment| std::cmp::Reverse(segment.steps));
    Ok(segments)
}

/// The channels of a trial that segments read.
struct SegmentRecord<'a> {
    trial: &'a Trial,
    plan: &'a ComparisonPlan,
    inputs: Vec<SegmentInput<'a>>,
    states: Vec<(usize, &'a [f64])>,
}

/// An input of a segment.
enum SegmentInput<'a> {
    Constant(f64),
    Recorded { column: Cow<'a, [f64]>, cubic: MonotoneCubic<'a>, angle: bool },
}

impl<'a> SegmentInput<'a> {
    fn new(trial: &'a Trial, law: &Law, name: &str) -> Result<Self, MissingInput> {
        let default = law.inputs.get(name).and_then(|input| input.default);
        let column = match find_input(trial, name, default)? {
            TrialInput::Samples(column) => column,
            TrialInput::Constant(value) => return Ok(Self::Constant(value)),
        };
        let cubic = MonotoneCubic::new(&trial.t_s, column.clone());
        let angle = input_channel(name) == Some(Channel::WindFrom);
        Ok(Self::Recorded { column, cubic, angle })
    }
}

impl<'a> SegmentRecord<'a> {
    fn new(
        trial: &'a Trial,
        law: &Law,
        input_names: &[String],
        plan: &'a ComparisonPlan,
    ) -> Result<Self, MissingInput> {
        let inputs = input_names
            .iter()
            .map(|name| SegmentInput::new(trial, law, name))
            .collect::<Result<_, _>>()?;
        let states: Vec<(usize, &[f64])> = RECORDED_CHANNELS
            .iter()
            .filter_map(|&(c, place)| Some((place, trial.channel(c)?)))
            .collect();
        Ok(Self { trial, plan, inputs, states })
    }

    /// A segment of a part of the record from a time on.
    fn build_segment(
        &self,
        index: usize,
        part: Range<usize>,
        from: f64,
        steps: usize,
    ) -> TrialSegment {
        let half = 0.5 * self.plan.step_s;
        let mut inputs = Vec::with_capacity((2 * steps + 1) * self.inputs.len());
        for k in 0..=2 * steps {
            let t = from + k as f64 * half;
            // Inputs are averaged over a quarter step to both sides of a half step.
            inputs.extend(
                self.inputs.iter().map(|input| self.input_value(input, &part, t, 0.5 * half)),
            );
        }
        let mut start = StateVector::zeros();
        self.states
            .iter()
            .for_each(|(place, column)| start[*place] = self.state_value(column, &part, from));
        let mut measured = Vec::new();
        for k in 1..=steps / self.plan.stride {
            let t = from + (k * self.plan.stride) as f64 * self.plan.step_s;
            for &(_, place, _) in &self.plan.compared {
                let column = self.states.iter().find(|(of, _)| *of == place);
                measured.push(
                    column.map_or(f64::NAN, |(_, column)| self.state_value(column, &part, t)),
                );
            }
        }
        TrialSegment { trial: index, start, inputs, steps, measured }
    }

    /// Returns the sample before a time, and the fraction of the interval to the next.
    fn sample_before(&self, part: &Range<usize>, t: f64) -> (usize, f64) {
        let t_s = &self.trial.t_s;
        let after = part.start + t_s[part.clone()].partition_point(|s| *s <= t + 1e-9);
        let k =
            after.saturating_sub(1).clamp(part.start, part.end.saturating_sub(2).max(part.start));
        let step = t_s.get(k + 1).map_or(1.0, |next| next - t_s[k]);
        (k, ((t - t_s[k]) / step).clamp(0.0, 1.0))
    }

    /// A state at a time, linear between samples.
    fn state_value(&self, column: &[f64], part: &Range<usize>, t: f64) -> f64 {
        let (k, w) = self.sample_before(part, t);
        if k + 1 < part.end { column[k] + w * (column[k + 1] - column[k]) } else { column[k] }
    }

    /// An input at a time: the mean over a quarter step to both sides if that contains three
    /// samples or more, otherwise interpolated as in a simulation.
    fn input_value(
        &self,
        input: &SegmentInput<'_>,
        part: &Range<usize>,
        t: f64,
        around: f64,
    ) -> f64 {
        let SegmentInput::Recorded { column, cubic, angle } = input else {
            let SegmentInput::Constant(value) = input else { return 0.0 };
            return *value;
        };
        let (k, w) = self.sample_before(part, t);
        let t_s = &self.trial.t_s[part.clone()];
        let (low, high) =
            (t_s.partition_point(|s| *s < t - around), t_s.partition_point(|s| *s <= t + around));
        let near = &column[part.start + low..part.start + high];
        let from = column[k];
        if *angle {
            // Directions are averaged as differences to a sample nearby, which may cross 180 deg.
            let turned = |value: &f64| wrap_angle(value - from);
            // The last sample has no next one to be turned to.
            let next = column.get(k + 1).map_or(0.0, turned);
            return from
                + if near.len() < 3 {
                    w * next
                } else {
                    near.iter().map(turned).sum::<f64>() / near.len() as f64
                };
        }
        if near.len() < 3 {
            cubic.interpolate_at(k, w)
        } else {
            near.iter().sum::<f64>() / near.len() as f64
        }
    }
}

/// Returns the states that are compared: those that some trial records, with their standard
/// deviations over the trials.
pub(in super::super) fn compared_states(
    states: &[usize],
    deviations: &std::collections::BTreeMap<Channel, f64>,
) -> Vec<(usize, usize, f64)> {
    let of = |&(channel, place): &(Channel, usize)| {
        let row = states.iter().position(|&state| state == place)?;
        let deviation = *deviations.get(&channel)?;
        (deviation > 0.0).then_some((row, place, deviation))
    };
    RECORDED_CHANNELS.iter().filter_map(of).collect()
}

/// Returns the simulated less the measured value of a state; headings are differenced on the
/// circle.
pub(super) fn state_difference(place: usize, simulated: f64, measured: f64) -> f64 {
    if place == at::PSI { wrap_angle(simulated - measured) } else { simulated - measured }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use sistership_formula::units::Dimension;
    use sistership_model::law::LawInput;

    use super::*;
    use crate::testing::{mariner_model, simulated_trials};

    #[test]
    fn a_trial_shorter_than_a_segment_is_one() {
        let (model, law) = mariner_model();
        let trials = simulated_trials(&model, &law, 0.0);
        let names: Vec<String> = law.inputs.keys().cloned().collect();
        let cut = SegmentLengths { segment_s: 1e5, residual_s: 5.0, step_s: 1.0 };
        let plan = ComparisonPlan { compared: Vec::new(), stride: 5, step_s: 1.0 };
        let one = divide_into_segments(&[&trials[0]], &law, &names, cut, &plan).unwrap();
        assert_eq!(one.len(), 1);
        assert!(one[0].steps as f64 > trials[0].duration_s() - 6.0);
    }

    #[test]
    fn an_input_that_no_trial_can_record_is_not_reported_as_the_rudder() {
        let (model, law) = mariner_model();
        let trials = simulated_trials(&model, &law, 0.0);
        let mut law = law.as_ref().clone();
        law.inputs.insert(
            "ballast".into(),
            LawInput { dimension: Dimension::NONE, default: None, helm: None },
        );
        let names: Vec<String> = law.inputs.keys().cloned().collect();
        let cut = SegmentLengths { segment_s: 60.0, residual_s: 5.0, step_s: 1.0 };
        let plan = ComparisonPlan { compared: Vec::new(), stride: 5, step_s: 1.0 };
        let divided = divide_into_segments(&[&trials[0]], &law, &names, cut, &plan);
        let Err(RefineError::Law(message)) = divided else { panic!("{divided:?}") };
        assert!(message.contains("`ballast`"), "{message}");
    }
}
