//! Search for the assignment with the highest log odds of headers, values and relations together.

use crate::cooccurrence;
use crate::hypothesis::{Assignment, Hypothesis};
use crate::own_evidence::OwnEvidence;
use crate::physics::PhysicalEvidence;
use crate::role::{QuantityKind, Role};

/// Log odds of a column alone below which a hypothesis is not considered.
const HOPELESS: f64 = -9.0;
/// Log odds from which a name is clear.
const NAMED: f64 = 3.0;
/// Passes over all columns; the assignment seldom changes after the third.
const PASSES: usize = 8;
/// Number of the likeliest pairs of columns that are tried for two coupled quantities.
const PAIRS: usize = 16;

/// Quantities that explain each other, which single changes may not find.
const COUPLED: [(Role, Role); 5] = [
    (Role::Psi, Role::R),
    (Role::Phi, Role::P),
    (Role::X, Role::Y),
    (Role::Latitude, Role::Longitude),
    (Role::VNorth, Role::VEast),
];
/// Quantities whose signs can change together without any effect on the relations between them.
const SIGNED: [&[Role]; 5] = [
    &[Role::Delta, Role::DeltaS, Role::DeltaP],
    &[Role::R, Role::Delta, Role::DeltaS, Role::DeltaP],
    &[Role::Psi, Role::R, Role::Delta, Role::DeltaS, Role::DeltaP],
    &[Role::Y, Role::Psi],
    &[Role::Phi, Role::P],
];

/// Column settled by the user: its hypothesis, or `None` if it is not to be read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SettledColumn {
    pub column: usize,
    pub what: Option<Hypothesis>,
}

/// Evidence from which the log odds of an assignment are computed, and the hypotheses that are
/// searched.
pub(crate) struct AssignmentSearch<'a> {
    pub own: &'a [OwnEvidence],
    pub physics: PhysicalEvidence<'a>,
    /// Hypotheses of each column; a settled column has one or none.
    pub hypotheses: Vec<Vec<Hypothesis>>,
    pub settled: Vec<SettledColumn>,
    pub time: Option<usize>,
}

impl<'a> AssignmentSearch<'a> {
    pub(crate) fn new(
        own: &'a [OwnEvidence],
        physics: PhysicalEvidence<'a>,
        time: Option<usize>,
        settled: Vec<SettledColumn>,
    ) -> Self {
        let hypotheses = own.iter().enumerate().map(|(at, own)| {
            match settled.iter().find(|one| one.column == at) {
                // The time column is fixed before the search.
                _ if time == Some(at) => Vec::new(),
                Some(settled) => settled.what.into_iter().collect(),
                None => possible_hypotheses(own),
            }
        });
        Self { own, physics, hypotheses: hypotheses.collect(), settled, time }
    }

    /// Returns the log odds of an assignment.
    pub(crate) fn assignment_odds(&self, of: &Assignment) -> f64 {
        let each = of.columns.iter().zip(self.own).map(|(what, own)| match what {
            Some(what) => own.hypothesis_odds(what),
            None => own.unassigned_odds(),
        });
        // A prohibitive penalty for each settled column that the assignment contradicts.
        let kept = self.settled.iter().filter(|one| of.columns[one.column] != one.what).count();
        each.sum::<f64>() + self.physics.total_odds(of) + cooccurrence::set_odds(of)
            - 1e3 * kept as f64
    }

    /// Improves an assignment by single columns, signs, pairs of columns and exchanges until
    /// nothing gains; returns it with its log odds.
    pub(crate) fn improve_assignment(&self, start: Assignment) -> (Assignment, f64) {
        let (mut best, mut odds) = (start.clone(), self.assignment_odds(&start));
        for pass in 0..PASSES {
            let before = odds;
            (0..self.own.len()).for_each(|column| self.try_column(column, &mut best, &mut odds));
            self.try_signs(&mut best, &mut odds);
            // Pairs and exchanges cost most, and seldom gain anything after the first pass.
            if pass < 1 {
                COUPLED.iter().for_each(|&pair| self.try_pairs(pair, &mut best, &mut odds));
                self.try_exchanges(&mut best, &mut odds);
            }
            if odds <= before {
                break;
            }
        }
        (best, odds)
    }

    /// Tries to reverse the signs of several quantities at once.
    fn try_signs(&self, best: &mut Assignment, odds: &mut f64) {
        for group in SIGNED {
            let mut other = best.clone();
            for what in other.columns.iter_mut().flatten().filter(|what| group.contains(&what.role))
            {
                what.is_reversed = !what.is_reversed;
            }
            self.keep_if_better(other, best, odds);
        }
    }

