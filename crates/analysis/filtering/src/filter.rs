//! The Kalman filter along a linearised trial, with every column in lockstep.
//!
//! Readings are taken one channel after the other (their noises are independent), so that each
//! prediction error is divided by its own predicted deviation and nothing is inverted: Maybeck
//! 1979, Stochastic models, estimation and control, vol. 1, section 7.

use sistership_model::uncertainty::Discrepancy;

use super::gram::Gram;
use super::linearised::Linearised;
use super::noise::Noise;
use super::thresholds::RESIDUAL;
use sistership_simulation::wide::{Wide, widest};

/// The discrepancy of each acceleration, in the order of the filter's axes.
pub type Discrepancies = Vec<Discrepancy>;

/// Whitened residual and columns of a part of a trial, added up.
pub fn filter(linear: &Linearised, noise: &Noise, discrepancies: &Discrepancies) -> Gram {
    filter_first(linear, linear.sizes.columns, noise, discrepancies)
}

/// The same of the first columns alone.
pub fn filter_first(
    linear: &Linearised,
    columns: usize,
    noise: &Noise,
    discrepancies: &Discrepancies,
) -> Gram {
    let (rows, log_variance) = whitened_first(linear, columns, noise, discrepancies);
    Gram::of_rows(&rows, 1 + columns, log_variance)
}

/// Prediction errors of parts with all columns in one ([`Linearised::along`]), divided by the
/// predicted deviation, sample after sample and in each by recorded channel; and the sum of the
/// logarithms of the predicted variances.
pub fn errors(
    linear: &Linearised,
    noise: &Noise,
    discrepancies: &Discrepancies,
) -> (Vec<f64>, f64) {
    let (rows, log_variance) = whitened(linear, noise, discrepancies);
    (rows.chunks_exact(2).map(|row| row[0] - row[1]).collect(), log_variance)
}

/// What the one column of [`Linearised::along`] takes from the prediction errors, in the same
/// order.
pub fn responses(linear: &Linearised, noise: &Noise, discrepancies: &Discrepancies) -> Vec<f64> {
    whitened(linear, noise, discrepancies).0.chunks_exact(2).map(|row| row[1]).collect()
}

/// Prediction errors and what each column adds to them, divided by the predicted deviation: for
/// each sample and recorded channel a row, the residual first; and the sum of the logarithms of the
/// predicted variances.
pub fn whitened(
    linear: &Linearised,
    noise: &Noise,
    discrepancies: &Discrepancies,
) -> (Vec<f64>, f64) {
    whitened_first(linear, linear.sizes.columns, noise, discrepancies)
}

fn whitened_first(
    linear: &Linearised,
    columns: usize,
    noise: &Noise,
    discrepancies: &Discrepancies,
) -> (Vec<f64>, f64) {
    let width = 1 + columns;
    let mut white = Whitened { rows: Vec::new(), log_variance: 0.0 };
    white.rows.reserve_exact(linear.reading.len() * width);
    widest(Whitening { linear, noise, discrepancies, width, white: &mut white });
    (white.rows, white.log_variance)
}

struct Whitened {
    rows: Vec<f64>,
    log_variance: f64,
}

/// A part of a trial to be whitened.
struct Whitening<'a> {
    linear: &'a Linearised,
    noise: &'a Noise,
    discrepancies: &'a Discrepancies,
    width: usize,
    white: &'a mut Whitened,
}

impl Wide for Whitening<'_> {
    #[inline(always)]
    fn go(self) {
        let Self { linear, noise, discrepancies, width, white } = self;
        let mut state = FilterState::start(linear, noise, discrepancies, width);
        for k in 0..linear.samples.len() {
            if k > 0 {
                state.predict(linear, k - 1, discrepancies);
            }
            if !k.is_multiple_of(linear.every) {
                continue;
            }
            state.update(linear, k, noise, |error, variance| {
                let scale = variance.sqrt().recip();
                white.rows.push(error[0] * scale);
                // An error that a column makes is what its parameter takes away.
                white.rows.extend(error[1..].iter().map(|e| -e * scale));
                white.log_variance += variance.ln();
            });
        }
    }
}

/// Deviation from the path with all its columns, and its covariance.
pub(super) struct FilterState {
    /// Number of states with discrepancies.
    pub order: usize,
    width: usize,
    /// `order` by `width`, row by row; the residual's first, then what each column moves.
    pub deviations: Vec<f64>,
    /// `order` by `order`.
    pub covariance: Vec<f64>,
    /// What each state drifts, by its variance in a second.
    pub drift: Vec<f64>,
    pub transition: Vec<f64>,
    /// Its transpose, along whose rows products with it are summed in wide instructions.
    transposed: Vec<f64>,
    /// `dt (I + A dt/2)` on the accelerations: states by axes.
    half: Vec<f64>,
    square: Vec<f64>,
    room: Vec<f64>,
    error: Vec<f64>,
    gain: Vec<f64>,
}

