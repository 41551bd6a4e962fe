//! The objective of a set of coefficients: Miyauchi 2024, Eqs. 20 to 23, divided by the duration of
//! the trials.

use sistership_simulation::candidates::{CandidateRun, CandidateSystem};
use sistership_simulation::state::StateVector;
use sistership_simulation::tape::LaneValues;
use sistership_simulation::{Method, MotionEnvelope};

use super::super::trajectory::{ComparisonPlan, TrialSegment};
use super::deviation::DeviationPenalty;
use super::thresholds::OBJECTIVE;

/// Subsequences that are simulated in lockstep.
const LANES: usize = 16;

/// Subsequences that are simulated in lockstep: initial states, inputs and measurements, by lane.
#[derive(Debug)]
struct SequenceBlock {
    starts: Vec<StateVector>,
    /// Inputs at every whole or half step, as the method needs, one step after the other.
    inputs: Vec<LaneValues<LANES>>,
    steps: usize,
    /// Measured u, v and r at every comparison; not a number after a lane's end.
    measured: Vec<[LaneValues<LANES>; 3]>,
    /// Number of comparisons of each lane.
    compared: LaneValues<LANES>,
}

/// Subsequences of some trials.
#[derive(Debug)]
pub(super) struct SubsequenceSet {
    blocks: Vec<SequenceBlock>,
    /// Number of comparisons of all subsequences.
    count: f64,
}

/// The constant parts of the objective, the same for all subsequences.
#[derive(Debug)]
pub(super) struct SearchObjective {
    pub system: CandidateSystem,
    pub plan: ComparisonPlan,
    pub method: Method,
    pub envelope: MotionEnvelope,
    pub deviation: DeviationPenalty,
    /// Weights of the deviation and of the sizes.
    pub weights: (f64, f64),
    /// The source's coefficients, and the natural size of each.
    pub source: Vec<f64>,
    pub sizes: Vec<f64>,
    /// Half width of the box.
    pub width: f64,
}

impl SubsequenceSet {
    /// Creates the subsequences of segments, which are sorted by length.
    pub fn new<'s>(
        objective: &SearchObjective,
        segments: impl Iterator<Item = &'s TrialSegment>,
    ) -> Self {
        let all: Vec<&TrialSegment> = segments.collect();
        let blocks: Vec<SequenceBlock> =
            all.chunks(LANES).map(|chunk| SequenceBlock::new(objective, chunk)).collect();
        let count = blocks.iter().flat_map(|block| block.compared).sum();
        Self { blocks, count }
    }
}

impl SequenceBlock {
    fn new(objective: &SearchObjective, segments: &[&TrialSegment]) -> Self {
        let SearchObjective { system, plan, method, .. } = objective;
        let (steps, width) = (segments[0].steps, system.input_names().len());
        // Segments have inputs at half steps; Euler's method needs those at whole steps only.
        let every = if *method == Method::Euler { 2 } else { 1 };
        // Lanes without a segment repeat the first, and nothing of theirs is compared.
        let of = |lane: usize| segments.get(lane).copied().unwrap_or(segments[0]);
        let mut inputs = Vec::new();
        for half in (0..=2 * steps).step_by(every) {
            let lanes: Vec<Vec<f64>> = (0..LANES)
                .map(|lane| {
                    let at = half.min(2 * of(lane).steps) * width;
                    system.prepare_inputs(&of(lane).inputs[at..at + width])
                })
                .collect();
            inputs.extend(
                (0..lanes[0].len()).map(|input| std::array::from_fn(|lane| lanes[lane][input])),
            );
        }
        // A lane that has ended, or has no segment, is compared with NaN, which is never counted.
        let measured = |k: usize, channel: usize| -> LaneValues<LANES> {
            let own = |segment: &&TrialSegment| {
                segment.measured.get(k * plan.compared.len() + channel).copied()
            };
            std::array::from_fn(|lane| segments.get(lane).and_then(own).unwrap_or(f64::NAN))
        };
        let measured: Vec<[LaneValues<LANES>; 3]> = (0..steps / plan.stride)
            .map(|k| std::array::from_fn(|channel| measured(k, channel)))
            .collect();
        let compared = std::array::from_fn(|lane| {
            measured.iter().filter(|m| m[0][lane].is_finite()).count() as f64
        });
        Self {
            starts: (0..LANES).map(|lane| of(lane).start).collect(),
            inputs,
            steps,
            measured,
            compared,
        }
    }
}

