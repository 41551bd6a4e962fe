//! Ridge regression on kernels about some of the samples: the mean of a Gaussian process by a
//! subset of regressors (Rasmussen and Williams 2006, Eq. 8.14). The kernel is the rational
//! quadratic one (Eq. 4.19 with an exponent of 1), which needs no function that libraries round
//! each in their own way.

use nalgebra::{Cholesky, DMatrix, DVector};
use serde::{Deserialize, Serialize};

use crate::draws::RandomStream;
use crate::sample::TrainingSample;

/// Weighted sum of kernels.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KernelSum {
    /// Prediction far from every centre: the mean of the targets.
    pub mean: f64,
    /// Length scale, in standard deviations of the inputs.
    pub length: f64,
    /// Inputs of the samples that are kernel centres, one after the other.
    pub centres: Vec<f64>,
    /// Weight of each kernel.
    pub factors: Vec<f64>,
}

/// Nugget that keeps the system solvable where two centres almost coincide, relative to its mean
/// diagonal: well above the rounding error of a sum of some thousand products, which is 1e-13 of
/// it.
const NUGGET: f64 = 1e-10;

/// Solves `(K_mn K_nm + ridge K_mm) factors = K_mn targets`. Returns `None` if the matrix is
/// singular.
pub fn train_kernels(
    sample: &TrainingSample,
    centres: usize,
    length: f64,
    ridge: f64,
    draws: &mut RandomStream,
) -> Option<KernelSum> {
    let mut about = draws.sample_indices(centres, sample.len());
    // In ascending order, the centres do not depend on the order of the draws.
    about.sort_unstable();
    let rows = about.iter().flat_map(|row| sample.row_inputs(*row as usize)).collect();
    // The process has a constant mean; the kernels explain the rest.
    let mean = sample.targets.iter().sum::<f64>() / sample.len() as f64;
    let mut kernels = KernelSum { mean, length, centres: rows, factors: vec![0.0; about.len()] };
    let (mut matrix, mut right) = normal_equations(&kernels, sample);
    for (place, row) in about.iter().enumerate() {
        let own = kernels.kernel_values(&sample.row_inputs(*row as usize));
        // The ridge times the kernel matrix of the centres among themselves.
        own.iter().enumerate().for_each(|(k, value)| matrix[(place, k)] += ridge * value);
    }
    // Relative to the mean diagonal, so that it does not depend on the scale of the kernels.
    let nugget = NUGGET * matrix.trace() / about.len() as f64;
    (0..about.len()).for_each(|k| matrix[(k, k)] += nugget);
    Cholesky::new(matrix)?.solve_mut(&mut right);
    kernels.factors = right.iter().copied().collect();
    kernels.factors.iter().all(|factor| factor.is_finite()).then_some(kernels)
}

/// Accumulates `K_mn K_nm` and `K_mn targets`.
fn normal_equations(kernels: &KernelSum, sample: &TrainingSample) -> (DMatrix<f64>, DVector<f64>) {
    let count = kernels.factors.len();
    let mut matrix = DMatrix::zeros(count, count);
    let mut right = DVector::zeros(count);
    for k in 0..sample.len() {
        let values = kernels.kernel_values(&sample.row_inputs(k));
        let target = sample.targets[k] - kernels.mean;
        for (column, value) in values.iter().enumerate() {
            right[column] += value * target;
            let own = &mut matrix.column_mut(column);
            // The matrix is symmetric: only the lower triangle is summed.
            own.iter_mut().zip(&values).skip(column).for_each(|(m, other)| *m += value * other);
        }
    }
    matrix.fill_upper_triangle_with_lower_triangle();
    (matrix, right)
}

impl KernelSum {
    /// Values of all kernels at the inputs.
    fn kernel_values(&self, inputs: &[f64]) -> Vec<f64> {
        self.centres
            .chunks_exact(inputs.len())
            .map(|centre| self.kernel_value(centre, inputs))
            .collect()
    }

    /// Value of the kernel about a centre.
    #[inline]
    fn kernel_value(&self, centre: &[f64], inputs: &[f64]) -> f64 {
        let square: f64 = centre.iter().zip(inputs).map(|(c, x)| (c - x) * (c - x)).sum();
        1.0 / (1.0 + square / (2.0 * self.length * self.length))
    }

    /// Prediction: the weighted sum of the kernels.
    pub fn predict(&self, inputs: &[f64]) -> f64 {
        let centres = self.centres.chunks_exact(inputs.len());
        let terms =
            centres.zip(&self.factors).map(|(c, factor)| factor * self.kernel_value(c, inputs));
        self.mean + terms.sum::<f64>()
    }

    /// Adds the derivatives of the prediction to `slopes`: a kernel `k` about `c` has `dk/dx = k^2
    /// (c - x) / length^2`.
    pub fn add_gradient(&self, inputs: &[f64], slopes: &mut [f64]) {
        let scale = 1.0 / (self.length * self.length);
        for (centre, factor) in self.centres.chunks_exact(inputs.len()).zip(&self.factors) {
            let weight = factor * scale * self.kernel_value(centre, inputs).powi(2);
            let offsets = centre.iter().zip(inputs).map(|(c, x)| c - x);
            slopes.iter_mut().zip(offsets).for_each(|(slope, offset)| *slope += weight * offset);
        }
    }

    /// True if the lists are consistent and hold finite numbers only.
    pub fn is_sound(&self, inputs: usize) -> bool {
        let mut numbers = self.centres.iter().chain(&self.factors).chain([&self.mean]);
        self.centres.len() == inputs * self.factors.len()
            && self.length > 0.0
            && numbers.all(|number| number.is_finite())
    }
}
