//! Responses of a ship in waves as a table: from a strip theory program, a panel method, or
//! measurements.

use std::f64::consts::{PI, TAU};

use serde::{Deserialize, Serialize};

use super::response::{ResponseOperator, WaveMotion};

/// Amplitudes of motions per wave amplitude, on a grid of frequencies and directions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ResponseGrid {
    /// Wave frequencies, rad/s, increasing.
    pub omegas: Vec<f64>,
    /// Directions of wave travel from the bow, rad, increasing: all around the ship, or from 0 to
    /// pi, with the other side as mirror image. pi is a head sea.
    pub betas: Vec<f64>,
    /// Heave by frequency, then by direction, m/m.
    pub heave: Vec<Vec<f64>>,
    /// Pitch in the same order, rad/m.
    pub pitch: Vec<Vec<f64>>,
    /// Roll in the same order, rad/m.
    pub roll: Vec<Vec<f64>>,
}

/// Response grid that has been checked.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "ResponseGrid", into = "ResponseGrid")]
pub struct ResponseTable(ResponseGrid);

/// Fault of a response grid.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TableFault {
    /// The grid of a field is not increasing, or is too short.
    #[error("{0}: at least two increasing numbers are needed")]
    Grid(&'static str),
    /// Directions go around the ship more than once.
    #[error("betas: they cover more than a full circle")]
    Turn,
    /// Directions omit a part of the ship's surroundings.
    #[error("betas: they must cover a full circle, or 0 to pi")]
    Gap,
    /// The number of rows or columns is wrong.
    #[error("{field}: {found} rows or columns, where the grid has {wanted}")]
    Shape {
        /// Name of the motion.
        field: &'static str,
        /// Number found.
        found: usize,
        /// Number expected.
        wanted: usize,
    },
    /// A value is negative or not a finite number.
    #[error(
        "{field}: row {row}, column {column}: an amplitude must be a finite number of at \
             least 0"
    )]
    Value {
        /// Name of the motion.
        field: &'static str,
        /// Row, from 1.
        row: usize,
        /// Column, from 1.
        column: usize,
    },
}

/// All faults of a grid.
#[derive(Debug, Clone, PartialEq)]
pub struct TableFaults(pub Vec<TableFault>);

impl std::fmt::Display for TableFaults {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let all: Vec<String> = self.0.iter().map(ToString::to_string).collect();
        f.write_str(&all.join("; "))
    }
}

impl std::error::Error for TableFaults {}

impl TryFrom<ResponseGrid> for ResponseTable {
    type Error = TableFaults;

    fn try_from(grid: ResponseGrid) -> Result<Self, TableFaults> {
        let faults = grid.find_faults();
        if faults.is_empty() { Ok(Self(grid)) } else { Err(TableFaults(faults)) }
    }
}

impl From<ResponseTable> for ResponseGrid {
    fn from(table: ResponseTable) -> Self {
        table.0
    }
}

/// Tolerance of the first and last direction of one side about 0 and pi, rad.
const NEAR: f64 = 1e-3;
/// Largest step from the last direction to the first, relative to the largest other step.
const SEAM: f64 = 2.0;

impl ResponseGrid {
    /// Checks the grid and the values of each motion.
    fn find_faults(&self) -> Vec<TableFault> {
        let mut faults: Vec<TableFault> = [("omegas", &self.omegas), ("betas", &self.betas)]
            .into_iter()
            .filter(|(_, grid)| !is_increasing(grid))
            .map(|(field, _)| TableFault::Grid(field))
            .collect();
        if is_increasing(&self.betas) {
            faults.extend(self.direction_fault());
        }
        for (field, rows) in [("heave", &self.heave), ("pitch", &self.pitch), ("roll", &self.roll)]
        {
            faults.extend(self.motion_faults(field, rows));
        }
        faults
    }

    /// Checks that the directions cover the ship's surroundings.
    fn direction_fault(&self) -> Option<TableFault> {
        let over = self.betas[self.betas.len() - 1] - self.betas[0];
        let steps = self.betas.windows(2).map(|pair| pair[1] - pair[0]);
        let most = steps.fold(0.0, f64::max);
        match over {
            _ if over >= TAU => Some(TableFault::Turn),
            // A full circle closes within a step similar to the others; one side needs no closing.
            _ if self.is_one_side() || TAU - over <= SEAM * most => None,
            _ => Some(TableFault::Gap),
        }
    }

    fn is_one_side(&self) -> bool {
        let (first, last) = (self.betas[0], self.betas[self.betas.len() - 1]);
        first.abs() < NEAR && (last - PI).abs() < NEAR
    }