impl SearchObjective {
    /// Returns the coefficients of parameters.
    pub fn coefficients_at(&self, parameters: &[f64]) -> Vec<f64> {
        self.source
            .iter()
            .zip(&self.sizes)
            .zip(parameters)
            .map(|((source, size), p)| source + size * p)
            .collect()
    }

    /// Returns the whole objective.
    pub fn cost(&self, sequences: &SubsequenceSet, parameters: &[f64]) -> f64 {
        let coefficients = self.coefficients_at(parameters);
        let (by_deviation, by_size) = self.weights;
        let mut cost = self.mean_error(sequences, &coefficients);
        if by_size > 0.0 {
            // Parameters in units of the box's half width: 1 is its edge.
            cost += by_size * parameters.iter().map(|p| p.abs()).sum::<f64>() / self.width;
        }
        if by_deviation > 0.0 {
            cost + by_deviation * self.deviation_penalty(&coefficients)
        } else {
            cost
        }
    }

    /// Returns the deviation penalty as a mean over the combinations.
    pub fn deviation_penalty(&self, coefficients: &[f64]) -> f64 {
        self.deviation.mean_penalty(&self.system, self.method, coefficients)
    }

    /// Returns the first part of the objective: the standardised squared error of u, v and r
    /// together, in the mean over time.
    pub fn mean_error(&self, sequences: &SubsequenceSet, coefficients: &[f64]) -> f64 {
        let mut run = CandidateRun::new(&self.system);
        let sum: f64 = sequences
            .blocks
            .iter()
            .map(|block| self.block_error(block, &mut run, coefficients))
            .sum();
        sum / sequences.count.max(1.0)
    }

    /// The sum of the squared errors of a block; comparisons after a lane has left the physical
    /// range count the fixed error `lost` in each of the three velocities.
    fn block_error(
        &self,
        block: &SequenceBlock,
        run: &mut CandidateRun<'_, LANES>,
        coefficients: &[f64],
    ) -> f64 {
        block.starts.iter().enumerate().for_each(|(lane, start)| run.start_lane(lane, start));
        // Values of one step, prepared inputs included.
        let width = block.inputs.len()
            / if self.method == Method::Euler { block.steps + 1 } else { 2 * block.steps + 1 };
        let at = |k: usize| &block.inputs[k * width..(k + 1) * width];
        let (mut sums, mut left, mut lost) = ([0.0; LANES], block.compared, [false; LANES]);
        for k in 0..block.steps {
            let inputs = match self.method {
                Method::Euler => [at(k); 3],
                Method::Rk4 => [at(2 * k), at(2 * k + 1), at(2 * k + 2)],
            };
            run.advance_step(self.method, self.plan.step_s, inputs, coefficients);
            if (k + 1) % self.plan.stride == 0 {
                self.add_comparison(
                    run,
                    &block.measured[(k + 1) / self.plan.stride - 1],
                    &mut sums,
                    &mut left,
                    &mut lost,
                );
                // Nothing more can be gained: remaining comparisons count the fixed error.
                if lost.iter().all(|lost| *lost) {
                    break;
                }
            }
        }
        sums.iter()
            .zip(&left)
            .map(|(sum, left)| sum + 3.0 * OBJECTIVE.lost * OBJECTIVE.lost * left)
            .sum()
    }

    /// Adds a comparison to the lanes that have not left the physical range; `left` are the
    /// comparisons that remain.
    fn add_comparison(
        &self,
        run: &CandidateRun<'_, LANES>,
        measured: &[LaneValues<LANES>; 3],
        sums: &mut LaneValues<LANES>,
        left: &mut LaneValues<LANES>,
        lost: &mut [bool; LANES],
    ) {
        let states = [run.state_lanes(0), run.state_lanes(1), run.state_lanes(2)];
        let (speed, turn) = (self.envelope.speed_m_s().powi(2), self.envelope.yaw_rate_rad_s());
        for lane in 0..LANES {
            let [u, v, r] = states.map(|state| state[lane]);
            // A value that is not a number counts as outside the range.
            lost[lane] |= !(u * u + v * v <= speed && r.abs() <= turn);
        }
        for lane in (0..LANES).filter(|lane| !lost[*lane] && measured[0][*lane].is_finite()) {
            left[lane] -= 1.0;
            for (channel, state) in states.iter().enumerate() {
                let difference =
                    (state[lane] - measured[channel][lane]) / self.plan.compared[channel].2;
                sums[lane] += difference * difference;
            }
        }
    }
}
