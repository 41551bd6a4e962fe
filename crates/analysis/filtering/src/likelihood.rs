//! How improbable parts of trials are, several of them in lockstep.
//!
//! The same filter as [`super::filter`] with one column, a part in each lane: the numbers are those
//! of one part after the other to the last bit, for every lane does the same operations in the same
//! order.

use rayon::prelude::*;
use sistership_simulation::wide::{Wide, widest};

use super::filter::{Discrepancies, FilterState, errors};
use super::linearised::Linearised;
use super::noise::Noise;

/// Parts in lockstep: one vector of doubles of AVX2. With twice as many, most would wait for the
/// longest, and the six trials of many a ship would be one task.
const LANES: usize = 4;

type Lane = [f64; LANES];

/// Minus twice the logarithm of the likelihood of each part, less a constant; parts have all
/// columns in one ([`Linearised::along`]).
pub fn deviances(parts: &[&Linearised], noise: &Noise, discrepancies: &Discrepancies) -> Vec<f64> {
    let mut order: Vec<usize> = (0..parts.len()).collect();
    // Parts of one shape go together, those of like length first.
    let moves = |part: &Linearised| part.samples.len() > 1;
    let shape = |place: &usize| {
        let part = parts[*place];
        let channels: Vec<usize> = part.channels.iter().map(|(_, state)| *state).collect();
        (moves(part), part.by_state.is_some(), part.sizes.states, part.every, channels)
    };
    order.sort_by_cached_key(|place| (shape(place), usize::MAX - parts[*place].samples.len()));
    let alike = order.chunk_by(|a, b| {
        let (a, b) = (parts[*a], parts[*b]);
        moves(a)
            && moves(b)
            && a.by_state.is_some() == b.by_state.is_some()
            && (a.sizes, a.every, &a.channels) == (b.sizes, b.every, &b.channels)
    });
    let together: Vec<&[usize]> = alike.flat_map(|alike| alike.chunks(LANES)).collect();
    let of = |places: &&[usize]| {
        let each: Vec<&Linearised> = places.iter().map(|place| parts[*place]).collect();
        let found = match each[..] {
            [only] => vec![alone(only, noise, discrepancies)],
            _ => in_lanes(&each, noise, discrepancies),
        };
        places.iter().copied().zip(found).collect::<Vec<_>>()
    };
    let mut all = vec![0.0; parts.len()];
    let found: Vec<Vec<(usize, f64)>> = together.par_iter().map(of).collect();
    found.into_iter().flatten().for_each(|(place, deviance)| all[place] = deviance);
    all
}

fn alone(part: &Linearised, noise: &Noise, discrepancies: &Discrepancies) -> f64 {
    let (errors, log_variance) = errors(part, noise, discrepancies);
    errors.iter().map(|error| error * error).sum::<f64>() + log_variance
}

fn in_lanes(parts: &[&Linearised], noise: &Noise, discrepancies: &Discrepancies) -> Vec<f64> {
    let mut filter = LaneFilter::new(parts, noise, discrepancies);
    widest(Filtering { filter: &mut filter, noise, discrepancies });
    (0..parts.len()).map(|lane| filter.squares[lane] + filter.log_variance[lane]).collect()
}

struct Filtering<'a, 'p> {
    filter: &'a mut LaneFilter<'p>,
    noise: &'a Noise,
    discrepancies: &'a Discrepancies,
}

impl Wide for Filtering<'_, '_> {
    #[inline(always)]
    fn go(self) {
        let Self { filter, noise, discrepancies } = self;
        let longest = filter.parts.iter().map(|part| part.samples.len()).max().unwrap_or(0);
        for k in 0..longest {
            if k > 0 {
                filter.predict(k - 1, discrepancies);
            }
            if k.is_multiple_of(filter.parts[0].every) {
                filter.update(k, noise);
            }
        }
    }
}

