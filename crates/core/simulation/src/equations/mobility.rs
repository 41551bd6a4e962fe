//! Accelerations per force: the mass matrix, solved.

use nalgebra::Matrix4;

use super::definition::EquationsOfMotion;
use super::refusal::PlantError;
use crate::tape::Tape;

/// Accelerations that unit forces cause; not a number where the matrix cannot be solved.
pub fn mobility(n: usize, mass: impl Fn(usize, usize) -> f64) -> Matrix4<f64> {
    let padded =
        Matrix4::from_fn(
            |i, j| if i < n && j < n { mass(i, j) } else { f64::from(u8::from(i == j)) },
        );
    padded.lu().solve(&Matrix4::identity()).unwrap_or_else(|| Matrix4::repeat(f64::NAN))
}

/// The same over all axes, row by row, where masses do not change; `mass` are the outputs of the
/// matrix' entries on the tape.
///
/// # Errors
/// Says that the mass matrix cannot be solved.
pub fn constant_mobility(
    equations: &EquationsOfMotion<'_>,
    tape: &Tape,
    mass: &[Option<usize>],
) -> Result<Option<Vec<f64>>, PlantError> {
    let entries: Option<Vec<f64>> =
        mass.iter().map(|o| o.map_or(Some(0.0), |o| tape.constant_output(o))).collect();
    let Some(entries) = entries else { return Ok(None) };
    let n = equations.axes().len();
    let solved = mobility(n, |i, j| entries[i * n + j]);
    let constant: Vec<f64> = (0..n * n).map(|k| solved[(k / n, k % n)]).collect();
    if constant.iter().any(|value| !value.is_finite()) {
        return Err(PlantError::Mass(equations.model().name.clone()));
    }
    Ok(Some(constant))
}