impl FilterState {
    pub fn start(
        linear: &Linearised,
        noise: &Noise,
        discrepancies: &Discrepancies,
        width: usize,
    ) -> Self {
        let states = linear.sizes.states;
        let order = states + linear.sizes.axes;
        let mut drift = vec![0.0; states];
        let mut covariance = vec![0.0; order * order];
        for state in 0..states {
            let channel = linear
                .channels
                .iter()
                .find(|(_, place)| *place == state)
                .and_then(|(channel, _)| noise.get(channel));
            drift[state] =
                channel.map_or(RESIDUAL.unread_drift, |instrument| instrument.drift).powi(2);
            // What nobody reads starts on the path.
            covariance[state * order + state] = channel
                .map_or(RESIDUAL.unread_variance, |instrument| {
                    (RESIDUAL.start * instrument.deviation).powi(2)
                });
        }
        for (axis, discrepancy) in discrepancies.iter().enumerate() {
            covariance[(states + axis) * (order + 1)] = discrepancy.deviation.powi(2);
        }
        Self {
            order,
            width,
            deviations: vec![0.0; order * width],
            covariance,
            drift,
            transition: vec![0.0; order * order],
            transposed: vec![0.0; order * order],
            half: vec![0.0; states * linear.sizes.axes],
            square: Vec::new(),
            room: Vec::new(),
            error: Vec::new(),
            gain: Vec::new(),
        }
    }

    #[inline(always)]
    pub fn predict(&mut self, linear: &Linearised, k: usize, discrepancies: &Discrepancies) {
        let dt = linear.t_s[k + 1] - linear.t_s[k];
        self.transit(linear, k, dt, discrepancies);
        let Self { order, width, .. } = *self;
        multiply(&self.transition, &self.deviations, order, order, width, &mut self.room);
        self.force(linear, k, dt);
        std::mem::swap(&mut self.deviations, &mut self.room);
        multiply(&self.transition, &self.covariance, order, order, order, &mut self.room);
        multiply_symmetric(&self.room, &self.transposed, order, &mut self.covariance);
        for (state, drift) in self.drift.iter().enumerate() {
            self.covariance[state * (order + 1)] += drift * dt;
        }
        for (axis, discrepancy) in discrepancies.iter().enumerate() {
            self.covariance[axis * (order + 1)] += dt * discrepancy.white.powi(2);
            let renewed = 1.0 - (-2.0 * dt / discrepancy.time_s).exp();
            self.covariance[(linear.sizes.states + axis) * (order + 1)] +=
                renewed * discrepancy.deviation.powi(2);
        }
    }

    /// Fills the transition matrix to second order in the step, and `half`.
    #[inline(always)]
    fn transit(&mut self, linear: &Linearised, k: usize, dt: f64, discrepancies: &Discrepancies) {
        let (n, axes, order) = (linear.sizes.states, linear.sizes.axes, self.order);
        let a = &linear.jacobian[k * n * n..(k + 1) * n * n];
        let (square, half) = (&mut self.square, &mut self.half);
        multiply(a, a, n, n, n, square);
        self.transition.fill(0.0);
        for row in 0..n {
            for column in 0..n {
                let unit = f64::from(u8::from(row == column));
                let at = row * n + column;
                self.transition[row * order + column] =
                    unit + dt * a[at] + 0.5 * dt * dt * square[at];
                if column < axes {
                    half[row * axes + column] = dt * (unit + 0.5 * dt * a[at]);
                    self.transition[row * order + n + column] = half[row * axes + column];
                }
            }
        }
        for (axis, discrepancy) in discrepancies.iter().enumerate() {
            self.transition[(n + axis) * (order + 1)] = (-dt / discrepancy.time_s).exp();
        }
        for row in 0..order {
            for column in 0..order {
                self.transposed[column * order + row] = self.transition[row * order + column];
            }
        }
    }

    /// Adds to the predicted deviations (in `room`) what the model moves more than the path, and
    /// what columns move.
    #[inline(always)]
    fn force(&mut self, linear: &Linearised, k: usize, dt: f64) {
        let (n, axes, columns) = (linear.sizes.states, linear.sizes.axes, linear.sizes.columns);
        let g = &linear.accelerations[k * axes * columns..(k + 1) * axes * columns];
        debug_assert!(dt > 0.0);
        for row in 0..n {
            let target = &mut self.room[row * self.width..(row + 1) * self.width];
            target[0] += linear.defect[k * n + row];
            if self.width == 1 {
                continue;
            }
            for axis in 0..axes {
                let weight = self.half[row * axes + axis];
                if weight != 0.0 {
                    axpy(weight, &g[axis * columns..(axis + 1) * columns], &mut target[1..]);
                }
            }
        }
    }

