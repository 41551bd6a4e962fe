//! Response of a ship to small disturbances of a straight course, as an affine function of its
//! coefficients.

use nalgebra::{Matrix2, Matrix3, Vector3};
use sistership_model::Model;
use sistership_model::law::Law;
use sistership_simulation::plant::PlantWorkspace;
use sistership_simulation::state::{at, straight_state};
use sistership_simulation::{PlantError, Ship, StateVector};

use super::limit::{AffineFunction, CoefficientLimit};
use super::settings::StraightLine;
use super::thresholds::CONSTRAINTS;

/// Derivative of the rates of change of the state on a straight course by one element (`place`) of
/// the state, by central differences of half width `size`.
fn rate_derivative(ship: &Ship, speed_m_s: f64, place: usize, size: f64) -> StateVector {
    let rate = |by: f64| {
        let mut state = straight_state(speed_m_s);
        state[place] += by;
        ship.rate_at(&state, 0.0, ship.revolutions_at(speed_m_s), &mut PlantWorkspace::default())
    };
    (rate(size) - rate(-size)) / (2.0 * size)
}

/// The matrix of sway and yaw, row by row: derivatives of the rates of `v/U` and `r L/U` by
/// themselves, with time in units of `L/U`.
pub(super) fn sway_and_yaw(ship: &Ship) -> [f64; 4] {
    let (length, speed) = (ship.lpp_m(), ship.approach_speed_m_s());
    let time = length / speed;
    // Both columns are derivatives in SI units; the factors below make them dimensionless.
    let by_sway = rate_derivative(ship, speed, at::V, CONSTRAINTS.disturbance * speed);
    let by_yaw = rate_derivative(ship, speed, at::R, CONSTRAINTS.disturbance * speed / length);
    [
        by_sway[at::V] * time,
        by_yaw[at::V] / speed,
        by_sway[at::R] * length * time,
        by_yaw[at::R] * time,
    ]
}

/// Derivative of surge acceleration by the speed, 1/s, on a straight course at `speed_m_s`.
pub(super) fn surge_derivative(ship: &Ship, speed_m_s: f64) -> f64 {
    rate_derivative(ship, speed_m_s, at::U, CONSTRAINTS.disturbance * speed_m_s)[at::U]
}

/// Functions of a ship that are affine in the coefficients of its model, as affine functions of the
/// coefficients `names`, by differences.
pub(super) fn affine_functions<const N: usize>(
    model: &Model,
    law: &Law,
    names: &[String],
    of: &dyn Fn(&Ship) -> [f64; N],
) -> Result<[AffineFunction; N], PlantError> {
    let at = |model: &Model| Ship::new(model, law).map(|ship| of(&ship));
    // The functions are affine in each coefficient, so that a difference of any size gives the
    // exact normal.
    let here = at(model)?;
    let mut normals: [Vec<f64>; N] = std::array::from_fn(|_| Vec::with_capacity(names.len()));
    for name in names {
        let mut moved = model.clone();
        let value = model.coefficient(name);
        let by = if value == 0.0 { CONSTRAINTS.difference } else { value.abs() };
        moved.coefficients.get_mut(name).into_iter().for_each(|quantity| quantity.value += by);
        let there = at(&moved)?;
        (0..N).for_each(|k| normals[k].push((there[k] - here[k]) / by));
    }
    let values: Vec<f64> = names.iter().map(|name| model.coefficient(name)).collect();
    Ok(std::array::from_fn(|k| {
        let linear = AffineFunction { normal: normals[k].clone(), constant: 0.0 };
        // The constant follows from the value at the model's own coefficients.
        AffineFunction { constant: here[k] - linear.value_at(&values), ..linear }
    }))
}

/// Returns true if a matrix of sway and yaw has the declared stability.
pub(super) fn has_stability(line: StraightLine, matrix: &Matrix2<f64>) -> bool {
    match line {
        StraightLine::Stable => spectral_abscissa(matrix) < 0.0,
        StraightLine::Unstable => spectral_abscissa(matrix) > 0.0,
    }
}

/// Sign of the definite matrix of the Lyapunov inequality: -1 for a stable, 1 for an unstable ship.
fn definiteness_sign(line: StraightLine) -> f64 {
    if line == StraightLine::Stable { -1.0 } else { 1.0 }
}

/// The declared stability as a limit: `P A + A' P` is definite for the `P` with which it is so at a
/// reference. By Lyapunov's theorems, negative definite with the `P` of a stable reference makes
/// `A` stable, and positive definite with the `P` of an unstable one makes it unstable (Khalil
/// 2002, Nonlinear systems, Theorems 4.3 and 4.6). `None` if the reference has no such `P`.
pub(super) fn stability_limit(
    line: StraightLine,
    functions: &[AffineFunction; 4],
    reference: &Matrix2<f64>,
) -> Option<CoefficientLimit> {
    let p = solve_lyapunov(reference, definiteness_sign(line))?;
    let [vv, vr, rv, rr] = functions;
    // Elements of `sign (P A + A' P)`: the diagonal ones are `2 (p11 vv + p12 rv)` and `2 (p12 vr +
    // p22 rr)`, the other one is `p11 vr + p12 vv + p12 rr + p22 rv`.
    let twice = |a: &AffineFunction, pa: f64, b: &AffineFunction, pb: f64| {
        a.linear_combination(
            2.0 * pa * definiteness_sign(line),
            b,
            2.0 * pb * definiteness_sign(line),
        )
    };
    // The margin keeps the solver's error from making the matrix indefinite.
    let margin = |mut function: AffineFunction| {
        function.constant -= CONSTRAINTS.margin;
        function
    };
    let first = margin(twice(vv, p[(0, 0)], rv, p[(0, 1)]));
    let last = margin(twice(vr, p[(0, 1)], rr, p[(1, 1)]));
    let cross = vr.linear_combination(p[(0, 0)], vv, p[(0, 1)]).linear_combination(
        1.0,
        &rr.linear_combination(p[(0, 1)], rv, p[(1, 1)]),
        1.0,
    );
    let cross = cross.linear_combination(definiteness_sign(line), &cross, 0.0);
    let name = if line == StraightLine::Stable {
        "straight-line stability"
    } else {
        "straight-line instability"
    };
    Some(CoefficientLimit::positive_semidefinite(name.to_owned(), [&first, &cross, &last]))
}

/// The largest real part of the eigenvalues (the spectral abscissa).
pub(super) fn spectral_abscissa(matrix: &Matrix2<f64>) -> f64 {
    matrix.complex_eigenvalues().iter().map(|value| value.re).fold(f64::NEG_INFINITY, f64::max)
}

/// The symmetric `P` with `P A + A' P = sign I`; `None` if the equations are singular.
fn solve_lyapunov(a: &Matrix2<f64>, sign: f64) -> Option<Matrix2<f64>> {
    // Three linear equations for `p11`, `p12` and `p22`; the second one is the element off the
    // diagonal.
    let equations = Matrix3::new(
        2.0 * a[(0, 0)],
        2.0 * a[(1, 0)],
        0.0,
        a[(0, 1)],
        a[(0, 0)] + a[(1, 1)],
        a[(1, 0)],
        0.0,
        2.0 * a[(0, 1)],
        2.0 * a[(1, 1)],
    );
    let p = equations.lu().solve(&Vector3::new(sign, 0.0, sign))?;
    Some(Matrix2::new(p[0], p[1], p[1], p[2]))
}
