//! Starting points of the search: by headers, and without them by columns of which one is the rate
//! of the other.

use crate::hypothesis::{Assignment, Hypothesis};
use crate::role::Role;
use crate::rudder::pearson_correlation;
use crate::search::AssignmentSearch;

/// Correlation of changes and integrals above which one column is a rate of the other.
const RATE: f64 = 0.9;
/// Number of starting points in addition to that by headers.
const STARTS: usize = 6;
/// Largest number of pairs that are considered.
const MOST: usize = 6;
/// Quantities and their rates.
const PAIRS: [(Role, Role); 4] =
    [(Role::Psi, Role::R), (Role::X, Role::VNorth), (Role::Y, Role::VEast), (Role::Phi, Role::P)];

/// Returns the assignments that all starting points lead to, with their log odds.
pub(crate) fn local_optima(search: &AssignmentSearch, time_factor: f64) -> Vec<(Assignment, f64)> {
    let named = search.independent_start(time_factor);
    let related = related_starts(search, &named, STARTS);
    let each = related.into_iter().chain([named]).map(|start| search.improve_assignment(start));
    each.collect()
}

/// Returns the likeliest assignments in which each pair of columns is a quantity and its rate, or
/// neither.
fn related_starts(search: &AssignmentSearch, base: &Assignment, count: usize) -> Vec<Assignment> {
    let pairs = rate_pairs(search);
    let mut found = Vec::new();
    extend_assignment(search, &pairs, base, &mut found);
    found.sort_by(|a: &(f64, Assignment), b| b.0.total_cmp(&a.0));
    found.truncate(count);
    found.into_iter().map(|(_, start)| start).collect()
}

/// Returns pairs of a column and its rate, highest correlation first.
fn rate_pairs(search: &AssignmentSearch) -> Vec<(usize, usize)> {
    let signals = search.physics.observed.signals;
    let mut found = Vec::new();
    for i in (0..search.own.len()).filter(|&i| !search.hypotheses[i].is_empty()) {
        for j in (0..search.own.len()).filter(|&j| j != i && !search.hypotheses[j].is_empty()) {
            let each = signals.scales.iter().map(|scale| {
                pearson_correlation(&scale.columns[i].change, &scale.columns[j].integral).abs()
            });
            let correlation = each.fold(0.0, f64::max);
            if correlation > RATE {
                found.push((correlation, (i, j)));
            }
        }
    }
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    found.truncate(MOST);
    found.into_iter().map(|(_, pair)| pair).collect()
}

/// Collects every assignment of the remaining pairs, recursively.
fn extend_assignment(
    search: &AssignmentSearch,
    pairs: &[(usize, usize)],
    of: &Assignment,
    found: &mut Vec<(f64, Assignment)>,
) {
    let Some((&(i, j), rest)) = pairs.split_first() else {
        found.push((search.assignment_odds(of), of.clone()));
        return;
    };
    // The pair may also have no meaning: continue without it.
    extend_assignment(search, rest, of, found);
    for (whole, rate) in PAIRS {
        // A role occurs only once in an assignment.
        let taken = [whole, rate].iter().any(|&role| of.has_role(role));
        if !taken && let Some(with) = likeliest_pair(search, of, (i, whole), (j, rate)) {
            extend_assignment(search, rest, &with, found);
        }
    }
}

/// Returns the assignment of both columns in the units and signs that fit each other best.
fn likeliest_pair(
    search: &AssignmentSearch,
    of: &Assignment,
    (i, whole): (usize, Role),
    (j, rate): (usize, Role),
) -> Option<Assignment> {
    let mut best: Option<(f64, Assignment)> = None;
    let of_j: Vec<Hypothesis> = search.hypotheses_for(j, rate).collect();
    for a in search.hypotheses_for(i, whole) {
        for b in &of_j {
            let with = of.with_column(i, Some(a)).with_column(j, Some(*b));
            let relation = search.physics.rate_relation(&with, whole, rate, "");
            let odds = search.own[i].hypothesis_odds(&a)
                + search.own[j].hypothesis_odds(b)
                + relation.map_or(0.0, |relation| relation.odds);
            if best.as_ref().is_none_or(|(most, _)| odds > *most) {
                best = Some((odds, with));
            }
        }
    }
    best.map(|(_, with)| with)
}
