//! Current of one trial: from speeds over the ground and through the water, or from a steady turn.

use nalgebra::{DMatrix, DVector};
use sistership_model::manifest::VelocityFrame;
use sistership_model::trial::{Channel, Trial};

use super::current_estimate::{CurrentEstimate, LARGEST_ERROR, common_current};
use super::steady_turn::{SteadyTurn, steady_turns};

/// Number of blocks whose means are compared: errors of neighbouring samples are not independent.
const BLOCKS: usize = 12;
/// Smallest standard error, m/s: that of velocities of satellite navigation and logs.
const LEAST_ERROR: f64 = 0.01;
/// Longest trial of which a steady current is stated, s.
const LONGEST_S: f64 = 3600.0;

/// Returns the current of a trial and the evidence; `None` if the trial does not determine it.
pub(super) fn estimate_current(trial: &Trial) -> Option<(CurrentEstimate, String)> {
    // Velocities through the water have no current in them. A tidal stream changes within an hour,
    // so that one value does not describe a longer record.
    if trial.velocity == VelocityFrame::Water || duration_s(trial) > LONGEST_S {
        return None;
    }
    // Two logs tell the current directly; a turn shows it by its drift.
    let usable = |one: &CurrentEstimate| one.error < LARGEST_ERROR;
    if let Some(estimate) = by_log(trial).filter(usable) {
        let why = "speeds over the ground less those through the water";
        return Some((estimate, format!("{why}, standard error {:.3} m/s", estimate.error)));
    }
    let found = steady_turns(trial).into_iter().filter_map(|parts| {
        let each = parts.iter().filter_map(|part| Some((by_turn(trial, part)?, part.turned_rad)));
        each.filter(|(estimate, _)| usable(estimate)).min_by(|a, b| a.0.error.total_cmp(&b.0.error))
    });
    let (estimates, turned): (Vec<CurrentEstimate>, Vec<f64>) = found.unzip();
    let estimate = common_current(&estimates)?;
    let why = format!(
        "drift of the turning circle over {:.0} deg, standard error {:.3} m/s",
        turned.iter().sum::<f64>().to_degrees(),
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
    equations.solve()?.estimate([0, 1])
}

/// Returns the current by a steady turn: the velocity over the ground less one that turns with the
/// ship, and changes with time and yaw rate.
///
/// The velocity of the ship itself is known to the extent that its description does not matter: the
/// error contains the change of the estimate where the velocity is described more freely, and what
/// turns twice as fast as the ship. A wind makes a drift that does so, and another one of the same
/// order that is like a current.
fn by_turn(trial: &Trial, turn: &SteadyTurn) -> Option<CurrentEstimate> {
    let turn = TurningVelocity::new(trial, &turn.samples)?;
    let simple = turn.equations(false).solve()?;
    let free = turn.equations(true).solve()?;
    let [estimate, other] = [&simple, &free].map(|one| one.estimate([CURRENT, CURRENT + 1]));
    let (estimate, other) = (estimate?, other?);
    let change = (other.north - estimate.north).hypot(other.east - estimate.east);
    let twice = free.found[TWICE].hypot(free.found[TWICE + 1]);
    let error = estimate.error.hypot(change).hypot(twice);
    Some(CurrentEstimate { error, ..estimate })
}

/// Places of the components of the current, and of the velocity that turns twice, among the unknowns.
const CURRENT: usize = 6;
const TWICE: usize = 8;

/// Motion in a steady turn.
struct TurningVelocity<'a> {
    t_s: &'a [f64],
    psi: &'a [f64],
    u: &'a [f64],
    v: &'a [f64],
    r: &'a [f64],
}

impl<'a> TurningVelocity<'a> {
    fn new(trial: &'a Trial, samples: &std::ops::Range<usize>) -> Option<Self> {
        let part = |channel| trial.channel(channel).and_then(|values| values.get(samples.clone()));
        Some(Self {
            t_s: trial.t_s.get(samples.clone())?,
            psi: part(Channel::Psi)?,
            u: part(Channel::U)?,
            v: part(Channel::V)?,
            r: part(Channel::R)?,
        })
    }

    /// Returns the equations of the velocities north and east; those of a free description have a
    /// quadratic change with time and a velocity that turns twice as fast.
    fn equations(&self, is_free: bool) -> CurrentEquations {
        let mean_rate = self.r.iter().sum::<f64>() / self.r.len() as f64;
        let [first, last] = [self.t_s.first(), self.t_s.last()].map(|t| t.copied().unwrap_or(0.0));
        let mut equations = CurrentEquations::new(if is_free { 12 } else { 8 });
        for k in 0..self.psi.len() {
            let (sin, cos) = self.psi[k].sin_cos();
            let (sin2, cos2) = (2.0 * self.psi[k]).sin_cos();
            // Scaled to the order of 1, so that the equations are well conditioned.
            let time = 2.0 * (self.t_s[k] - first) / (last - first) - 1.0;
            let rate = self.r[k] / mean_rate - 1.0;
            let square = time * time;
            // Velocities of the ship turn with its heading and change slowly; a current does neither.
            let north = [
                cos,
                cos * time,
                cos * rate,
                -sin,
                -sin * time,
                -sin * rate,
                1.0,
                0.0,
                cos2,
                -sin2,
                cos * square,
                -sin * square,
            ];
            let east = [
                sin,
                sin * time,
                sin * rate,
                cos,
                cos * time,
                cos * rate,
                0.0,
                1.0,
                sin2,
                cos2,
                sin * square,
                cos * square,
            ];
            let unknowns = equations.unknowns;
            equations.add_row(&north[..unknowns], self.u[k] * cos - self.v[k] * sin);
            equations.add_row(&east[..unknowns], self.u[k] * sin + self.v[k] * cos);
        }
        equations
    }
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

    /// Solves by least squares. The covariance is from the scatter of the means of blocks (ITTC
    /// 7.5-02-07-03.2 on uncertainty by batch means).
    fn solve(&self) -> Option<SolvedEquations> {
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
        Some(SolvedEquations { covariance: &inverse * scatter * &inverse, found })
    }
}

/// Unknowns and their covariance.
struct SolvedEquations {
    found: DVector<f64>,
    covariance: DMatrix<f64>,
}

impl SolvedEquations {
    /// Returns the current, whose components are at two places, with the larger standard error.
    fn estimate(&self, at: [usize; 2]) -> Option<CurrentEstimate> {
        let error = at.map(|k| self.covariance[(k, k)].max(0.0).sqrt());
        let error = error.into_iter().fold(LEAST_ERROR, f64::max);
        let (north, east) = (self.found[at[0]], self.found[at[1]]);
        let estimate = CurrentEstimate { north, east, error };
        [north, east, error].iter().all(|one: &f64| one.is_finite()).then_some(estimate)
    }
}
