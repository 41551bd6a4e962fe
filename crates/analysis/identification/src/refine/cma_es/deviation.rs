//! Accelerations from extreme states under extreme controls: Miyauchi 2024, Eqs. 29 to 33.

use sistership_model::effect::input_channel;
use sistership_model::law::Law;
use sistership_model::trial::{Channel, Trial};
use sistership_simulation::Method;
use sistership_simulation::candidates::{CandidateRun, CandidateSystem};
use sistership_simulation::state::{RECORDED_CHANNELS, StateVector};
use sistership_simulation::tape::LaneValues;

use super::thresholds::OBJECTIVE;

/// Combinations of states and controls that are simulated in lockstep.
const LANES: usize = 16;
/// Combinations of extreme states and controls, with the limits of their accelerations.
#[derive(Debug)]
pub(super) struct DeviationPenalty {
    blocks: Vec<(Vec<StateVector>, Vec<LaneValues<LANES>>)>,
    limits: [f64; 3],
    steps: usize,
    step_s: f64,
    count: f64,
}

impl DeviationPenalty {
    /// Creates the penalty from the extremes of trials. Accelerations are means over `window_s`,
    /// the duration for which each combination is simulated.
    pub fn new(
        system: &CandidateSystem,
        law: &Law,
        trials: &[&Trial],
        step_s: f64,
        window_s: f64,
    ) -> Self {
        let starts = combinations(
            &RECORDED_CHANNELS[..3]
                .iter()
                .map(|&(c, _)| extreme_values(trials, c, OBJECTIVE.beyond))
                .collect::<Vec<_>>(),
        );
        let controls: Vec<Vec<f64>> =
            system.input_names().iter().map(|name| input_values(name, law, trials)).collect();
        let controls: Vec<Vec<f64>> =
            combinations(&controls).iter().map(|inputs| system.prepare_inputs(inputs)).collect();
        let pairs: Vec<(StateVector, &Vec<f64>)> = starts
            .iter()
            .flat_map(|start| controls.iter().map(|inputs| (velocity_state(start), inputs)))
            .collect();
        // A short chunk repeats its last combination; the sum below leaves the repetitions out.
        let blocks = pairs.chunks(LANES).map(|chunk| {
            let starts = chunk.iter().map(|(start, _)| *start).collect();
            let width = chunk[0].1.len();
            let lane = |input: usize| {
                std::array::from_fn(|lane| chunk[lane.min(chunk.len() - 1)].1[input])
            };
            (starts, (0..width).map(lane).collect())
        });
        let blocks = blocks.collect();
        let limits = [Channel::U, Channel::V, Channel::R]
            .map(|channel| acceleration_limit(trials, channel, window_s));
        let steps = (window_s / step_s).round().max(1.0) as usize;
        Self { blocks, limits, steps, step_s, count: pairs.len() as f64 }
    }

    /// Returns the mean penalty over the combinations, Eq. 29 divided by their number: 0 if none
    /// exceeds the limits, about 1 if all do at once.
    pub fn mean_penalty(
        &self,
        system: &CandidateSystem,
        method: Method,
        coefficients: &[f64],
    ) -> f64 {
        let mut run = CandidateRun::<LANES>::new(system);
        let one = |(starts, inputs): &(Vec<StateVector>, Vec<LaneValues<LANES>>)| {
            (0..LANES).for_each(|lane| run.start_lane(lane, &starts[lane.min(starts.len() - 1)]));
            // First step at which a lane exceeds a limit; `steps` if it never does.
            let mut over = [self.steps; LANES];
            for step in 0..self.steps {
                run.advance_step(method, self.step_s, [inputs, inputs, inputs], coefficients);
                for (row, limit) in self.limits.iter().enumerate() {
                    for (over, rate) in over.iter_mut().zip(run.rate_lanes(row)) {
                        // A value that is not a number fails the comparison and so exceeds any
                        // limit.
                        let within = rate.abs() <= *limit;
                        *over = if within { *over } else { step.min(*over) };
                    }
                }
            }
            let soon = |over: &usize| {
                if *over < self.steps {
                    1.0 - (*over as f64 - 1.0) / self.steps as f64
                } else {
                    0.0
                }
            };
            over[..starts.len()].iter().map(soon).sum::<f64>()
        };
        self.blocks.iter().map(one).sum::<f64>() / self.count.max(1.0)
    }
}

/// Low, middle (0 if that is between them) and high value of a channel; a single zero if no trial
/// has it.
fn extreme_values(trials: &[&Trial], channel: Channel, margin: f64) -> Vec<f64> {
    let values = trials.iter().filter_map(|trial| trial.channel(channel)).flatten();
    let (low, high) = values
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(*v), high.max(*v)));
    if low > high {
        return vec![0.0];
    }
    let beyond = margin * (high - low);
    let (low, high) = (low - beyond, high + beyond);
    let middle = if low < 0.0 && high > 0.0 { 0.0 } else { 0.5 * (low + high) };
    if low < high { vec![low, middle, high] } else { vec![low] }
}

/// Values of an input: its default where it has one, the extremes of the trials for a control
/// without a default, otherwise 0.
fn input_values(name: &str, law: &Law, trials: &[&Trial]) -> Vec<f64> {
    let default = law.inputs.get(name).and_then(|input| input.default);
    match (default, input_channel(name)) {
        (Some(default), _) => vec![default],
        (None, Some(channel)) => extreme_values(trials, channel, 0.0),
        (None, None) => vec![0.0],
    }
}

/// All combinations of one value from each list. Beyond the first few lists with several values,
/// only the middle value is used.
fn combinations(choices: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let mut all = vec![Vec::new()];
    let mut several = 0;
    for choice in choices {
        several += usize::from(choice.len() > 1);
        let taken = if several > OBJECTIVE.controls {
            &choice[choice.len() / 2..=choice.len() / 2]
        } else {
            &choice[..]
        };
        let longer = |before: &Vec<f64>| {
            taken
                .iter()
                .map(|value| before.iter().copied().chain([*value]).collect::<Vec<f64>>())
                .collect::<Vec<_>>()
        };
        all = all.iter().flat_map(longer).collect();
    }
    all
}

/// A state with these velocities.
fn velocity_state(velocities: &[f64]) -> StateVector {
    let mut state = StateVector::zeros();
    RECORDED_CHANNELS.iter().zip(velocities).for_each(|(&(_, place), value)| state[place] = *value);
    state
}

/// The 99.7th percentile of absolute accelerations, as means over a window: Eq. 33. Infinite
/// without data.
fn acceleration_limit(trials: &[&Trial], channel: Channel, window_s: f64) -> f64 {
    let mut sizes = Vec::new();
    for trial in trials {
        let (Some(column), stride) =
            (trial.channel(channel), (window_s / trial.interval_s()).round().max(1.0) as usize)
        else {
            continue;
        };
        for part in trial.segments() {
            let within = part.start..part.end.saturating_sub(stride);
            let rate = |k: usize| {
                ((column[k + stride] - column[k]) / (trial.t_s[k + stride] - trial.t_s[k])).abs()
            };
            sizes.extend(within.map(rate));
        }
    }
    sizes.sort_by(f64::total_cmp);
    let at = (OBJECTIVE.percentile * sizes.len() as f64) as usize;
    sizes.get(at.min(sizes.len().saturating_sub(1))).copied().unwrap_or(f64::INFINITY)
}
