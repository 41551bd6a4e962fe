//! Identification of the columns of a recording.

use crate::annealing::anneal_assignments;
use crate::data::RecordingSample;
use crate::hypothesis::{Assignment, Hypothesis};
use crate::outcome::{AlternativeReading, Identification, IdentifiedColumn};
use crate::own_evidence::OwnEvidence;
use crate::physics::PhysicalEvidence;
use crate::relation::ColumnRelation;
use crate::role::{QuantityKind, Role};
use crate::search::{AssignmentSearch, SettledColumn, swap_axes};
use crate::signals::RecordingSignals;
use crate::starts;
use crate::thrusters;
use crate::time::{self, TimeUnit};

/// Probability from which a column needs no confirmation by the user.
const CERTAIN: f64 = 0.97;
/// Log odds of a name, and of relations, that support a hypothesis by themselves.
const NAMED: f64 = 3.0;
const RELATED: f64 = 8.0;
/// The same for relations in a file whose other columns have no names either.
const RELATED_ALONE: f64 = 25.0;
/// Log odds from which a relation is mentioned in the reason.
const REPORTED_ODDS: f64 = 3.0;
/// Probability of an alternative from which it is reported.
const ALTERNATIVE_PROBABILITY: f64 = 0.15;
/// Log odds below the best within which the optima of a unit of time are searched further.
const NEAR: f64 = 8.0;
/// Probability below which a column that its name does not support is left unassigned.
const ACCEPTED_PROBABILITY: f64 = 0.45;

/// Column whose content is given by the user.
#[derive(Debug, Clone, PartialEq)]
pub struct GivenColumn {
    /// Header of the column.
    pub header: String,
    /// Quantity of the column; `None` for a column that is not to be read.
    pub role: Option<Role>,
    /// Unit by its name in manifests; `None` for the likeliest.
    pub unit: Option<String>,
    /// True if the sign of the column is opposite to that of the channel; `None` for the likelier
    /// sign.
    pub is_reversed: Option<bool>,
}

/// Identifies the columns of a recording by headers, values and the relations between them.
pub fn identify_columns(recording: &RecordingSample, given: &[GivenColumn]) -> Identification {
    // The time column is found from the evidence of single columns; relations between columns need
    // its integrals, so that the signals are computed again once it is known.
    let plain = RecordingSignals::new(recording, None);
    let mut own: Vec<OwnEvidence> = recording
        .columns
        .iter()
        .zip(&plain.summaries)
        .map(|(column, summary)| OwnEvidence::new(column, summary))
        .collect();
    OwnEvidence::mark_nameless(&mut own);
    let time = given_time(recording, given).or_else(|| time::time_column(&recording.columns, &own));
    let units = time.map_or(Vec::new(), |at| time_units(recording, &own, at, given));
    let signals = RecordingSignals::new(recording, time);
    let fallback = TimeUnit { name: "s", to_si: 1.0, odds: 0.0 };
    let units = if units.is_empty() { vec![fallback] } else { units };
    let search = AssignmentSearch::new(
        &own,
        PhysicalEvidence::new(&signals),
        time,
        settled_columns(recording, &own, given),
    );
    // One search for each unit of time: the relations decide between the units.
    let found = units.iter().flat_map(|unit| {
        let optima = starts::local_optima(&search, unit.to_si).into_iter();
        optima.map(|(best, odds)| (*unit, best, odds + unit.odds))
    });
    let mut found: Vec<TimedOptimum> = found.collect();
    if search.has_open_columns() {
        found.extend(annealed_optima(&search, &units, &found));
    }
    found.sort_by(|a, b| b.2.total_cmp(&a.2));
    let Some((unit, best, _)) = found.first().cloned() else { return Identification::default() };
    // Figures for the reader are computed for the best assignment only.
    let swapped = swap_axes(&best);
    let odds = search.assignment_odds(&swapped) + unit.odds;
    found.push((unit, swapped, odds));
    let physics = PhysicalEvidence::with_figures(&signals);
    let outcome =
        AssignmentReport { search: &search, best: &best, relations: physics.find_relations(&best) };
    let mut columns: Vec<IdentifiedColumn> = recording
        .columns
        .iter()
        .enumerate()
        .map(|(at, column)| outcome.describe_column(at, &column.header))
        .collect();
    // A column that another optimum reads otherwise is as uncertain as that optimum is likely.
    for (at, column) in columns.iter_mut().enumerate() {
        let others = found.iter().filter(|other| other.1.columns[at] != best.columns[at]);
        let odds = others.map(|other| other.2 - found[0].2).fold(f64::NEG_INFINITY, f64::max);
        column.probability = column.probability.min(1.0 / (1.0 + odds.exp()));
        column.is_certain = column.is_certain && column.probability > CERTAIN;
    }
    if let Some(at) = time {
        let second = found.iter().find(|other| other.0.name != unit.name);
        let second = second.map(|other| (other.0, other.2 - found[0].2));
        columns[at] = identify_time(&recording.columns[at].header, &own[at], unit, second);
        for rival in time::rival_clocks(&own, at) {
            (columns[at].is_certain, columns[rival].is_certain) = (false, false);
        }
    }
    let thrusters = thrusters::find_thrusters(&own, &signals, &best);
    Identification { columns, thrusters }
}

