//! Responses of a ship among waves as a table: by a strip theory program, by panels, or measured.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use super::response::{Motion, Responses};

/// Amplitudes of motions by that of a wave, on a grid of frequencies and directions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ResponseTable {
    /// Frequencies of waves, rad/s, rising.
    pub omegas: Vec<f64>,
    /// Where waves go from the bow, rad, rising within one turn: pi is a head sea.
    pub betas: Vec<f64>,
    /// By frequency, then by direction, m/m.
    pub heave: Vec<Vec<f64>>,
    /// The same, rad/m.
    pub pitch: Vec<Vec<f64>>,
    /// The same, rad/m.
    pub roll: Vec<Vec<f64>>,
}

/// Why a table cannot be used.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TableFault {
    /// The grid of a field does not rise, or is too short.
    #[error("{0}: at least two numbers that rise are needed")]
    Grid(&'static str),
    /// Directions go around the ship more than once.
    #[error("betas: they go around the ship more than once")]
    Turn,
    /// A row is missing or too long.
    #[error("{field}: {found} rows or columns, where the grid has {wanted}")]
    Shape {
        /// The motion.
        field: &'static str,
        /// How many there are.
        found: usize,
        /// How many there must be.
        wanted: usize,
    },
    /// A value is negative or no number.
    #[error("{field}: row {row}, column {column}: an amplitude is a number of at least 0")]
    Value {
        /// The motion.
        field: &'static str,
        /// From 1.
        row: usize,
        /// From 1.
        column: usize,
    },
}

impl ResponseTable {
    /// Everything that is wrong with it; nothing where it can be used.
    pub fn faults(&self) -> Vec<TableFault> {
        let mut faults: Vec<TableFault> = [("omegas", &self.omegas), ("betas", &self.betas)]
            .into_iter()
            .filter(|(_, grid)| !rises(grid))
            .map(|(field, _)| TableFault::Grid(field))
            .collect();
        if let (Some(first), Some(last)) = (self.betas.first(), self.betas.last())
            && last - first >= TAU
        {
            faults.push(TableFault::Turn);
        }
        for (field, rows) in [("heave", &self.heave), ("pitch", &self.pitch), ("roll", &self.roll)]
        {
            faults.extend(self.of_motion(field, rows));
        }
        faults
    }

    fn of_motion(&self, field: &'static str, rows: &[Vec<f64>]) -> Vec<TableFault> {
        let shape = |found: usize, wanted: usize| {
            (found != wanted).then_some(TableFault::Shape { field, found, wanted })
        };
        let mut faults: Vec<TableFault> =
            shape(rows.len(), self.omegas.len()).into_iter().collect();
        faults.extend(rows.iter().filter_map(|row| shape(row.len(), self.betas.len())));
        for (row, values) in rows.iter().enumerate() {
            let wrong = |value: &f64| !(value.is_finite() && *value >= 0.0);
            faults.extend(values.iter().position(wrong).map(|column| TableFault::Value {
                field,
                row: row + 1,
                column: column + 1,
            }));
        }
        faults
    }

    fn rows(&self, motion: Motion) -> &[Vec<f64>] {
        match motion {
            Motion::Heave => &self.heave,
            Motion::Pitch => &self.pitch,
            Motion::Roll => &self.roll,
        }
    }
}

impl Responses for ResponseTable {
    /// Linear between neighbours in both; beyond the frequencies that of the nearest.
    fn response(&self, motion: Motion, omega: f64, beta: f64) -> f64 {
        let rows = self.rows(motion);
        let (low, high, share) = between(&self.omegas, omega);
        let (left, right, turned) = around(&self.betas, beta);
        let along = |row: &[f64]| row[left] + turned * (row[right] - row[left]);
        let (below, above) = (along(&rows[low]), along(&rows[high]));
        below + share * (above - below)
    }
}

