//! Transition of deviations and discrepancies from a sample to the next.

use nalgebra::DMatrix;

use super::filter_noise::FilterNoise;
use super::filter_value::FilterValue;
use super::linearised::LinearisedPart;

/// Transition matrix of an interval, to second order in its time: rows of states over states and
/// discrepancies; a discrepancy depends on itself alone.
pub(super) struct TransitionMatrix<V> {
    states: usize,
    axes: usize,
    /// States by states and discrepancies.
    rows: Vec<V>,
    /// The transpose, along whose rows products are summed in wide instructions.
    columns: Vec<V>,
    /// `dt (I + A dt/2)` on the accelerations: states by axes.
    caused: Vec<V>,
    /// Share of each axis' discrepancy that remains.
    kept: Vec<V>,
    /// Share of its variance that is renewed.
    renewed: Vec<V>,
    square: Vec<V>,
    gathered: Vec<V>,
    dt: V,
}

impl<V: FilterValue> TransitionMatrix<V> {
    pub fn new(states: usize, axes: usize) -> Self {
        let zeros = |count: usize| vec![V::splat(0.0); count];
        Self {
            states,
            axes,
            rows: zeros(states * (states + axes)),
            columns: zeros((states + axes) * states),
            caused: zeros(states * axes),
            kept: zeros(axes),
            renewed: zeros(axes),
            square: zeros(states),
            gathered: Vec::new(),
            // Not a number, so that the first interval always differs.
            dt: V::splat(f64::NAN),
        }
    }

    /// Sets the transition to that from sample `k` to the next; a part that has ended stays in its
    /// last interval.
    #[inline(always)]
    pub fn set_interval(&mut self, parts: &[&LinearisedPart], k: usize, noise: &FilterNoise) {
        self.set_times(parts, k, noise);
        let Self { states, axes, rows, columns, caused, square, gathered, dt, .. } = self;
        let (n, axes, dt) = (*states, *axes, *dt);
        let order = n + axes;
        let jacobian = V::lane_row(
            parts,
            |_, part| &part.jacobian[interval_index(part, k) * n * n..][..n * n],
            gathered,
        );
        // F = I + A dt + A^2 dt^2/2 for the states, and dt (I + A dt/2) for the accelerations,
        // which are the rates of the first states.
        let half = V::splat(0.5);
        for row in 0..n {
            let slopes = &jacobian[row * n..][..n];
            V::weighted_sum(slopes, jacobian, n, square);
            for column in 0..n {
                let unit = V::splat(f64::from(u8::from(row == column)));
                let mut value = unit;
                value.add_product(dt, slopes[column]);
                value.add_product(half * dt * dt, square[column]);
                rows[row * order + column] = value;
                columns[column * n + row] = value;
            }
            for axis in 0..axes {
                let mut by = V::splat(f64::from(u8::from(row == axis)));
                by.add_product(half * dt, slopes[axis]);
                let by = dt * by;
                caused[row * axes + axis] = by;
                rows[row * order + n + axis] = by;
                columns[(n + axis) * n + row] = by;
            }
        }
    }

    /// Sets the times of the intervals, and the values that follow from them where they changed.
    #[inline(always)]
    fn set_times(&mut self, parts: &[&LinearisedPart], k: usize, noise: &FilterNoise) {
        for (lane, part) in parts.iter().enumerate() {
            let from = interval_index(part, k);
            let dt = part.t_s[from + 1] - part.t_s[from];
            let known = self.dt.lane_mut(lane);
            // Bitwise comparison: intervals are usually equal, and exponentials are costly.
            if dt.to_bits() == known.to_bits() {
                continue;
            }
            *known = dt;
            for (axis, discrepancy) in noise.discrepancies().iter().enumerate() {
                *self.kept[axis].lane_mut(lane) = (-dt / discrepancy.time_s).exp();
                *self.renewed[axis].lane_mut(lane) = 1.0 - (-2.0 * dt / discrepancy.time_s).exp();
            }
        }
    }

    /// Row of a state over states and discrepancies.
    #[inline(always)]
    pub fn state_row(&self, state: usize) -> &[V] {
        let order = self.states + self.axes;
        &self.rows[state * order..][..order]
    }

    /// Transposed matrix: for each state and discrepancy, its share in each state.
    #[inline(always)]
    pub fn transposed_rows(&self) -> &[V] {
        &self.columns
    }

    /// Movement of a state by each acceleration.
    #[inline(always)]
    pub fn acceleration_weights(&self, state: usize) -> &[V] {
        &self.caused[state * self.axes..][..self.axes]
    }

    /// Share of each discrepancy that remains.
    #[inline(always)]
    pub fn kept_shares(&self) -> &[V] {
        &self.kept
    }

    /// Share of the variance of each discrepancy that is renewed.
    #[inline(always)]
    pub fn renewed_shares(&self) -> &[V] {
        &self.renewed
    }

    /// Time of the interval, s.
    #[inline(always)]
    pub fn interval_s(&self) -> V {
        self.dt
    }
}

impl TransitionMatrix<f64> {
    /// Full transition matrix over states and discrepancies.
    pub fn matrix(&self) -> DMatrix<f64> {
        let (n, order) = (self.states, self.states + self.axes);
        DMatrix::from_fn(order, order, |row, column| match row.checked_sub(n) {
            None => self.rows[row * order + column],
            Some(axis) if row == column => self.kept[axis],
            Some(_) => 0.0,
        })
    }
}

/// Index of the interval of a part that begins with sample `k`, or of its last.
#[inline(always)]
fn interval_index(part: &LinearisedPart, k: usize) -> usize {
    k.min(part.samples.len().saturating_sub(2))
}