    /// Checks the size and the values of one motion.
    fn motion_faults(&self, field: &'static str, rows: &[Vec<f64>]) -> Vec<TableFault> {
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

    fn motion_rows(&self, motion: WaveMotion) -> &[Vec<f64>] {
        match motion {
            WaveMotion::Heave => &self.heave,
            WaveMotion::Pitch => &self.pitch,
            WaveMotion::Roll => &self.roll,
        }
    }
}

impl ResponseOperator for ResponseTable {
    /// Bilinear interpolation; beyond the frequencies of the grid, the value at the nearest one.
    fn response_amplitude(&self, motion: WaveMotion, omega: f64, beta: f64) -> f64 {
        let (grid, rows) = (&self.0, self.0.motion_rows(motion));
        let (low, high, share) = bracket_value(&grid.omegas, omega);
        let (left, right, turned) = match grid.is_one_side() {
            // Mirror image: of the angle and its negative, the one on the tabulated side is the
            // smaller.
            true => bracket_value(&grid.betas, beta.rem_euclid(TAU).min((-beta).rem_euclid(TAU))),
            false => bracket_direction(&grid.betas, beta),
        };
        let along = |row: &[f64]| row[left] + turned * (row[right] - row[left]);
        let (below, above) = (along(&rows[low]), along(&rows[high]));
        below + share * (above - below)
    }
}

fn is_increasing(grid: &[f64]) -> bool {
    grid.len() > 1
        && grid.iter().all(|value| value.is_finite())
        && grid.windows(2).all(|pair| pair[0] < pair[1])
}

/// Indices of the neighbours of a value, and its position from the first to the second, 0 to 1.
fn bracket_value(grid: &[f64], value: f64) -> (usize, usize, f64) {
    let value = value.clamp(grid[0], grid[grid.len() - 1]);
    let high = grid.partition_point(|x| *x < value).clamp(1, grid.len() - 1);
    let (a, b) = (grid[high - 1], grid[high]);
    (high - 1, high, (value - a) / (b - a))
}

/// The same for a direction around the ship: the last is a neighbour of the first.
fn bracket_direction(grid: &[f64], beta: f64) -> (usize, usize, f64) {
    let last = grid.len() - 1;
    let beta = grid[0] + (beta - grid[0]).rem_euclid(TAU);
    // Beyond the last direction, interpolation continues to the first one.
    if beta <= grid[last] {
        return bracket_value(grid, beta);
    }
    (last, 0, (beta - grid[last]) / (grid[0] + TAU - grid[last]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seakeeping::hull::GUNNERUS as HULL;
    use crate::seakeeping::{DirectionalSpectrum, WaveHull};

    /// What the closed forms give every 5 degrees, on a grid.
    fn grid(directions: i32) -> ResponseGrid {
        let omegas: Vec<f64> = (0..120).map(|k| 0.1 + 0.025 * f64::from(k)).collect();
        let betas: Vec<f64> = (0..directions).map(|k| (5.0 * f64::from(k)).to_radians()).collect();
        let of = |motion| {
            let row = |omega: &f64| {
                betas.iter().map(|beta| HULL.response_amplitude(motion, *omega, *beta)).collect()
            };
            omegas.iter().map(row).collect::<Vec<Vec<f64>>>()
        };
        let [heave, pitch, roll] = WaveHull::MOTIONS.map(of);
        ResponseGrid { omegas, betas, heave, pitch, roll }
    }

    fn table(directions: i32) -> ResponseTable {
        ResponseTable::try_from(grid(directions)).unwrap_or_else(|faults| panic!("{faults}"))
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
        let sea = sea();
        for (table, motion) in [table(72), table(37)]
            .iter()
            .flat_map(|table| WaveHull::MOTIONS.map(|motion| (table, motion)))
        {
            let (by_table, closed) =
                (sea.motion_deviation(table, motion), sea.motion_deviation(&HULL, motion));
            assert!((by_table / closed - 1.0).abs() < 0.01, "{motion:?}: {by_table} for {closed}");
        }
    }

    #[test]
    fn directions_go_around_the_ship() {
        let at = |directions: i32, beta: f64| {
            table(directions).response_amplitude(WaveMotion::Roll, 0.8, beta)
        };
        assert!((at(72, -0.02) - at(72, TAU - 0.02)).abs() < 1e-12);
        assert!((at(72, 6.25) - at(72, 6.25 + TAU)).abs() < 1e-12);
        assert!((at(37, 1.5 * PI) - at(37, 0.5 * PI)).abs() < 1e-12 && at(37, 1.5 * PI) > 0.1);
    }

    #[test]
    fn every_fault_is_told_at_once() {
        let mut grid = grid(72);
        grid.omegas.swap(3, 4);
        grid.pitch[2].pop();
        grid.roll[5][7] = f64::NAN;
        let told = ResponseTable::try_from(grid).map_err(|faults| faults.to_string());
        assert_eq!(
            told,
            Err("omegas: at least two increasing numbers are needed; pitch: 71 rows or columns, \
                 where the grid has 72; roll: row 6, column 8: an amplitude must be a finite \
                 number of at least 0"
                .to_owned())
        );
    }

    #[test]
    fn a_table_that_leaves_out_a_side_is_refused() {
        let faults = |directions| ResponseTable::try_from(grid(directions)).err();
        assert_eq!(faults(30), Some(TableFaults(vec![TableFault::Gap])));
        assert_eq!(faults(74), Some(TableFaults(vec![TableFault::Turn])));
        let json = r#"{"omegas":[],"betas":[],"heave":[],"pitch":[],"roll":[]}"#;
        assert!(serde_json::from_str::<ResponseTable>(json).is_err());
    }
}
