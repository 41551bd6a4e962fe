//! The nearest point within limits: the cone programme as Clarabel takes it.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettings, DefaultSolver, IPSolver, NonnegativeConeT, SecondOrderConeT, SolverStatus,
    SupportedConeT,
};
use nalgebra::{DMatrix, DVector};

use super::limit::CoefficientLimit;
use super::thresholds::CONSTRAINTS;

/// A problem of the nearest point: the point from which distance is measured, and the curvature
/// that measures it.
pub(super) struct NearestPointProblem<'a> {
    pub centre: &'a [f64],
    pub curvature: &'a DMatrix<f64>,
}

/// Treatment of violated limits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum LimitEnforcement {
    /// Limits hold, and the distance is least.
    Held,
    /// Each limit may be violated; the sum of the violations is least, and distance hardly counts.
    Elastic,
}

/// Solution of the problem.
pub(super) struct NearestPoint {
    pub coefficients: Vec<f64>,
    /// Violation of each limit in units of its scale; empty where limits hold.
    pub overstepped: Vec<f64>,
}

impl NearestPointProblem<'_> {
    /// Returns the nearest point within limits.
    ///
    /// # Errors
    /// Returns the solver's status unless it is `Solved`.
    pub fn solve(
        &self,
        limits: &[&CoefficientLimit],
        steps: LimitEnforcement,
    ) -> Result<NearestPoint, SolverStatus> {
        // Variables are the scaled changes of the coefficients, in the elastic programme followed
        // by one slack a limit. The objective is `1/2 x' P x + q' x` with `q` zero for coefficients
        // and one for slacks.
        let (size, extra) =
            (self.centre.len(), if steps == LimitEnforcement::Elastic { limits.len() } else { 0 });
        let scales = self.variable_scales();
        let weight =
            if steps == LimitEnforcement::Elastic { CONSTRAINTS.elastic_weight } else { 1.0 };
        let entry = |i: usize, j: usize| match i.max(j) < size {
            true => weight * self.curvature[(i, j)] * scales[i] * scales[j],
            false => 0.0,
        };
        // Clarabel takes the upper triangle of the quadratic part.
        let quadratic = sparse_matrix(size + extra, size + extra, &|i, j| {
            if i <= j { entry(i, j) } else { 0.0 }
        });
        let linear: Vec<f64> =
            (0..size + extra).map(|k| if k < size { 0.0 } else { 1.0 }).collect();
        let (rows, bounds, cones) = self.constraint_rows(limits, &scales, extra);
        let matrix = sparse_matrix(rows.len(), size + extra, &|i, j| rows[i][j]);
        let settings = DefaultSettings { verbose: false, ..DefaultSettings::default() };
        let solver = DefaultSolver::new(&quadratic, &linear, &matrix, &bounds, &cones, settings);
        // Construction fails only for inconsistent dimensions, which the caller cannot correct.
        let mut solver = solver.map_err(|_| SolverStatus::Unsolved)?;
        solver.solve();
        if solver.solution.status != SolverStatus::Solved {
            return Err(solver.solution.status);
        }
        let x = &solver.solution.x;
        let coefficients = (0..size).map(|k| self.centre[k] + scales[k] * x[k]).collect();
        Ok(NearestPoint { coefficients, overstepped: x[size..].to_vec() })
    }

    /// Scales of the variables: the change of each coefficient that has a curvature of one.
    fn variable_scales(&self) -> DVector<f64> {
        self.curvature.diagonal().map(|d| if d > 0.0 { 1.0 / d.sqrt() } else { 1.0 })
    }

    /// The constraints `A x + s = b` with `s` in the cones: rows of `A`, `b` and the cones, every
    /// limit divided by the length of its scaled normals.
    #[allow(clippy::type_complexity)]
    fn constraint_rows(
        &self,
        limits: &[&CoefficientLimit],
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
                // `s = b - A x` is the limit's function at the point, so that `A` has the negative
                // normals.
                let mut row: Vec<f64> = normal.iter().map(|n| -n * by).collect();
                row.resize(size + extra, 0.0);
                // A slack relaxes the first function of a cone, the one that bounds the length of
                // the others.
                if extra > 0 && place == 0 {
                    row[size + k] = -1.0;
                }
                rows.push(row);
                bounds.push(function.value_at(self.centre) * by);
            }
            cones.push(if limit.cone.len() == 1 {
                NonnegativeConeT(1)
            } else {
                SecondOrderConeT(limit.cone.len())
            });
        }
        // The slacks themselves are at least 0.
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

/// A matrix in compressed column form, zeros omitted.
fn sparse_matrix(
    rows: usize,
    columns: usize,
    entry: &dyn Fn(usize, usize) -> f64,
) -> CscMatrix<f64> {
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