/// Unit of time, assignment of the columns, and log odds of both.
type TimedOptimum = (TimeUnit, Assignment, f64);

/// Returns further optima by annealing, for each unit of time that is nearly as likely as the best.
fn annealed_optima(
    search: &AssignmentSearch,
    units: &[TimeUnit],
    found: &[TimedOptimum],
) -> Vec<TimedOptimum> {
    let most = found.iter().map(|one| one.2).fold(f64::NEG_INFINITY, f64::max);
    let best_of = |unit: &TimeUnit| {
        let own = found.iter().filter(|one| one.0.name == unit.name && one.2 > most - NEAR);
        own.max_by(|a, b| a.2.total_cmp(&b.2))
    };
    let annealed = |one: &TimedOptimum| -> Vec<TimedOptimum> {
        let each = anneal_assignments(search, &one.1).into_iter();
        each.map(|(best, odds)| (one.0, best, odds + one.0.odds)).collect()
    };
    units.iter().filter_map(best_of).flat_map(annealed).collect()
}

fn given_time(recording: &RecordingSample, given: &[GivenColumn]) -> Option<usize> {
    let given = given.iter().find(|one| one.role == Some(Role::Time))?;
    recording.columns.iter().position(|column| column.header == given.header)
}

fn time_units(
    recording: &RecordingSample,
    own: &[OwnEvidence],
    at: usize,
    given: &[GivenColumn],
) -> Vec<TimeUnit> {
    let named = given.iter().find(|one| one.role == Some(Role::Time));
    let unit = named.and_then(|one| one.unit.as_deref());
    let all = time::candidate_units(&recording.columns[at], &own[at]);
    let known = Role::Time.kind().known_units().iter().find(|known| Some(known.name) == unit);
    match known {
        Some(known) => vec![TimeUnit { name: known.name, to_si: known.to_si, odds: 0.0 }],
        None => all,
    }
}

fn settled_columns(
    recording: &RecordingSample,
    own: &[OwnEvidence],
    given: &[GivenColumn],
) -> Vec<SettledColumn> {
    let of = |one: &GivenColumn| {
        let column = recording.columns.iter().position(|known| known.header == one.header)?;
        let role = one.role.filter(|role| *role != Role::Time);
        let fits = |what: &Hypothesis| {
            one.unit.as_deref().is_none_or(|unit| unit == what.unit.name)
                && one.is_reversed.is_none_or(|is_reversed| is_reversed == what.is_reversed)
        };
        // Of the hypotheses that the user's unit and sign allow the likeliest by header and values.
        let odds = |what: &Hypothesis| own[column].hypothesis_odds(what);
        let what = role.and_then(|role| {
            let all = Hypothesis::for_role(role).chain(Hypothesis::in_percent(role)).filter(fits);
            all.reduce(|best, next| if odds(&next) > odds(&best) { next } else { best })
        });
        (one.role != Some(Role::Time)).then_some(SettledColumn { column, what })
    };
    given.iter().filter_map(of).collect()
}

