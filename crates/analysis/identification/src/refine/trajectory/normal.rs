//! Simulation of all segments: residuals, and the normal equations of the coefficients.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use sistership_simulation::sensitivity::{SensitiveRun, SensitiveSystem};
use sistership_simulation::{Method, MotionEnvelope};

use super::segments::{ComparisonPlan, TrialSegment, state_difference};
use super::thresholds::TRAJECTORY;

/// Segments that are simulated in lockstep.
const LANES: usize = 8;
/// Rows of sensitivities that are collected before they are multiplied.
const ROWS: usize = 96;
/// Columns of the Hessian that are multiplied together.
const COLUMNS: usize = 48;
/// Blocks of lanes that are simulated before their sums are added: a lane holds a Hessian until
/// then. More threads than this have no work; it is a constant, so that the memory of a fit does
/// not depend on the machine.
const BLOCKS: usize = 16;

/// Sums over the residuals of some segments.
#[derive(Debug, Clone)]
pub(super) struct NormalEquations {
    /// Sum of squared sensitivities with Huber's weights.
    pub hessian: DMatrix<f64>,
    /// Sum of sensitivities times residuals.
    pub gradient: DVector<f64>,
    /// Sum of twice Huber's function (squares near zero).
    pub cost: f64,
    /// Number of times at which residuals are taken.
    pub count: f64,
}

/// Sums by trial, and gradients by segment for the standard errors.
pub(super) struct SegmentSums {
    pub trials: Vec<NormalEquations>,
    pub gradients: Vec<DVector<f64>>,
}

impl NormalEquations {
    pub fn zeros(size: usize) -> Self {
        Self {
            hessian: DMatrix::zeros(size, size),
            gradient: DVector::zeros(size),
            cost: 0.0,
            count: 0.0,
        }
    }

    /// Changes the unknowns to others, by whose change each of the former changes by its slope.
    fn rescale(&mut self, slopes: &DVector<f64>) {
        self.hessian
            .column_iter_mut()
            .zip(slopes.iter())
            .for_each(|(mut column, slope)| column.component_mul_assign(&(slopes * *slope)));
        self.gradient.component_mul_assign(slopes);
    }

    pub fn add(&mut self, other: &Self) {
        self.hessian += &other.hessian;
        self.gradient += &other.gradient;
        self.cost += other.cost;
        self.count += other.count;
    }
}

impl SegmentSums {
    /// Changes the unknowns to others, by whose change each of the former changes by its slope.
    pub fn rescale(&mut self, slopes: &DVector<f64>) {
        self.trials.iter_mut().for_each(|normal| normal.rescale(slopes));
        self.gradients.iter_mut().for_each(|gradient| gradient.component_mul_assign(slopes));
    }
}

/// Inputs of a simulation of all segments besides the system.
pub(super) struct SegmentSimulation<'a> {
    pub segments: &'a [TrialSegment],
    pub plan: &'a ComparisonPlan,
    pub envelope: MotionEnvelope,
    /// Huber's thresholds by compared state, in standard deviations.
    pub thresholds: Vec<f64>,
    pub trials: usize,
}

