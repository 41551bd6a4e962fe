//! The assignment with the highest log odds: header, values and relations of all columns together.

use crate::hypothesis::{Assignment, Hypothesis};
use crate::own::OwnEvidence;
use crate::physics::Physics;
use crate::role::{Kind, Role, Unit};
use crate::whole;

/// Log odds by themselves below which a hypothesis is not looked at.
const HOPELESS: f64 = -9.0;
/// Log odds of a name that is clear.
const NAMED: f64 = 3.0;
/// Passes over all columns; the assignment seldom changes after the third.
const PASSES: usize = 8;
/// Pairs of columns that are tried together, of those that most likely are the two quantities.
const PAIRS: usize = 16;

/// Quantities that explain each other, and may be found only together.
const COUPLED: [(Role, Role); 5] = [
    (Role::Psi, Role::R),
    (Role::Phi, Role::P),
    (Role::X, Role::Y),
    (Role::Latitude, Role::Longitude),
    (Role::VNorth, Role::VEast),
];
/// Quantities whose signs may be changed together without a relation between them noticing.
const SIGNED: [&[Role]; 5] = [
    &[Role::Delta, Role::DeltaS, Role::DeltaP],
    &[Role::R, Role::Delta, Role::DeltaS, Role::DeltaP],
    &[Role::Psi, Role::R, Role::Delta, Role::DeltaS, Role::DeltaP],
    &[Role::Y, Role::Psi],
    &[Role::Phi, Role::P],
];

/// A column that the user has settled: what it is, or nothing for one that is left out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Settled {
    pub column: usize,
    pub what: Option<Hypothesis>,
}

/// Everything that the log odds of an assignment are made of.
pub(crate) struct Search<'a> {
    pub own: &'a [OwnEvidence],
    pub physics: Physics<'a>,
    /// What each column may be; a column that is settled has one entry or none.
    pub hypotheses: Vec<Vec<Hypothesis>>,
    pub settled: Vec<Settled>,
    pub time: Option<usize>,
}

impl<'a> Search<'a> {
    pub(crate) fn new(
        own: &'a [OwnEvidence],
        physics: Physics<'a>,
        time: Option<usize>,
        settled: Vec<Settled>,
    ) -> Self {
        let hypotheses = own.iter().enumerate().map(|(at, own)| {
            match settled.iter().find(|one| one.column == at) {
                _ if time == Some(at) => Vec::new(),
                Some(settled) => settled.what.into_iter().collect(),
                None => hypotheses(own),
            }
        });
        Self { own, physics, hypotheses: hypotheses.collect(), settled, time }
    }

    /// Log odds of an assignment.
    pub(crate) fn odds(&self, of: &Assignment) -> f64 {
        let each = of.columns.iter().zip(self.own).map(|(what, own)| match what {
            Some(what) => own.odds(what),
            None => own.none(),
        });
        let kept = self.settled.iter().filter(|one| of.columns[one.column] != one.what).count();
        each.sum::<f64>() + self.physics.odds(of) + whole::odds(of) - 1e3 * kept as f64
    }

    /// An assignment improved by pairs of columns, single columns and signs, until nothing gains.
    pub(crate) fn improved(&self, start: Assignment) -> (Assignment, f64) {
        let (mut best, mut odds) = (start.clone(), self.odds(&start));
        for pass in 0..PASSES {
            let before = odds;
            (0..self.own.len()).for_each(|column| self.single(column, &mut best, &mut odds));
            self.signs(&mut best, &mut odds);
            if pass < 1 {
                COUPLED.iter().for_each(|&pair| self.pairs(pair, &mut best, &mut odds));
                self.swaps(&mut best, &mut odds);
            }
            if odds <= before {
                break;
            }
        }
        (best, odds)
    }

    /// Signs of several quantities at once.
    fn signs(&self, best: &mut Assignment, odds: &mut f64) {
        for group in SIGNED {
            let mut other = best.clone();
            for what in other.columns.iter_mut().flatten().filter(|what| group.contains(&what.role))
            {
                what.is_reversed = !what.is_reversed;
            }
            self.try_one(other, best, odds);
        }
    }

    /// Each column by itself, the clearest first.
    pub(crate) fn start(&self, time_factor: f64) -> Assignment {
        let columns = vec![None; self.own.len()];
        let mut start = Assignment { columns, time_factor };
        let mut all: Vec<(f64, usize, Hypothesis)> = Vec::new();
        for (at, own) in self.own.iter().enumerate() {
            let each =
                self.hypotheses[at].iter().map(|what| (own.odds(what) - own.none(), at, *what));
            all.extend(each.filter(|one| one.0 > 0.0 || self.is_settled(at)));
        }
        all.sort_by(|a, b| b.0.total_cmp(&a.0));
        for (_, at, what) in all {
            if start.columns[at].is_none() && !start.has(what.role) {
                start.columns[at] = Some(what);
            }
        }
        start
    }

