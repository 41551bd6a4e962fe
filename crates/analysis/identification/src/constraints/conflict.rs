//! Search for limits that cannot be kept together.

use super::limit::CoefficientLimit;
use super::programme::{LimitEnforcement, NearestPointProblem};
use super::thresholds::CONSTRAINTS;

/// Names of an irreducible set of limits that cannot be kept together: without any one of them the
/// others can (the deletion filter of Chinneck and Dravnieks 1991, ORSA Journal on Computing 3,
/// 157-168). `None` if all limits can be kept together.
pub(super) fn find_conflict(
    nearest: &NearestPointProblem<'_>,
    limits: &[&CoefficientLimit],
) -> Option<Vec<String>> {
    if is_feasible(nearest, limits) {
        return None;
    }
    // Deletion filter: a limit without which the others still conflict is not part of the conflict.
    // The order of the limits decides which of several irreducible sets is found.
    let mut kept: Vec<&CoefficientLimit> = limits.to_vec();
    for limit in limits {
        let without: Vec<&CoefficientLimit> =
            kept.iter().copied().filter(|other| !std::ptr::eq(*other, *limit)).collect();
        if !is_feasible(nearest, &without) {
            kept = without;
        }
    }
    Some(kept.into_iter().map(|limit| limit.name.clone()).collect())
}

/// True if limits can be kept together: if the least violation in the elastic programme is zero but
/// for the solver's error.
fn is_feasible(nearest: &NearestPointProblem<'_>, limits: &[&CoefficientLimit]) -> bool {
    if limits.is_empty() {
        return true;
    }
    nearest
        // The elastic programme always has a solution; a failure of the solver counts as
        // infeasible.
        .solve(limits, LimitEnforcement::Elastic)
        .is_ok_and(|point| point.overstepped.iter().all(|by| *by < CONSTRAINTS.solver_error))
}
