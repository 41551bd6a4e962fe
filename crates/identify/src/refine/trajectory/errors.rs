//! How far the trajectory form's coefficients may be from the truth.
//!
//! With `H` the Hessian, `g` the gradient of the residuals and `W`, `L` the pulls, the error is
//! `H^-1 (g + mu W (c_weak - c) + lambda L (c_source - c))`: the scatter of the segments' gradients, within which residuals
//! may depend on each other (Huber 1967, Proc. Fifth Berkeley Symposium 1, 221-233), and the errors of what pulls.

use nalgebra::{DMatrix, DVector};

use super::super::posterior::Errors;
use super::prior::{Prior, Strength};
use super::solve::Held;

/// Joint errors of coefficients in the order of the normal equations; `weak` are those of the weak form, in any order.
pub(super) fn errors(
    names: &[String],
    held: &Held,
    gradients: &[DVector<f64>],
    count: f64,
    pulls: (&Prior, Strength),
    weak: &Errors,
) -> Option<Errors> {
    let (prior, strength) = pulls;
    let inverse = held.inverse()?;
    let weak = weak.ordered(names)?;
    let size = names.len();
    let to_weak = &prior.hessian * strength.mu;
    let to_source = DMatrix::from_diagonal(&DVector::from_fn(size, |k, _| strength.lambda * prior.own(k)));
    let both = &to_weak * &weak.cross * &to_source;
    let middle = scatter(gradients, count, size)
        + &to_weak * &weak.covariance * &to_weak
        + &to_source * &weak.source * &to_source
        + &both
        + both.transpose();
    let cross = &inverse * (&to_weak * &weak.cross + &to_source * &weak.source);
    Some(Errors { names: names.to_vec(), covariance: &inverse * middle * &inverse, source: weak.source, cross })
}

/// Covariance of the mean gradient from that of the segments', which have one direction less than there are segments.
fn scatter(gradients: &[DVector<f64>], count: f64, size: usize) -> DMatrix<f64> {
    let segments = gradients.len() as f64;
    let mut sum = DMatrix::zeros(size, size);
    gradients.iter().for_each(|gradient| sum.ger(1.0, gradient, gradient, 1.0));
    sum * (segments / (segments - 1.0).max(1.0) / count.max(1.0).powi(2))
}
