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

/// Number of columns without a name that single changes settle.
const OPEN: usize = 3;

/// Quantities that explain each other, which single changes may not find.
pub(crate) const COUPLED: [(Role, Role); 6] = [
    (Role::Psi, Role::R),
    (Role::X, Role::Y),
    (Role::Latitude, Role::Longitude),
    (Role::VNorth, Role::VEast),
    (Role::Phi, Role::P),
    (Role::DeltaS, Role::DeltaP),
];
/// Kinds of quantities whose units explain each other.
const UNIT_KINDS: [(QuantityKind, QuantityKind); 2] =
    [(QuantityKind::Length, QuantityKind::Speed), (QuantityKind::Angle, QuantityKind::Rate)];
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
        each.sum::<f64>()
            + self.physics.total_odds(of)
            + cooccurrence::set_odds(of)
            + self.shared_unit_odds(of)
            - 1e3 * kept as f64
    }

    /// Returns what several columns lose by the same unusual unit, except for one of them: a recorder
    /// has one unit for a kind of quantity.
    fn shared_unit_odds(&self, of: &Assignment) -> f64 {
        let mut seen: Vec<(QuantityKind, &str)> = Vec::new();
        let mut shared = 0.0;
        for (what, own) in of.columns.iter().zip(self.own) {
            let Some(what) = what else { continue };
            let (lost, unit) = (own.unusual_unit_loss(what), (what.role.kind(), what.unit.name));
            if seen.contains(&unit) {
                shared += lost;
            } else if lost > 0.0 {
                seen.push(unit);
            }
        }
        shared
    }

    /// Improves an assignment by single columns, signs, pairs of columns and exchanges until
    /// nothing gains; returns it with its log odds.
    pub(crate) fn improve_assignment(&self, start: Assignment) -> (Assignment, f64) {
        let (mut best, mut odds) = (start.clone(), self.assignment_odds(&start));
        for pass in 0..PASSES {
            let before = odds;
            // Pairs and exchanges cost most, and seldom gain anything after the second pass. Pairs
            // come first: single columns would take their places.
            if pass < 2 {
                COUPLED.iter().for_each(|&pair| self.try_pairs(pair, &mut best, &mut odds));
            }
            (0..self.own.len()).for_each(|column| self.try_column(column, &mut best, &mut odds));
            self.try_signs(&mut best, &mut odds);
            self.try_units(&mut best, &mut odds);
            if pass < 2 {
                self.try_roll(&mut best, &mut odds);
                self.try_axes(&mut best, &mut odds);
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

    /// Tries every unit for all columns of a kind at once, and for two kinds that explain each other.
    fn try_units(&self, best: &mut Assignment, odds: &mut f64) {
        for (one, other) in UNIT_KINDS {
            for a in one.known_units() {
                let first = self.in_unit(best, one, a.name);
                self.keep_if_better(first.clone(), best, odds);
                for b in other.known_units() {
                    self.keep_if_better(self.in_unit(&first, other, b.name), best, odds);
                }
            }
        }
    }

    /// Returns the assignment with all columns of a kind in one unit, where their evidence allows it.
    fn in_unit(&self, of: &Assignment, kind: QuantityKind, unit: &str) -> Assignment {
        let mut other = of.clone();
        for (at, what) in other.columns.iter_mut().enumerate() {
            let Some(what) = what.as_mut().filter(|what| what.role.kind() == kind) else {
                continue;
            };
            let same = |known: &&Hypothesis| {
                known.role == what.role
                    && known.is_reversed == what.is_reversed
                    && known.unit.name == unit
            };
            if let Some(known) = self.hypotheses[at].iter().find(same) {
                *what = *known;
            }
        }
        other
    }

    /// Tries roll and roll rate in place of heading and yaw rate, with another column as yaw rate.
    fn try_roll(&self, best: &mut Assignment, odds: &mut f64) {
        let (Some((i, _)), Some((j, _))) = (best.find(Role::Psi), best.find(Role::R)) else {
            return;
        };
        let (Some(psi), Some(r)) = (best.columns[i], best.columns[j]) else { return };
        let rolled = best
            .with_column(i, Some(Hypothesis { role: Role::Phi, ..psi }))
            .with_column(j, Some(Hypothesis { role: Role::P, ..r }));
        for k in (0..self.own.len()).filter(|&k| k != i && k != j) {
            for what in self.hypotheses_for(k, Role::R) {
                self.keep_if_better(rolled.with_column(k, Some(what)), best, odds);
            }
        }
        self.keep_if_better(rolled, best, odds);
    }

    /// Tries the axes of the earth the other way round, each with roll read as heading as well.
    fn try_axes(&self, best: &mut Assignment, odds: &mut f64) {
        for other in [best.clone(), swap_axes(best)] {
            for steers in [None, Some(false), Some(true)] {
                self.keep_if_better(roll_as_yaw(&other, steers), best, odds);
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

    /// Returns true if several columns have neither a name nor a reading that the user settles.
    pub(crate) fn has_open_columns(&self) -> bool {
        let is_open = |&at: &usize| self.own[at].is_open() && !self.is_settled(at);
        (0..self.own.len()).filter(is_open).count() > OPEN
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
                        let pair =
                            other_place(best, one).with_column(i, Some(a)).with_column(j, Some(b));
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

/// Returns the assignment with north and east exchanged, which no relation without a heading
/// distinguishes.
pub(crate) fn swap_axes(of: &Assignment) -> Assignment {
    let swapped = |what: Hypothesis| {
        let role = match what.role {
            Role::X => Role::Y,
            Role::Y => Role::X,
            Role::VNorth => Role::VEast,
            Role::VEast => Role::VNorth,
            _ => return what,
        };
        Hypothesis { role, is_reversed: what.is_reversed && role.is_signed(), ..what }
    };
    let columns = of.columns.iter().map(|one| one.map(swapped)).collect();
    Assignment { columns, ..of.clone() }
}

/// Returns the assignment with roll and roll rate as heading and yaw rate, and what was the yaw rate
/// as rudder, of the usual sign or reversed, or not read.
fn roll_as_yaw(of: &Assignment, steers: Option<bool>) -> Assignment {
    let rudder = |what: Hypothesis, is_reversed: bool| {
        let named = what.unit.name.split('/').next();
        let units = QuantityKind::Angle.known_units().iter();
        let unit = units.clone().find(|unit| Some(unit.name) == named).copied();
        unit.map(|unit| Hypothesis { role: Role::Delta, unit, is_reversed })
    };
    let turned = |what: Hypothesis| match what.role {
        Role::Phi => Some(Hypothesis { role: Role::Psi, ..what }),
        Role::P => Some(Hypothesis { role: Role::R, ..what }),
        Role::R => steers.and_then(|is_reversed| rudder(what, is_reversed)),
        Role::Delta if steers.is_some() => None,
        Role::Psi => None,
        _ => Some(what),
    };
    let columns = of.columns.iter().map(|one| one.and_then(turned)).collect();
    Assignment { columns, ..of.clone() }
}

/// Returns the assignment without positions of the other form, of which only one makes the track.
fn other_place(of: &Assignment, role: Role) -> Assignment {
    let others = match role {
        Role::X => [Role::Latitude, Role::Longitude],
        Role::Latitude => [Role::X, Role::Y],
        _ => return of.clone(),
    };
    let mut free = of.clone();
    let is_other = |what: &Hypothesis| others.contains(&what.role);
    free.columns.iter_mut().for_each(|one| *one = one.filter(|what| !is_other(what)));
    free
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
