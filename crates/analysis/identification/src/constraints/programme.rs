//! The nearest point within limits, by Clarabel.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettings, DefaultSolver, IPSolver, NonnegativeConeT, SecondOrderConeT, SolverStatus,
    SupportedConeT,
};
use nalgebra::{DMatrix, DVector};

use super::limit::Limit;
use super::thresholds::CONSTRAINTS;

/// What is nearest: coefficients, and the curvature by which distance is measured.
pub(super) struct NearestPointProblem<'a> {
    pub centre: &'a [f64],
    pub curvature: &'a DMatrix<f64>,
}

/// How far each limit may be overstepped at a price, or not at all.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Overstepping {
    /// Limits hold; the point is nearest.
    Held,
    /// Each limit may be overstepped; the sum of that is least, and hardly anything else counts.
    Elastic,
}

/// What came out, in coefficients.
pub(super) struct NearestPoint {
    pub coefficients: Vec<f64>,
    /// By how much each limit is overstepped, by its own scale; empty where limits hold.
    pub overstepped: Vec<f64>,
}

impl NearestPointProblem<'_> {
    /// The nearest point within limits.
    ///
    /// # Errors
    /// What the solver says, where it does not say `Solved`.
    pub fn within(
        &self,
        limits: &[&Limit],
        steps: Overstepping,
    ) -> Result<NearestPoint, SolverStatus> {
        let (size, extra) =
            (self.centre.len(), if steps == Overstepping::Elastic { limits.len() } else { 0 });
        let scales = self.scales();
        let weight = if steps == Overstepping::Elastic { CONSTRAINTS.elastic_weight } else { 1.0 };
        let entry = |i: usize, j: usize| match i.max(j) < size {
            true => weight * self.curvature[(i, j)] * scales[i] * scales[j],
            false => 0.0,
        };
        let quadratic =
            sparse(size + extra, size + extra, &|i, j| if i <= j { entry(i, j) } else { 0.0 });
        let linear: Vec<f64> =
            (0..size + extra).map(|k| if k < size { 0.0 } else { 1.0 }).collect();
        let (rows, bounds, cones) = self.rows(limits, &scales, extra);
        let matrix = sparse(rows.len(), size + extra, &|i, j| rows[i][j]);
        let settings = DefaultSettings { verbose: false, ..DefaultSettings::default() };
        let solver = DefaultSolver::new(&quadratic, &linear, &matrix, &bounds, &cones, settings);
        let mut solver = solver.map_err(|_| SolverStatus::Unsolved)?;
        solver.solve();
        if solver.solution.status != SolverStatus::Solved {
            return Err(solver.solution.status);
        }
        let x = &solver.solution.x;
        let coefficients = (0..size).map(|k| self.centre[k] + scales[k] * x[k]).collect();
        Ok(NearestPoint { coefficients, overstepped: x[size..].to_vec() })
    }

    /// What changes each coefficient by one unit of curvature.
    fn scales(&self) -> DVector<f64> {
        self.curvature.diagonal().map(|d| if d > 0.0 { 1.0 / d.sqrt() } else { 1.0 })
    }

    /// `A x + s = b` with `s` in the cones, every limit by the length of its normals.
    #[allow(clippy::type_complexity)]
    fn rows(
        &self,
        limits: &[&Limit],
        scales: &DVector<f64>,
        extra: usize,
    ) -> (Vec<Vec<f64>>, Vec<f64>, Vec<SupportedConeT<f64>>) {
        let (mut rows, mut bounds, mut cones) = (Vec::new(), Vec::new(), Vec::new());
        let size = self.centre.len();
        for (k, limit) in limits.iter().enumerate() {
            let scaled: Vec<Vec<f64>> = limit
                .cone
                .iter()
                .map(|f| f.normal.iter().zip(scales).map(|(n, s)| n * s).collect())
                .collect();
            let length = scaled.iter().flatten().map(|x| x * x).sum::<f64>().sqrt();
            let by = if length > 0.0 { 1.0 / length } else { 1.0 };
            for (place, (normal, function)) in scaled.iter().zip(&limit.cone).enumerate() {
                let mut row: Vec<f64> = normal.iter().map(|n| -n * by).collect();
                row.resize(size + extra, 0.0);
                if extra > 0 && place == 0 {
                    row[size + k] = -1.0;
                }
                rows.push(row);
                bounds.push(function.at(self.centre) * by);
            }
            cones.push(if limit.cone.len() == 1 {
                NonnegativeConeT(1)
            } else {
                SecondOrderConeT(limit.cone.len())
            });
        }
        for k in 0..extra {
            let mut row = vec![0.0; size + extra];
            row[size + k] = -1.0;
            rows.push(row);
            bounds.push(0.0);
        }
        if extra > 0 {
            cones.push(NonnegativeConeT(extra));
        }
        (rows, bounds, cones)
    }
}

/// A matrix by columns without its zeros.
fn sparse(rows: usize, columns: usize, entry: &dyn Fn(usize, usize) -> f64) -> CscMatrix<f64> {
    let (mut starts, mut places, mut values) = (vec![0], Vec::new(), Vec::new());
    for column in 0..columns {
        for (row, value) in
            (0..rows).map(|row| (row, entry(row, column))).filter(|(_, value)| *value != 0.0)
        {
            places.push(row);
            values.push(value);
        }
        starts.push(places.len());
    }
    CscMatrix::new(rows, columns, starts, places, values)
}
