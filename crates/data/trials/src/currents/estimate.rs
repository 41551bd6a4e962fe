//! Current of one trial: from speeds over the ground and through the water, or from a steady turn.

use nalgebra::{DMatrix, DVector};
use sistership_model::manifest::VelocityFrame;
use sistership_model::trial::{Channel, Trial};

use super::current_estimate::{CurrentEstimate, LARGEST_ERROR};
use super::steady_turn::steady_turn;

/// Number of blocks whose means are compared: errors of neighbouring samples are not independent.
const BLOCKS: usize = 12;
/// Longest trial of which a steady current is stated, s.
const LONGEST_S: f64 = 3600.0;

/// Returns the current of a trial and the evidence; `None` if the trial does not determine it.
pub(super) fn estimate_current(trial: &Trial) -> Option<(CurrentEstimate, String)> {
    // Velocities through the water have no current in them. A tidal stream changes within an hour,
    // so that one value does not describe a longer record.
    if trial.velocity == VelocityFrame::Water || duration_s(trial) > LONGEST_S {
        return None;
    }
    // Two logs tell the current directly; a turn tells it by its drift.
    let usable = |one: &CurrentEstimate| one.error < LARGEST_ERROR;
    if let Some(estimate) = by_log(trial).filter(usable) {
        let why = "speeds over the ground less those through the water";
        return Some((estimate, format!("{why}, standard error {:.3} m/s", estimate.error)));
    }
    let turn = steady_turn(trial)?;
    let estimate = by_turn(trial, &turn.samples).filter(usable)?;
    let why = format!(
        "drift of the turning circle over {:.0} deg, standard error {:.3} m/s",
        turn.turned_rad.to_degrees(),
        estimate.error
    );
    Some((estimate, why))
}

fn duration_s(trial: &Trial) -> f64 {
    let ends = trial.t_s.first().zip(trial.t_s.last());
    ends.map_or(0.0, |(first, last)| last - first)
}

/// Returns the current by logs through the water and over the ground: along the heading, and
/// athwart where both are recorded.
fn by_log(trial: &Trial) -> Option<CurrentEstimate> {
    let psi = trial.channel(Channel::Psi)?;
    let pairs = [(Channel::U, Channel::UWater, 0.0), (Channel::V, Channel::VWater, 1.0)];
    let recorded = pairs.iter().filter_map(|&(ground, water, athwart)| {
        Some((trial.channel(ground)?, trial.channel(water)?, athwart))
    });
    let mut equations = CurrentEquations::new(2);
    for (ground, water, athwart) in recorded {
        for (k, psi) in psi.iter().enumerate() {
            // Direction of the log: ahead, or to starboard of it.
            let direction = psi + athwart * std::f64::consts::FRAC_PI_2;
            let row = [direction.cos(), direction.sin()];
            equations.add_row(&row, ground[k] - water[k]);
        }
    }
    equations.solve([0, 1])
}

/// Returns the current by a steady turn: the velocity over the ground less one that turns with the
/// ship, and changes with time and yaw rate.
fn by_turn(trial: &Trial, samples: &std::ops::Range<usize>) -> Option<CurrentEstimate> {
    let [psi, u, v, r] = [Channel::Psi, Channel::U, Channel::V, Channel::R]
        .map(|one| trial.channel(one).and_then(|values| values.get(samples.clone())));
    let (psi, u, v, r, t_s) = (psi?, u?, v?, r?, trial.t_s.get(samples.clone())?);
    let mean_rate = r.iter().sum::<f64>() / r.len() as f64;
    let (first, last) = (t_s.first()?, t_s.last()?);
    let mut equations = CurrentEquations::new(8);
    for k in 0..psi.len() {
        let (sin, cos) = psi[k].sin_cos();
        // Scaled to the order of 1, so that the equations are well conditioned.
        let time = 2.0 * (t_s[k] - first) / (last - first) - 1.0;
        let rate = r[k] / mean_rate - 1.0;
        // Velocities of the ship turn with its heading and change slowly; a current does neither.
        let north = [cos, cos * time, cos * rate, -sin, -sin * time, -sin * rate, 1.0, 0.0];
        let east = [sin, sin * time, sin * rate, cos, cos * time, cos * rate, 0.0, 1.0];
        equations.add_row(&north, u[k] * cos - v[k] * sin);
        equations.add_row(&east, u[k] * sin + v[k] * cos);
    }
    equations.solve([6, 7])
}

/// Equations that are linear in the components of the current and in further coefficients.
struct CurrentEquations {
    unknowns: usize,
    rows: Vec<f64>,
    values: Vec<f64>,
}

impl CurrentEquations {
    fn new(unknowns: usize) -> Self {
        Self { unknowns, rows: Vec::new(), values: Vec::new() }
    }

    fn add_row(&mut self, row: &[f64], value: f64) {
        if value.is_finite() && row.iter().all(|one| one.is_finite()) {
            self.rows.extend_from_slice(row);
            self.values.push(value);
        }
    }

    /// Solves by least squares; `at` are the places of the components. The standard error is from
    /// the scatter of the means of blocks (ITTC 7.5-02-07-03.2 on uncertainty by batch means).
    fn solve(&self, at: [usize; 2]) -> Option<CurrentEstimate> {
        let count = self.values.len();
        // Fewer rows leave too few residuals in a block for a standard error.
        if count < 4 * self.unknowns {
            return None;
        }
        let rows = DMatrix::from_row_slice(count, self.unknowns, &self.rows);
        let values = DVector::from_column_slice(&self.values);
        let inverse = (rows.transpose() * &rows).try_inverse()?;
        let found = &inverse * rows.transpose() * &values;
        let residuals = &values - &rows * &found;
        // Covariance of the sum of each block's contributions (a sandwich estimator).
        let length = count.div_ceil(BLOCKS);
        let mut scatter = DMatrix::zeros(self.unknowns, self.unknowns);
        for first in (0..count).step_by(length) {
            let size = length.min(count - first);
            let score = rows.rows(first, size).transpose() * residuals.rows(first, size);
            scatter += &score * score.transpose();
        }
        let covariance = &inverse * scatter * &inverse;
        let error = at.map(|k| covariance[(k, k)].max(0.0).sqrt()).into_iter().fold(0.0, f64::max);
        let (north, east) = (found[at[0]], found[at[1]]);
        // A floor, so that noise-free data do not weigh without bound.
        let error = f64::max(error, 1e-3);
        let estimate = CurrentEstimate { north, east, error };
        [north, east, error].iter().all(|one: &f64| one.is_finite()).then_some(estimate)
    }
}
