//! Search for limits that cannot be kept together.

use super::limit::Limit;
use super::programme::{NearestPointProblem, Overstepping};
use super::thresholds::CONSTRAINTS;

/// Names of an irreducible set of limits that cannot be kept together: without any one of them the
/// others can (the deletion filter of Chinneck and Dravnieks 1991, ORSA Journal on Computing 3,
/// 157-168). `None` if all limits can be kept together.
pub(super) fn conflict(
    nearest: &NearestPointProblem<'_>,
    limits: &[&Limit],
) -> Option<Vec<String>> {
    if possible(nearest, limits) {
        return None;
    }
    // Deletion filter: a limit without which the others still conflict is not part of the conflict.
    // The order of the limits decides which of several irreducible sets is found.
    let mut kept: Vec<&Limit> = limits.to_vec();
    for limit in limits {
        let without: Vec<&Limit> =
            kept.iter().copied().filter(|other| !std::ptr::eq(*other, *limit)).collect();
        if !possible(nearest, &without) {
            kept = without;
        }
    }
    Some(kept.into_iter().map(|limit| limit.name.clone()).collect())
}

/// True if limits can be kept together: if the least violation in the elastic programme is zero but
/// for the solver's error.
fn possible(nearest: &NearestPointProblem<'_>, limits: &[&Limit]) -> bool {
    if limits.is_empty() {
        return true;
    }
    nearest
        // The elastic programme always has a solution; a failure of the solver counts as
        // infeasible.
        .within(limits, Overstepping::Elastic)
        .is_ok_and(|point| point.overstepped.iter().all(|by| *by < CONSTRAINTS.solver_error))
}