/// The filters of some parts; matrices row by row, every number once for each lane.
struct LaneFilter<'p> {
    parts: &'p [&'p Linearised],
    states: usize,
    axes: usize,
    order: usize,
    /// What each state drifts, by its variance in a second: the same for all parts.
    drift: Vec<f64>,
    /// Residual and column of each state.
    deviations: Vec<[Lane; 2]>,
    covariance: Vec<Lane>,
    jacobian: Vec<Lane>,
    transition: Vec<Lane>,
    half: Vec<Lane>,
    moved: Vec<[Lane; 2]>,
    room: Vec<Lane>,
    gain: Vec<Lane>,
    dt: Lane,
    /// Of each axis, how much of its discrepancy stays over `dt`, and how much is renewed.
    kept: Vec<[Lane; 2]>,
    squares: Lane,
    log_variance: Lane,
}

impl<'p> LaneFilter<'p> {
    fn new(parts: &'p [&'p Linearised], noise: &Noise, discrepancies: &Discrepancies) -> Self {
        let (states, axes) = (parts[0].sizes.states, parts[0].sizes.axes);
        let first = FilterState::start(parts[0], noise, discrepancies, 2);
        let order = first.order;
        Self {
            parts,
            states,
            axes,
            order,
            deviations: vec![[[0.0; LANES]; 2]; order],
            covariance: first.covariance.iter().map(|value| [*value; LANES]).collect(),
            drift: first.drift,
            jacobian: vec![[0.0; LANES]; states * states],
            transition: vec![[0.0; LANES]; states * order],
            half: vec![[0.0; LANES]; states * axes],
            moved: vec![[[0.0; LANES]; 2]; order],
            room: vec![[0.0; LANES]; order * order],
            gain: vec![[0.0; LANES]; order],
            dt: [f64::NAN; LANES],
            kept: vec![[[0.0; LANES]; 2]; axes],
            // What sums of floating-point numbers begin with.
            squares: [-0.0; LANES],
            log_variance: [0.0; LANES],
        }
    }

    /// The sample of each lane; a part that is over stays at its last.
    #[inline(always)]
    fn samples(&self, k: usize, last: usize) -> [usize; LANES] {
        std::array::from_fn(|lane| {
            self.parts.get(lane).map_or(0, |part| k.min(part.samples.len().saturating_sub(last)))
        })
    }

    #[inline(always)]
    fn predict(&mut self, k: usize, discrepancies: &Discrepancies) {
        let at = self.samples(k, 2);
        self.take_times(&at, discrepancies);
        self.transit(&at);
        self.move_deviations(&at);
        self.spread(discrepancies);
    }

    /// Times to the next samples, with what follows from them where they are others than before.
    #[inline(always)]
    fn take_times(&mut self, at: &[usize; LANES], discrepancies: &Discrepancies) {
        for (lane, part) in self.parts.iter().enumerate() {
            let from = at[lane];
            let dt = part.t_s.get(from + 1).map_or(0.0, |next| next - part.t_s[from]);
            if dt.to_bits() == self.dt[lane].to_bits() {
                continue;
            }
            self.dt[lane] = dt;
            for (kept, discrepancy) in self.kept.iter_mut().zip(discrepancies) {
                kept[0][lane] = (-dt / discrepancy.time_s).exp();
                kept[1][lane] = 1.0 - (-2.0 * dt / discrepancy.time_s).exp();
            }
        }
    }

    /// The rows of the states in the transition matrix, to second order in the step, and `half`.
    #[inline(always)]
    fn transit(&mut self, at: &[usize; LANES]) {
        let (n, axes, order) = (self.states, self.axes, self.order);
        for (lane, part) in self.parts.iter().enumerate() {
            let a = &part.jacobian[at[lane] * n * n..][..n * n];
            self.jacobian.iter_mut().zip(a).for_each(|(to, from)| to[lane] = *from);
        }
        let dt = self.dt;
        for row in 0..n {
            for column in 0..n {
                let mut square = [0.0; LANES];
                for i in 0..n {
                    let (a, b) = (&self.jacobian[row * n + i], &self.jacobian[i * n + column]);
                    (0..LANES).for_each(|l| square[l] += a[l] * b[l]);
                }
                let unit = f64::from(u8::from(row == column));
                let a = &self.jacobian[row * n + column];
                let to = &mut self.transition[row * order + column];
                for l in 0..LANES {
                    to[l] = unit + dt[l] * a[l] + 0.5 * dt[l] * dt[l] * square[l];
                }
                if column < axes {
                    let half = &mut self.half[row * axes + column];
                    (0..LANES).for_each(|l| half[l] = dt[l] * (unit + 0.5 * dt[l] * a[l]));
                    self.transition[row * order + n + column] = *half;
                }
            }
        }
    }

    #[inline(always)]
    fn move_deviations(&mut self, at: &[usize; LANES]) {
        let (n, axes, order) = (self.states, self.axes, self.order);
        for row in 0..n {
            let mut moved = [[0.0; LANES]; 2];
            for i in 0..order {
                let weight = &self.transition[row * order + i];
                for (to, from) in moved.iter_mut().zip(&self.deviations[i]) {
                    (0..LANES).for_each(|l| to[l] += weight[l] * from[l]);
                }
            }
            for (lane, part) in self.parts.iter().enumerate() {
                moved[0][lane] += part.defect.get(at[lane] * n + row).copied().unwrap_or(0.0);
                let g = &part.accelerations[at[lane] * axes..][..axes];
                for (axis, g) in g.iter().enumerate() {
                    moved[1][lane] += self.half[row * axes + axis][lane] * g;
                }
            }
            self.moved[row] = moved;
        }
        for axis in 0..axes {
            let kept = self.kept[axis][0];
            let from = &self.deviations[n + axis];
            self.moved[n + axis] =
                std::array::from_fn(|of| std::array::from_fn(|l| kept[l] * from[of][l]));
        }
        std::mem::swap(&mut self.moved, &mut self.deviations);
    }

    /// The covariance at the next sample.
    #[inline(always)]
    fn spread(&mut self, discrepancies: &Discrepancies) {
        let (n, order) = (self.states, self.order);
        for row in 0..n {
            let to = &mut self.room[row * order..][..order];
            to.fill([0.0; LANES]);
            for i in 0..order {
                let weight = &self.transition[row * order + i];
                for (to, from) in to.iter_mut().zip(&self.covariance[i * order..][..order]) {
                    (0..LANES).for_each(|l| to[l] += weight[l] * from[l]);
                }
            }
        }
        for row in n..order {
            let kept = &self.kept[row - n][0];
            for column in 0..order {
                let from = &self.covariance[row * order + column];
                self.room[row * order + column] = std::array::from_fn(|l| kept[l] * from[l]);
            }
        }
        for row in 0..order {
            for column in 0..=row {
                let mut sum = [-0.0; LANES];
                let left = &self.room[row * order..][..order];
                if column < n {
                    let right = &self.transition[column * order..][..order];
                    for (a, b) in left.iter().zip(right) {
                        (0..LANES).for_each(|l| sum[l] += a[l] * b[l]);
                    }
                } else {
                    let (a, b) = (&left[column], &self.kept[column - n][0]);
                    (0..LANES).for_each(|l| sum[l] = a[l] * b[l]);
                }
                self.covariance[row * order + column] = sum;
                self.covariance[column * order + row] = sum;
            }
        }
        self.add_noise(discrepancies);
    }

    #[inline(always)]
    fn add_noise(&mut self, discrepancies: &Discrepancies) {
        let (n, order, dt) = (self.states, self.order, self.dt);
        for (state, drift) in self.drift.iter().enumerate() {
            let to = &mut self.covariance[state * (order + 1)];
            (0..LANES).for_each(|l| to[l] += drift * dt[l]);
        }
        for (axis, discrepancy) in discrepancies.iter().enumerate() {
            let (white, variance) = (discrepancy.white.powi(2), discrepancy.deviation.powi(2));
            let to = &mut self.covariance[axis * (order + 1)];
            (0..LANES).for_each(|l| to[l] += dt[l] * white);
            let renewed = &self.kept[axis][1];
            let to = &mut self.covariance[(n + axis) * (order + 1)];
            (0..LANES).for_each(|l| to[l] += renewed[l] * variance);
        }
    }

    #[inline(always)]
    fn update(&mut self, k: usize, noise: &Noise) {
        let (order, at) = (self.order, self.samples(k, 1));
        let parts = self.parts;
        for (i, &(channel, place)) in parts[0].channels.iter().enumerate() {
            let mut error = [[0.0; LANES]; 2];
            for (lane, part) in parts.iter().enumerate() {
                let reading = at[lane] * part.channels.len() + i;
                error[0][lane] = part.reading[reading];
                if !part.measured.is_empty() {
                    error[1][lane] -= part.by_column[reading];
                }
            }
            let sigma = noise.get(&channel).map_or(1.0, |instrument| instrument.deviation);
            let own = match parts[0].by_state {
                None => self.predict_reading(place, &mut error),
                Some(_) => self.predict_by_states(&at, i, &mut error),
            };
            let variance: Lane = std::array::from_fn(|l| own[l] + sigma * sigma);
            self.count(k, &error, &variance);
            for state in 0..order {
                let gain: Lane = std::array::from_fn(|l| self.gain[state][l] / variance[l]);
                for (to, error) in self.deviations[state].iter_mut().zip(&error) {
                    (0..LANES).for_each(|l| to[l] += gain[l] * error[l]);
                }
                let rows = &mut self.covariance[state * order..][..order];
                for (to, from) in rows.iter_mut().zip(&self.gain) {
                    (0..LANES).for_each(|l| to[l] += -gain[l] * from[l]);
                }
            }
        }
    }

    /// Takes from the errors what deviations make a channel say that is a state, and fills `gain`;
    /// returns the variance of that.
    #[inline(always)]
    fn predict_reading(&mut self, place: usize, error: &mut [Lane; 2]) -> Lane {
        for (error, own) in error.iter_mut().zip(&self.deviations[place]) {
            (0..LANES).for_each(|l| error[l] += -own[l]);
        }
        self.gain.copy_from_slice(&self.covariance[place * self.order..][..self.order]);
        self.gain[place]
    }

    /// The same of a channel that says several states at once.
    #[inline(always)]
    fn predict_by_states(
        &mut self,
        at: &[usize; LANES],
        channel: usize,
        error: &mut [Lane; 2],
    ) -> Lane {
        let (n, order) = (self.states, self.order);
        let weights = |state: usize, parts: &[&Linearised]| -> Lane {
            let of = |lane: usize| {
                let part = parts.get(lane)?;
                let row = (at[lane] * part.channels.len() + channel) * n;
                part.by_state.as_ref()?.get(row + state).copied()
            };
            std::array::from_fn(|lane| of(lane).unwrap_or(0.0))
        };
        self.gain.fill([0.0; LANES]);
        for state in 0..n {
            let weight = weights(state, self.parts);
            if weight == [0.0; LANES] {
                continue;
            }
            for (error, own) in error.iter_mut().zip(&self.deviations[state]) {
                (0..LANES).for_each(|l| error[l] += -weight[l] * own[l]);
            }
            let rows = &self.covariance[state * order..][..order];
            for (to, from) in self.gain.iter_mut().zip(rows) {
                (0..LANES).for_each(|l| to[l] += weight[l] * from[l]);
            }
        }
        let mut own = [-0.0; LANES];
        for state in 0..n {
            let weight = weights(state, self.parts);
            (0..LANES).for_each(|l| own[l] += weight[l] * self.gain[state][l]);
        }
        own
    }

    /// Adds a reading's part to the sums of those lanes that go on.
    #[inline(always)]
    fn count(&mut self, k: usize, error: &[Lane; 2], variance: &Lane) {
        for (lane, part) in self.parts.iter().enumerate() {
            if k < part.samples.len() {
                let scale = variance[lane].sqrt().recip();
                let whitened = error[0][lane] * scale - -error[1][lane] * scale;
                self.squares[lane] += whitened * whitened;
                self.log_variance[lane] += variance[lane].ln();
            }
        }
    }
}

#[cfg(test)]
#[path = "likelihood_tests.rs"]
mod tests;