fn identify_time(
    header: &str,
    own: &OwnEvidence,
    unit: TimeUnit,
    second: Option<(TimeUnit, f64)>,
) -> IdentifiedColumn {
    // `odds` of the second unit is its log odds relative to the best, hence at most 0.
    let other = second.map_or(0.0, |(_, odds)| odds.exp());
    let probability = 1.0 / (1.0 + other);
    let named = own.name_odds(Role::Time) >= NAMED;
    let step = own.summary.step * unit.to_si;
    let name = if named { "by name; " } else { "" };
    let alternative =
        second.filter(|_| 1.0 - probability > ALTERNATIVE_PROBABILITY).map(|(unit, _)| {
            AlternativeReading {
                role: Some(Role::Time),
                unit: unit.name.into(),
                is_reversed: false,
                probability: 1.0 - probability,
            }
        });
    IdentifiedColumn {
        header: header.to_owned(),
        role: Some(Role::Time),
        unit: unit.name.into(),
        is_reversed: false,
        probability,
        is_certain: probability > CERTAIN && (named || own.summary.regular > 0.9),
        reason: format!("{name}its steps are {step:.3} s if the unit is `{}`", unit.name),
        alternative,
        other: None,
    }
}

/// Best assignment, from which the result of each column is written.
struct AssignmentReport<'a> {
    search: &'a AssignmentSearch<'a>,
    best: &'a Assignment,
    relations: Vec<ColumnRelation>,
}

