//! Starting points of the search: by headers, and without them by columns of which one is the rate
//! of the other.

use crate::hypothesis::{Assignment, Hypothesis};
use crate::role::Role;
use crate::rudder::correlation;
use crate::search::Search;

/// Correlation of changes and integrals above which one column is a rate of the other.
const RATE: f64 = 0.9;
/// Number of starting points in addition to that by headers.
const STARTS: usize = 3;
/// Largest number of pairs that are considered.
const MOST: usize = 6;
/// Quantities and their rates.
const PAIRS: [(Role, Role); 4] =
    [(Role::Psi, Role::R), (Role::X, Role::VNorth), (Role::Y, Role::VEast), (Role::Phi, Role::P)];

/// Returns the best assignment from all starting points, and its log odds.
pub(crate) fn best(search: &Search, time_factor: f64) -> (Assignment, f64) {
    let named = search.start(time_factor);
    let related = related(search, &named, STARTS);
    let each = related.into_iter().chain([named]).map(|start| search.improved(start));
    let best = each.max_by(|a, b| a.1.total_cmp(&b.1));
    best.unwrap_or_else(|| (search.start(time_factor), f64::NEG_INFINITY))
}

/// Returns the likeliest assignments in which each pair of columns is a quantity and its rate, or
/// neither.
fn related(search: &Search, base: &Assignment, count: usize) -> Vec<Assignment> {
    let pairs = rates(search);
    let mut found = Vec::new();
    extend(search, &pairs, base, &mut found);
    found.sort_by(|a: &(f64, Assignment), b| b.0.total_cmp(&a.0));
    found.truncate(count);
    found.into_iter().map(|(_, start)| start).collect()
}

/// Returns pairs of a column and its rate, highest correlation first.
fn rates(search: &Search) -> Vec<(usize, usize)> {
    let signals = search.physics.observed.signals;
    let mut found = Vec::new();
    for i in (0..search.own.len()).filter(|&i| !search.hypotheses[i].is_empty()) {
        for j in (0..search.own.len()).filter(|&j| j != i && !search.hypotheses[j].is_empty()) {
            let each = signals.scales.iter().map(|scale| {
                correlation(&scale.columns[i].change, &scale.columns[j].integral).abs()
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
fn extend(
    search: &Search,
    pairs: &[(usize, usize)],
    of: &Assignment,
    found: &mut Vec<(f64, Assignment)>,
) {
    let Some((&(i, j), rest)) = pairs.split_first() else {
        found.push((search.odds(of), of.clone()));
        return;
    };
    // The pair may also have no meaning: continue without it.
    extend(search, rest, of, found);
    for (whole, rate) in PAIRS {
        // A role occurs only once in an assignment.
        let taken = [whole, rate].iter().any(|&role| of.has(role));
        if !taken && let Some(with) = likeliest(search, of, (i, whole), (j, rate)) {
            extend(search, rest, &with, found);
        }
    }
}

/// Returns the assignment of both columns in the units and signs that fit each other best.
fn likeliest(
    search: &Search,
    of: &Assignment,
    (i, whole): (usize, Role),
    (j, rate): (usize, Role),
) -> Option<Assignment> {
    let mut best: Option<(f64, Assignment)> = None;
    let of_j: Vec<Hypothesis> = search.of_role(j, rate).collect();
    for a in search.of_role(i, whole) {
        for b in &of_j {
            let with = of.with(i, Some(a)).with(j, Some(*b));
            let relation = search.physics.rate(&with, whole, rate, "");
            let odds = search.own[i].odds(&a)
                + search.own[j].odds(b)
                + relation.map_or(0.0, |relation| relation.odds);
            if best.as_ref().is_none_or(|(most, _)| odds > *most) {
                best = Some((odds, with));
            }
        }
    }
    best.map(|(_, with)| with)
}