    fn is_settled(&self, column: usize) -> bool {
        self.settled.iter().any(|one| one.column == column)
    }

    fn single(&self, column: usize, best: &mut Assignment, odds: &mut f64) {
        if self.time == Some(column) {
            return;
        }
        let choices = self.hypotheses[column].iter().copied().map(Some).chain([None]);
        for choice in choices {
            self.try_one(best.with(column, choice), best, odds);
        }
    }

    fn try_one(&self, other: Assignment, best: &mut Assignment, odds: &mut f64) {
        if other == *best {
            return;
        }
        let found = self.odds(&other);
        if found > *odds + 1e-9 {
            (*best, *odds) = (other, found);
        }
    }

    /// Two columns for what the other was taken for.
    fn swaps(&self, best: &mut Assignment, odds: &mut f64) {
        for i in 0..self.own.len() {
            for j in 0..i {
                let (Some(a), Some(b)) = (best.columns[i], best.columns[j]) else { continue };
                for a in self.of_role(j, a.role).collect::<Vec<_>>() {
                    for b in self.of_role(i, b.role).collect::<Vec<_>>() {
                        let other = best.with(j, Some(a)).with(i, Some(b));
                        self.try_one(other, best, odds);
                    }
                }
            }
        }
    }

    pub(crate) fn of_role(
        &self,
        column: usize,
        role: Role,
    ) -> impl Iterator<Item = Hypothesis> + '_ {
        self.hypotheses[column].iter().copied().filter(move |what| what.role == role)
    }

    /// Two columns at once; those that by themselves and by their relation are likeliest.
    fn pairs(&self, (one, other): (Role, Role), best: &mut Assignment, odds: &mut f64) {
        let named = |role: Role| {
            let found = best.find(role);
            found.is_some_and(|(at, _)| self.own[at].named(role) >= NAMED)
        };
        if named(one) && named(other) {
            return;
        }
        let mut likely: Vec<(f64, Assignment)> = Vec::new();
        for i in 0..self.own.len() {
            for a in self.of_role(i, one) {
                for j in (0..self.own.len()).filter(|&j| j != i) {
                    for b in self.of_role(j, other) {
                        let pair = best.with(i, Some(a)).with(j, Some(b));
                        let alone = self.own[i].odds(&a) + self.own[j].odds(&b);
                        likely.push((alone + self.together((one, other), &pair), pair));
                    }
                }
            }
        }
        likely.sort_by(|a, b| b.0.total_cmp(&a.0));
        for (_, pair) in likely.into_iter().take(PAIRS) {
            self.try_one(pair, best, odds);
        }
    }

    fn together(&self, pair: (Role, Role), of: &Assignment) -> f64 {
        let relation = match pair {
            (Role::Psi, Role::R) | (Role::Phi, Role::P) => {
                self.physics.rate(of, pair.0, pair.1, "")
            }
            (Role::X, Role::Y) | (Role::Latitude, Role::Longitude) => {
                return self
                    .physics
                    .track(of)
                    .map_or(0.0, |track| track.odds(self.physics.observed, of));
            }
            (Role::VNorth, Role::VEast) => {
                let of_axis = |whole, rate| self.physics.rate(of, whole, rate, "");
                let both = [of_axis(Role::X, Role::VNorth), of_axis(Role::Y, Role::VEast)];
                return both.into_iter().flatten().map(|relation| relation.odds).sum();
            }
            _ => return self.physics.odds(of),
        };
        relation.map_or(0.0, |relation| relation.odds)
    }
}

/// What a column may be by itself.
fn hypotheses(own: &OwnEvidence) -> Vec<Hypothesis> {
    let percent = |kind: Kind| own.header.unit(kind) == Some("%");
    let roles = Role::channels().filter(|role| *role != Role::Time);
    let each = roles.flat_map(|role| {
        let of_percent = percent(role.kind()).then_some(Unit { name: "%", to_si: 0.01 });
        let all: Vec<Hypothesis> = Hypothesis::of_role(role).collect();
        let first = all.first().copied();
        match (of_percent, first) {
            (Some(unit), Some(first)) => vec![Hypothesis { unit, ..first }],
            _ => all,
        }
    });
    each.filter(|what| own.odds(what) > HOPELESS).collect()
}
