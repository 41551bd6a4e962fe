//! Segments of trials: where each starts, what is put in along it, and what it should come to.

use std::ops::Range;

use sistership_model::effect::input_channel;
use sistership_model::law::Law;
use sistership_model::trial::{Channel, Trial};
use sistership_simulation::error::wrapped;
use sistership_simulation::interpolate::MonotoneCubic;
use sistership_simulation::state::{RECORDED, StateVector, at};

use super::super::outcome::RefineError;
use super::thresholds::TRAJECTORY;

/// How a motion is cut and weighed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in super::super) struct SegmentLengths {
    /// Length of a segment, s.
    pub segment_s: f64,
    /// From one residual to the next, s.
    pub residual_s: f64,
    /// Integration step, s; whole sampling intervals.
    pub step_s: f64,
}

/// One segment.
#[derive(Debug)]
pub(in super::super) struct Segment {
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

/// What is the same for every segment.
#[derive(Debug)]
pub(in super::super) struct ComparisonPlan {
    /// Compared states: row among the sensitivities, place in the state vector, standard deviation.
    pub compared: Vec<(usize, usize, f64)>,
    /// Steps from one residual to the next.
    pub stride: usize,
    /// Step, s.
    pub step_s: f64,
}

/// Cuts trials into segments; a rest of at least a third of a segment is kept.
///
/// # Errors
/// Names the channel that a trial lacks.
pub(in super::super) fn cut(
    trials: &[&Trial],
    law: &Law,
    input_names: &[String],
    cut: SegmentLengths,
    plan: &ComparisonPlan,
) -> Result<Vec<Segment>, RefineError> {
    let mut segments = Vec::new();
    for (index, trial) in trials.iter().enumerate() {
        let record = SegmentRecord::new(trial, law, input_names, plan)?;
        for part in trial.segments() {
            let (mut from, end) = (trial.t_s[part.start], trial.t_s[part.end - 1]);
            while end - from >= cut.segment_s / TRAJECTORY.least_part {
                let steps = (cut.segment_s.min(end - from) / plan.step_s + 1e-9).floor() as usize
                    / plan.stride
                    * plan.stride;
                if steps > 0 {
                    segments.push(record.segment(index, part.clone(), from, steps));
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

enum SegmentInput<'a> {
    Constant(f64),
    Recorded { column: &'a [f64], cubic: MonotoneCubic<'a>, angle: bool },
}

impl<'a> SegmentRecord<'a> {
    fn new(
        trial: &'a Trial,
        law: &Law,
        input_names: &[String],
        plan: &'a ComparisonPlan,
    ) -> Result<Self, RefineError> {
        let input = |name: &String| {
            let channel = input_channel(name);
            if let Some((channel, column)) =
                channel.and_then(|channel| Some((channel, trial.channel(channel)?)))
            {
                let cubic = MonotoneCubic::new(&trial.t_s, column);
                return Ok(SegmentInput::Recorded {
                    column,
                    cubic,
                    angle: channel == Channel::WindFrom,
                });
            }
            let default = law.inputs.get(name.as_str()).and_then(|input| input.default);
            let constant =
                if channel == Some(Channel::Depth) { trial.depth_m.or(default) } else { default };
            let missing = || RefineError::Channel {
                trial: trial.name.clone(),
                channel: channel.unwrap_or(Channel::Delta),
            };
            constant.map(SegmentInput::Constant).ok_or_else(missing)
        };
        let inputs = input_names.iter().map(input).collect::<Result<_, _>>()?;
        let states: Vec<(usize, &[f64])> =
            RECORDED.iter().filter_map(|&(c, place)| Some((place, trial.channel(c)?))).collect();
        Ok(Self { trial, plan, inputs, states })
    }

    fn segment(&self, index: usize, part: Range<usize>, from: f64, steps: usize) -> Segment {
        let half = 0.5 * self.plan.step_s;
        let mut inputs = Vec::with_capacity((2 * steps + 1) * self.inputs.len());
        for k in 0..=2 * steps {
            let t = from + k as f64 * half;
            inputs.extend(self.inputs.iter().map(|input| self.input(input, &part, t, 0.5 * half)));
        }
        let mut start = StateVector::zeros();
        self.states
            .iter()
            .for_each(|(place, column)| start[*place] = self.value(column, &part, from));
        let mut measured = Vec::new();
        for k in 1..=steps / self.plan.stride {
            let t = from + (k * self.plan.stride) as f64 * self.plan.step_s;
            for &(_, place, _) in &self.plan.compared {
                let column = self.states.iter().find(|(of, _)| *of == place);
                measured.push(column.map_or(f64::NAN, |(_, column)| self.value(column, &part, t)));
            }
        }
        Segment { trial: index, start, inputs, steps, measured }
    }

    /// Sample before a time, and how far it is to the next.
    fn place(&self, part: &Range<usize>, t: f64) -> (usize, f64) {
        let t_s = &self.trial.t_s;
        let after = part.start + t_s[part.clone()].partition_point(|s| *s <= t + 1e-9);
        let k =
            after.saturating_sub(1).clamp(part.start, part.end.saturating_sub(2).max(part.start));
        let step = t_s.get(k + 1).map_or(1.0, |next| next - t_s[k]);
        (k, ((t - t_s[k]) / step).clamp(0.0, 1.0))
    }

    /// A state between samples, straight.
    fn value(&self, column: &[f64], part: &Range<usize>, t: f64) -> f64 {
        let (k, w) = self.place(part, t);
        if k + 1 < part.end { column[k] + w * (column[k + 1] - column[k]) } else { column[k] }
    }

    /// An input at a time: the mean over a quarter step to both sides where there are as many as
    /// three samples in it, else as in a simulation.
    fn input(&self, input: &SegmentInput<'_>, part: &Range<usize>, t: f64, around: f64) -> f64 {
        let SegmentInput::Recorded { column, cubic, angle } = input else {
            let SegmentInput::Constant(value) = input else { return 0.0 };
            return *value;
        };
        let (k, w) = self.place(part, t);
        let t_s = &self.trial.t_s[part.clone()];
        let (low, high) =
            (t_s.partition_point(|s| *s < t - around), t_s.partition_point(|s| *s <= t + around));
        let near = &column[part.start + low..part.start + high];
        let from = column[k];
        if *angle {
            let turned = |value: &f64| wrapped(value - from);
            let next = column.get(k + 1).map_or(0.0, turned);
            return from
                + if near.len() < 3 {
                    w * next
                } else {
                    near.iter().map(turned).sum::<f64>() / near.len() as f64
                };
        }
        if near.len() < 3 { cubic.at(k, w) } else { near.iter().sum::<f64>() / near.len() as f64 }
    }
}

/// The states that are compared: all that some trial records, by their standard deviation over the
/// trials.
pub(in super::super) fn compared(
    states: &[usize],
    deviations: &std::collections::BTreeMap<Channel, f64>,
) -> Vec<(usize, usize, f64)> {
    let of = |&(channel, place): &(Channel, usize)| {
        let row = states.iter().position(|&state| state == place)?;
        let deviation = *deviations.get(&channel)?;
        (deviation > 0.0).then_some((row, place, deviation))
    };
    RECORDED.iter().filter_map(of).collect()
}

/// The difference of a simulated from a measured value of a state.
pub(super) fn difference(place: usize, simulated: f64, measured: f64) -> f64 {
    if place == at::PSI { wrapped(simulated - measured) } else { simulated - measured }
}