fn rises(grid: &[f64]) -> bool {
    grid.len() > 1
        && grid.iter().all(|value| value.is_finite())
        && grid.windows(2).all(|pair| pair[0] < pair[1])
}

/// The neighbours of a value, and how far it is from the first to the second.
fn between(grid: &[f64], value: f64) -> (usize, usize, f64) {
    let value = value.clamp(grid[0], grid[grid.len() - 1]);
    let high = grid.partition_point(|x| *x < value).clamp(1, grid.len() - 1);
    let (a, b) = (grid[high - 1], grid[high]);
    (high - 1, high, (value - a) / (b - a))
}

/// The same around the ship: the last is the first one's neighbour.
fn around(grid: &[f64], beta: f64) -> (usize, usize, f64) {
    let last = grid.len() - 1;
    let beta = grid[0] + (beta - grid[0]).rem_euclid(TAU);
    if beta <= grid[last] {
        return between(grid, beta);
    }
    (last, 0, (beta - grid[last]) / (grid[0] + TAU - grid[last]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seakeeping::hull::GUNNERUS as HULL;
    use crate::seakeeping::{DirectionalSpectrum, WaveHull};

    /// What the closed forms give, on a grid.
    fn table() -> ResponseTable {
        let omegas: Vec<f64> = (0..120).map(|k| 0.1 + 0.025 * f64::from(k)).collect();
        let betas: Vec<f64> = (0..72).map(|k| (5.0 * f64::from(k)).to_radians()).collect();
        let of = |motion| {
            let row = |omega: &f64| {
                betas.iter().map(|beta| HULL.response(motion, *omega, *beta)).collect()
            };
            omegas.iter().map(row).collect::<Vec<Vec<f64>>>()
        };
        let [heave, pitch, roll] = WaveHull::MOTIONS.map(of);
        ResponseTable { omegas, betas, heave, pitch, roll }
    }

    /// JONSWAP's shape is not needed: any sea that covers frequencies and directions.
    fn sea() -> DirectionalSpectrum {
        let omegas: Vec<f64> = (0..27).map(|k| 0.41 + 0.083 * f64::from(k)).collect();
        let betas: Vec<f64> = (0..50).map(|k| f64::from(k) * TAU / 50.0).collect();
        let density = |omega: &f64, beta: &f64| {
            (-((omega - 0.9) / 0.3).powi(2)).exp() * (0.5 * (beta - 2.0)).cos().powi(4)
        };
        let row = |omega: &f64| betas.iter().map(|beta| density(omega, beta)).collect();
        let density = omegas.iter().map(row).collect();
        DirectionalSpectrum { omegas, betas, density }
    }

    #[test]
    fn a_table_of_the_closed_forms_gives_their_deviations() {
        let (table, sea) = (table(), sea());
        assert_eq!(table.faults(), []);
        for motion in WaveHull::MOTIONS {
            let (by_table, closed) = (sea.deviation(&table, motion), sea.deviation(&HULL, motion));
            assert!((by_table / closed - 1.0).abs() < 0.01, "{motion:?}: {by_table} for {closed}");
        }
    }

    #[test]
    fn directions_go_around_the_ship() {
        let table = table();
        let at = |beta: f64| table.response(Motion::Roll, 0.8, beta);
        assert!((at(-0.02) - at(TAU - 0.02)).abs() < 1e-12);
        assert!((at(6.25) - at(6.25 + TAU)).abs() < 1e-12);
    }

    #[test]
    fn every_fault_is_told_at_once() {
        let mut table = table();
        table.omegas.swap(3, 4);
        table.pitch[2].pop();
        table.roll[5][7] = f64::NAN;
        let told: Vec<String> = table.faults().iter().map(ToString::to_string).collect();
        assert_eq!(
            told,
            [
                "omegas: at least two numbers that rise are needed",
                "pitch: 71 rows or columns, where the grid has 72",
                "roll: row 6, column 8: an amplitude is a number of at least 0",
            ]
        );
    }
}