    /// Returns the assignment of each column by its own evidence, the clearest first.
    pub(crate) fn independent_start(&self, time_factor: f64) -> Assignment {
        let columns = vec![None; self.own.len()];
        let mut start = Assignment { columns, time_factor };
        let mut all: Vec<(f64, usize, Hypothesis)> = Vec::new();
        for (at, own) in self.own.iter().enumerate() {
            let each = self.hypotheses[at]
                .iter()
                .map(|what| (own.hypothesis_odds(what) - own.unassigned_odds(), at, *what));
            all.extend(each.filter(|one| one.0 > 0.0 || self.is_settled(at)));
        }
        all.sort_by(|a, b| b.0.total_cmp(&a.0));
        for (_, at, what) in all {
            if start.columns[at].is_none() && !start.has_role(what.role) {
                start.columns[at] = Some(what);
            }
        }
        start
    }

    fn is_settled(&self, column: usize) -> bool {
        self.settled.iter().any(|one| one.column == column)
    }

    fn try_column(&self, column: usize, best: &mut Assignment, odds: &mut f64) {
        if self.time == Some(column) {
            return;
        }
        let choices = self.hypotheses[column].iter().copied().map(Some).chain([None]);
        for choice in choices {
            self.keep_if_better(best.with_column(column, choice), best, odds);
        }
    }

    fn keep_if_better(&self, other: Assignment, best: &mut Assignment, odds: &mut f64) {
        if other == *best {
            return;
        }
        let found = self.assignment_odds(&other);
        if found > *odds + 1e-9 {
            (*best, *odds) = (other, found);
        }
    }

    /// Tries to exchange the roles of two columns.
    fn try_exchanges(&self, best: &mut Assignment, odds: &mut f64) {
        for i in 0..self.own.len() {
            for j in 0..i {
                let (Some(a), Some(b)) = (best.columns[i], best.columns[j]) else { continue };
                for a in self.hypotheses_for(j, a.role).collect::<Vec<_>>() {
                    for b in self.hypotheses_for(i, b.role).collect::<Vec<_>>() {
                        let other = best.with_column(j, Some(a)).with_column(i, Some(b));
                        self.keep_if_better(other, best, odds);
                    }
                }
            }
        }
    }

    pub(crate) fn hypotheses_for(
        &self,
        column: usize,
        role: Role,
    ) -> impl Iterator<Item = Hypothesis> + '_ {
        self.hypotheses[column].iter().copied().filter(move |what| what.role == role)
    }

    /// Tries both columns of a coupled pair at once; the likeliest pairs by their own evidence and
    /// their relation only.
    fn try_pairs(&self, (one, other): (Role, Role), best: &mut Assignment, odds: &mut f64) {
        let named = |role: Role| {
            let found = best.find(role);
            found.is_some_and(|(at, _)| self.own[at].name_odds(role) >= NAMED)
        };
        // Columns with clear names need no search in pairs.
        if named(one) && named(other) {
            return;
        }
        let mut likely: Vec<(f64, Assignment)> = Vec::new();
        for i in 0..self.own.len() {
            for a in self.hypotheses_for(i, one) {
                for j in (0..self.own.len()).filter(|&j| j != i) {
                    for b in self.hypotheses_for(j, other) {
                        let pair = best.with_column(i, Some(a)).with_column(j, Some(b));
                        let alone =
                            self.own[i].hypothesis_odds(&a) + self.own[j].hypothesis_odds(&b);
                        likely.push((alone + self.pair_odds((one, other), &pair), pair));
                    }
                }
            }
        }
        likely.sort_by(|a, b| b.0.total_cmp(&a.0));
        // The cheap score only ranks the pairs; `keep_if_better` compares the log odds of the whole
        // assignment.
        for (_, pair) in likely.into_iter().take(PAIRS) {
            self.keep_if_better(pair, best, odds);
        }
    }

    fn pair_odds(&self, pair: (Role, Role), of: &Assignment) -> f64 {
        let relation = match pair {
            (Role::Psi, Role::R) | (Role::Phi, Role::P) => {
                self.physics.rate_relation(of, pair.0, pair.1, "")
            }
            (Role::X, Role::Y) | (Role::Latitude, Role::Longitude) => {
                return self
                    .physics
                    .find_track(of)
                    .map_or(0.0, |track| track.track_odds(self.physics.observed, of));
            }
            (Role::VNorth, Role::VEast) => {
                let of_axis = |whole, rate| self.physics.rate_relation(of, whole, rate, "");
                let both = [of_axis(Role::X, Role::VNorth), of_axis(Role::Y, Role::VEast)];
                return both.into_iter().flatten().map(|relation| relation.odds).sum();
            }
            _ => return self.physics.total_odds(of),
        };
        relation.map_or(0.0, |relation| relation.odds)
    }
}

/// Returns the hypotheses that the evidence of a column alone allows.
fn possible_hypotheses(own: &OwnEvidence) -> Vec<Hypothesis> {
    let percent = |kind: QuantityKind| own.header.unit_of_kind(kind) == Some("%");
    let roles = Role::channels().filter(|role| *role != Role::Time);
    let each = roles.flat_map(|role| -> Vec<Hypothesis> {
        match percent(role.kind()) {
            true => Hypothesis::in_percent(role).collect(),
            false => Hypothesis::for_role(role).collect(),
        }
    });
    each.filter(|what| own.hypothesis_odds(what) > HOPELESS).collect()
}
