//! Which limits cannot be kept together.

use super::limit::Limit;
use super::programme::{NearestPointProblem, Overstepping};
use super::thresholds::CONSTRAINTS;

/// A set of limits that cannot be kept together, none of which can be left out of it (the deletion
/// filter of Chinneck and Dravnieks 1991, ORSA Journal on Computing 3, 157-168), by name; none
/// where all can be kept.
pub(super) fn conflict(
    nearest: &NearestPointProblem<'_>,
    limits: &[&Limit],
) -> Option<Vec<String>> {
    if possible(nearest, limits) {
        return None;
    }
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

/// Whether limits can be kept together: whether the least overstepping is none.
fn possible(nearest: &NearestPointProblem<'_>, limits: &[&Limit]) -> bool {
    if limits.is_empty() {
        return true;
    }
    nearest
        .within(limits, Overstepping::Elastic)
        .is_ok_and(|point| point.overstepped.iter().all(|by| *by < CONSTRAINTS.solver_error))
}
