//! Mobility matrix: accelerations per unit force, the inverse of the mass matrix.

use nalgebra::Matrix4;

use super::definition::EquationsOfMotion;
use super::plant_error::PlantError;
use crate::tape::Tape;

/// Returns the accelerations that unit forces cause; all NaN if the matrix is singular.
pub fn solve_mobility(n: usize, mass: impl Fn(usize, usize) -> f64) -> Matrix4<f64> {
    // Axes that the law does not have are padded by those of the identity matrix.
    let padded =
        Matrix4::from_fn(
            |i, j| if i < n && j < n { mass(i, j) } else { f64::from(u8::from(i == j)) },
        );
    padded.lu().solve(&Matrix4::identity()).unwrap_or_else(|| Matrix4::repeat(f64::NAN))
}

/// Returns the mobility over all axes, row by row, if the masses do not change, and `None`
/// otherwise; `mass` are the outputs of the matrix entries on the tape.
///
/// # Errors
/// Returns an error if the mass matrix cannot be inverted.
pub fn constant_mobility(
    equations: &EquationsOfMotion<'_>,
    tape: &Tape,
    mass: &[Option<usize>],
) -> Result<Option<Vec<f64>>, PlantError> {
    let entries: Option<Vec<f64>> =
        // An absent entry is a constant zero; an entry that changes gives `None`.
        mass.iter().map(|o| o.map_or(Some(0.0), |o| tape.constant_output(o))).collect();
    let Some(entries) = entries else { return Ok(None) };
    let n = equations.axes().len();
    let solved = solve_mobility(n, |i, j| entries[i * n + j]);
    let constant: Vec<f64> = (0..n * n).map(|k| solved[(k / n, k % n)]).collect();
    // NaN marks a matrix that could not be inverted.
    if constant.iter().any(|value| !value.is_finite()) {
        return Err(PlantError::Mass(equations.model().name.clone()));
    }
    Ok(Some(constant))
}