impl SegmentSimulation<'_> {
    /// Simulates every segment. Sums are added in the segments' order, so that the size of batches
    /// affects only the memory.
    pub fn simulate_segments(&self, system: &SensitiveSystem) -> SegmentSums {
        let size = system.names().len();
        let mut pass = SegmentSums {
            trials: vec![NormalEquations::zeros(size); self.trials],
            gradients: Vec::new(),
        };
        for batch in self.segments.chunks(LANES * BLOCKS) {
            // Parallel over blocks of lanes; `collect` keeps their order.
            let blocks: Vec<Vec<LaneSums>> =
                batch.par_chunks(LANES).map(|block| self.simulate_block(system, block)).collect();
            for (segment, lane) in batch.iter().zip(blocks.into_iter().flatten()) {
                pass.trials[segment.trial].add(&lane.normal);
                pass.gradients.push(lane.normal.gradient);
            }
        }
        pass.trials
            .iter_mut()
            .for_each(|normal| normal.hessian.fill_upper_triangle_with_lower_triangle());
        pass
    }

    /// Returns the absolute residuals by compared state, of every `some`th block of segments.
    pub fn residual_sizes(&self, system: &SensitiveSystem, some: usize) -> Vec<Vec<f64>> {
        let blocks: Vec<&[TrialSegment]> = self.segments.chunks(LANES).step_by(some).collect();
        let of_block = |block: &[TrialSegment]| {
            self.simulate_block(system, block).into_iter().map(|lane| lane.sizes).collect()
        };
        let lanes: Vec<Vec<Vec<Vec<f64>>>> = blocks.into_par_iter().map(of_block).collect();
        let mut sizes = vec![Vec::new(); self.plan.compared.len()];
        for lane in lanes.into_iter().flatten() {
            sizes.iter_mut().zip(lane).for_each(|(all, own)| all.extend(own));
        }
        sizes
    }

    /// Simulates up to `LANES` segments in lockstep.
    fn simulate_block(&self, system: &SensitiveSystem, block: &[TrialSegment]) -> Vec<LaneSums> {
        let size = system.names().len();
        let mut run = SensitiveRun::<LANES>::new(system);
        let mut lanes: Vec<LaneSums> =
            block.iter().map(|_| LaneSums::new(size, self.plan.compared.len())).collect();
        block.iter().enumerate().for_each(|(lane, segment)| run.start(lane, &segment.start));
        // Lanes without a segment repeat the first.
        (block.len()..LANES).for_each(|lane| run.start(lane, &block[0].start));
        let width = system.input_names().len();
        let mut inputs =
            [vec![[0.0; LANES]; width], vec![[0.0; LANES]; width], vec![[0.0; LANES]; width]];
        // Segments are sorted by length: the first one of a block is its longest.
        for k in 0..block[0].steps {
            for (half, given) in inputs.iter_mut().enumerate() {
                // The classical Runge-Kutta method reads inputs at the beginning, middle and end of
                // a step.
                load_inputs(block, 2 * k + half, width, given);
            }
            run.advance_step(Method::Rk4, self.plan.step_s, [&inputs[0], &inputs[1], &inputs[2]]);
            if (k + 1) % self.plan.stride == 0 {
                // A lane whose segment has ended is simulated on, but no longer compared.
                let due = lanes
                    .iter_mut()
                    .zip(block)
                    .enumerate()
                    .filter(|(_, (_, segment))| k < segment.steps);
                due.for_each(|(lane, (own, segment))| {
                    let residual = (k + 1) / self.plan.stride - 1;
                    self.add_residuals((system, &run), lane, own, segment, residual)
                });
            }
        }
        lanes.iter_mut().for_each(LaneSums::flush);
        lanes
    }

    /// Adds a lane's residuals at a time.
    fn add_residuals(
        &self,
        (system, run): (&SensitiveSystem, &SensitiveRun<'_, LANES>),
        lane: usize,
        own: &mut LaneSums,
        segment: &TrialSegment,
        residual: usize,
    ) {
        let state = run.state(lane);
        own.normal.count += 1.0;
        // A lane that left the physical range once stays lost: its later residuals count a fixed
        // cost and no gradient.
        own.lost = own.lost || self.envelope.check_state(0.0, &state).is_err();
        let width = self.plan.compared.len();
        let measured = &segment.measured[residual * width..(residual + 1) * width];
        for (index, (&(row, place, deviation), measured)) in
            self.plan.compared.iter().zip(measured).enumerate()
        {
            // A channel that the trial lacks has no residual.
            if !measured.is_finite() {
                continue;
            }
            if own.lost {
                own.normal.cost += TRAJECTORY.lost * TRAJECTORY.lost;
                continue;
            }
            let value = state_difference(place, state[place], *measured) / deviation;
            own.sizes[index].push(value.abs());
            system.gather_sensitivities(run.state_sensitivities(lane, row), &mut own.gathered);
            own.add_residual(value, deviation, self.thresholds[index]);
        }
    }
}

/// Loads the inputs of each lane at a half step; a lane that has ended keeps its last.
fn load_inputs(block: &[TrialSegment], half_step: usize, width: usize, into: &mut [[f64; LANES]]) {
    for lane in 0..LANES {
        let segment = block.get(lane).unwrap_or(&block[0]);
        let at = half_step.min(2 * segment.steps) * width;
        into.iter_mut()
            .zip(&segment.inputs[at..at + width])
            .for_each(|(lanes, value)| lanes[lane] = *value);
    }
}

/// Sums of one lane, with rows that wait to be multiplied together.
struct LaneSums {
    normal: NormalEquations,
    /// Sensitivities of the state that is compared.
    gathered: Vec<f64>,
    rows: DMatrix<f64>,
    waiting: usize,
    lost: bool,
    sizes: Vec<Vec<f64>>,
}

impl LaneSums {
    fn new(size: usize, compared: usize) -> Self {
        let sizes = vec![Vec::new(); compared];
        Self {
            normal: NormalEquations::zeros(size),
            gathered: vec![0.0; size],
            rows: DMatrix::zeros(size, ROWS),
            waiting: 0,
            lost: false,
            sizes,
        }
    }

    /// Adds one residual in standard deviations with the gathered sensitivities, weighted as by
    /// Huber.
    fn add_residual(&mut self, value: f64, deviation: f64, threshold: f64) {
        let size = value.abs();
        let weight = if size <= threshold { 1.0 } else { threshold / size };
        self.normal.cost +=
            if size <= threshold { size * size } else { threshold * (2.0 * size - threshold) };
        // Rows have the root of the weight, so that their products have the weight once.
        let factor = weight.sqrt() / deviation;
        let mut row = self.rows.column_mut(self.waiting);
        row.iter_mut().zip(&self.gathered).for_each(|(out, s)| *out = factor * s);
        self.normal.gradient.axpy(weight.sqrt() * value, &row, 1.0);
        self.waiting += 1;
        if self.waiting == ROWS {
            self.flush();
        }
    }

    /// Multiplies the waiting rows into the Hessian: its lower triangle, and the part of the upper
    /// one that shares the columns of a panel.
    fn flush(&mut self) {
        let (rows, size) = (self.rows.columns(0, self.waiting), self.rows.nrows());
        for from in (0..size).step_by(COLUMNS) {
            let width = COLUMNS.min(size - from);
            // Each panel starts at the diagonal and reaches to the last row.
            let mut part = self.normal.hessian.view_mut((from, from), (size - from, width));
            part.gemm(1.0, &rows.rows(from, size - from), &rows.rows(from, width).transpose(), 1.0);
        }
        self.waiting = 0;
    }
}