impl AssignmentReport<'_> {
    fn describe_column(&self, at: usize, header: &str) -> IdentifiedColumn {
        let own = &self.search.own[at];
        let what = self.best.columns[at];
        let mut all = self.alternative_odds(at);
        // Softmax of the log odds, shifted by their maximum against overflow.
        let most = all.iter().map(|one| one.1).fold(f64::NEG_INFINITY, f64::max);
        let sum: f64 = all.iter().map(|one| (one.1 - most).exp()).sum();
        all.iter_mut().for_each(|one| one.1 = (one.1 - most).exp() / sum);
        let probability = all.iter().find(|one| one.0 == what).map_or(0.0, |one| one.1);
        let other = all.iter().filter(|one| one.0 != what).max_by(|a, b| a.1.total_cmp(&b.1));
        let alternative =
            other.filter(|one| one.1 > ALTERNATIVE_PROBABILITY).map(|one| AlternativeReading {
                role: one.0.map(|what| what.role),
                unit: one.0.map_or("", |what| what.unit.name).into(),
                is_reversed: one.0.is_some_and(|what| what.is_reversed),
                probability: one.1,
            });
        let named = what.is_some_and(|what| own.name_odds(what.role) >= NAMED);
        if what.is_some() && !named && probability < ACCEPTED_PROBABILITY {
            return self.unassigned_column(at, header, probability);
        }
        IdentifiedColumn {
            header: header.to_owned(),
            role: what.map(|what| what.role),
            unit: what.map_or("", |what| what.unit.name).to_owned(),
            is_reversed: what.is_some_and(|what| what.is_reversed),
            probability,
            is_certain: self.is_certain(at, probability),
            reason: self.evidence_text(at),
            alternative,
            other: own
                .header
                .other_quantity()
                .filter(|_| what.is_none())
                .map(|(name, _)| name.to_owned()),
        }
    }

    /// Returns the result of a column whose best hypothesis is too unlikely to be accepted.
    fn unassigned_column(&self, at: usize, header: &str, probability: f64) -> IdentifiedColumn {
        let what = self.best.columns[at];
        let alternative = what.map(|what| AlternativeReading {
            role: Some(what.role),
            unit: what.unit.name.into(),
            is_reversed: what.is_reversed,
            probability,
        });
        IdentifiedColumn {
            header: header.to_owned(),
            role: None,
            unit: String::new(),
            is_reversed: false,
            probability: 1.0 - probability,
            is_certain: false,
            reason: "neither its name nor its values identify it".into(),
            alternative,
            other: None,
        }
    }

    /// Returns every hypothesis of a column with its log odds, the other columns as assigned.
    fn alternative_odds(&self, at: usize) -> Vec<(Option<Hypothesis>, f64)> {
        let each = self.search.hypotheses[at].iter().copied().map(Some).chain([None]);
        let mut all: Vec<(Option<Hypothesis>, f64)> = each
            .map(|what| (what, self.search.assignment_odds(&self.best.with_column(at, what))))
            .collect();
        let best = self.best.columns[at];
        if !all.iter().any(|one| one.0 == best) {
            all.push((best, self.search.assignment_odds(self.best)));
        }
        all
    }

    fn is_certain(&self, at: usize, probability: f64) -> bool {
        let own = &self.search.own[at];
        let Some(what) = self.best.columns[at] else {
            // A column that is not read is certain if its header, its counting of rows or its being
            // empty says why.
            let known = own.header.other_quantity().is_some() || own.summary.is_counter;
            return known || own.summary.count == 0;
        };
        let settled = self.search.settled.iter().any(|one| one.column == at);
        let related = if self.search.has_open_columns() { RELATED_ALONE } else { RELATED };
        let borne = own.name_odds(what.role) >= NAMED || self.relation_odds(what.role) >= related;
        settled || (probability > CERTAIN && borne && self.has_settled_unit(at, what.role))
    }

    /// Returns true if header or positions settle the unit: of a speed nothing else does, since
    /// knots and m/s are alike in size.
    fn has_settled_unit(&self, at: usize, role: Role) -> bool {
        let is_place = |role: &Role| matches!(role, Role::X | Role::Y | Role::Latitude);
        let is_track = |one: &ColumnRelation| {
            one.roles.contains(&role) && one.roles.iter().any(is_place) && one.odds >= RELATED
        };
        role.kind() != QuantityKind::Speed
            || self.search.own[at].header.unit_of_kind(QuantityKind::Speed).is_some()
            || self.relations.iter().any(is_track)
    }

    fn relation_odds(&self, role: Role) -> f64 {
        let of_role = self.relations.iter().filter(|one| one.roles.contains(&role));
        of_role.map(|one| one.odds).sum()
    }

    fn evidence_text(&self, at: usize) -> String {
        let own = &self.search.own[at];
        let Some(what) = self.best.columns[at] else {
            return match own.header.other_quantity() {
                Some((name, _)) => format!("{name}, for which there is no channel"),
                None if own.summary.count == 0 => "it contains no numbers".into(),
                None if own.summary.is_counter => "it counts rows".into(),
                None => "neither its name nor its values identify it".into(),
            };
        };
        let mut parts = Vec::new();
        if own.name_odds(what.role) >= NAMED {
            parts.push("by name".to_owned());
        }
        let mut relations: Vec<&ColumnRelation> = self
            .relations
            .iter()
            .filter(|one| one.roles.contains(&what.role) && one.odds.abs() > REPORTED_ODDS)
            .collect();
        relations.sort_by(|a, b| b.odds.abs().total_cmp(&a.odds.abs()));
        parts.extend(relations.iter().take(2).map(|one| one.figure.clone()));
        if what.is_reversed {
            parts.push("its sign is reversed".to_owned());
        }
        if parts.is_empty() {
            parts.push("by its range and the channels not found elsewhere".to_owned());
        }
        parts.join("; ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::ColumnData;

    #[test]
    fn a_given_quantity_has_the_unit_of_its_header() {
        let column = |header: &str, values: [f64; 4]| ColumnData {
            header: header.into(),
            values: values.to_vec(),
            ..ColumnData::default()
        };
        let columns = vec![
            column("t_s", [0.0, 1.0, 2.0, 3.0]),
            column("left_rps", [20.0, 21.0, 20.5, 20.0]),
            column("right_rpm", [20.0, 21.0, 20.5, 20.0]),
        ];
        let given = |header: &str, role| GivenColumn {
            header: header.into(),
            role: Some(role),
            unit: None,
            is_reversed: None,
        };
        let recording = RecordingSample { columns, breaks: Vec::new() };
        let given = [given("left_rps", Role::NP), given("right_rpm", Role::NS)];
        let found = identify_columns(&recording, &given).columns;
        assert_eq!(found[1].unit, "rps");
        assert_eq!(found[2].unit, "rpm");
    }
}