    /// Takes the readings of a sample; `take` is given each prediction error (the residual's, then
    /// minus each column's) and its variance.
    #[inline(always)]
    pub fn update(
        &mut self,
        linear: &Linearised,
        k: usize,
        noise: &Noise,
        mut take: impl FnMut(&[f64], f64),
    ) {
        let (order, width) = (self.order, self.width);
        for (i, &(channel, place)) in linear.channels.iter().enumerate() {
            let row = linear.by_state.as_ref().map(|by| {
                &by[(k * linear.channels.len() + i) * linear.sizes.states..][..linear.sizes.states]
            });
            self.error.clear();
            self.error.resize(width, 0.0);
            self.error[0] = linear.reading[k * linear.channels.len() + i];
            self.by_columns(linear, k, i);
            self.by_rates(linear, k, i);
            self.gain.clear();
            self.gain.resize(order, 0.0);
            let one = [1.0];
            let (from, weights): (usize, &[f64]) = row.map_or((place, &one), |row| (0, row));
            for (state, &weight) in weights.iter().enumerate().filter(|(_, weight)| **weight != 0.0)
            {
                let state = from + state;
                axpy(
                    -weight,
                    &self.deviations[state * width..(state + 1) * width],
                    &mut self.error,
                );
                axpy(weight, &self.covariance[state * order..(state + 1) * order], &mut self.gain);
            }
            let sigma = noise.get(&channel).map_or(1.0, |instrument| instrument.deviation);
            let own: f64 = weights
                .iter()
                .enumerate()
                .map(|(state, weight)| weight * self.gain[from + state])
                .sum();
            let variance = own + sigma * sigma;
            take(&self.error, variance);
            for state in 0..order {
                let gain = self.gain[state] / variance;
                axpy(gain, &self.error, &mut self.deviations[state * width..(state + 1) * width]);
                let (gains, covariance) =
                    (&self.gain, &mut self.covariance[state * order..(state + 1) * order]);
                axpy(-gain, gains, covariance);
            }
        }
    }

    /// What columns make the instruments say more counts against the prediction error.
    #[inline(always)]
    fn by_columns(&mut self, linear: &Linearised, k: usize, channel: usize) {
        if self.width == 1 || linear.measured.is_empty() {
            return;
        }
        let width = linear.measured.len();
        let row = &linear.by_column[(k * linear.channels.len() + channel) * width..][..width];
        for (&column, value) in linear.measured.iter().zip(row) {
            if let Some(error) = self.error.get_mut(1 + column) {
                *error -= value;
            }
        }
    }

    /// Where instruments follow rates, these are those of the state that is expected.
    #[inline(always)]
    fn by_rates(&mut self, linear: &Linearised, k: usize, channel: usize) {
        for response in linear.by_rate.iter().filter(|response| response.channel == channel) {
            let faster = self.faster(linear, k, response.state);
            let place = response.column.map_or(0, |column| 1 + column);
            if let Some(error) = self.error.get_mut(place) {
                *error -= response.by[k] * faster;
            }
        }
    }

    /// By how much the model has a state change faster where the filter expects the ship than on
    /// the path. The discrepancy stays out: where it is not what the filter takes it for, its
    /// estimate runs after the readings, and their prediction errors go with it.
    #[inline(always)]
    fn faster(&self, linear: &Linearised, k: usize, state: usize) -> f64 {
        let n = linear.sizes.states;
        let interval = k.min(linear.samples.len().saturating_sub(2));
        let row = &linear.jacobian[(interval * n + state) * n..][..n];
        let expected = |state: usize| self.deviations[state * self.width];
        row.iter().enumerate().map(|(state, slope)| slope * expected(state)).sum()
    }
}

#[inline(always)]
fn axpy(weight: f64, from: &[f64], to: &mut [f64]) {
    for (to, from) in to.iter_mut().zip(from) {
        *to += weight * from;
    }
}

/// `left (rows x inner) right (inner x columns)`, row by row.
#[inline(always)]
fn multiply(
    left: &[f64],
    right: &[f64],
    rows: usize,
    inner: usize,
    columns: usize,
    out: &mut Vec<f64>,
) {
    out.clear();
    out.resize(rows * columns, 0.0);
    for row in 0..rows {
        let target = &mut out[row * columns..(row + 1) * columns];
        for i in 0..inner {
            let weight = left[row * inner + i];
            if weight != 0.0 {
                axpy(weight, &right[i * columns..(i + 1) * columns], target);
            }
        }
    }
}

/// `left right'` of square matrices, made exactly symmetric; `transposed` is `right'`.
#[inline(always)]
fn multiply_symmetric(left: &[f64], transposed: &[f64], order: usize, out: &mut [f64]) {
    for row in 0..order {
        let target = &mut out[row * order..][..row + 1];
        // What sums of floating-point numbers begin with: it leaves the sign of the first.
        target.fill(-0.0);
        for i in 0..order {
            axpy(left[row * order + i], &transposed[i * order..][..row + 1], target);
        }
    }
    for row in 0..order {
        for column in 0..row {
            out[column * order + row] = out[row * order + column];
        }
    }
}
