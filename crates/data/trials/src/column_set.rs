//! Sets of columns that several files share: identified once, from the rows of all files.

use indexmap::IndexMap;
use sistership_columns::{
    AlternativeReading, GivenColumn, Identification, IdentifiedColumn, RecordingSample, Role,
    identify_columns,
};
use sistership_model::manifest::ColumnMapping;

use crate::guess::ColumnGuess;
use crate::preview::FilePreview;
use crate::table::ColumnTarget;
use crate::thruster_guess::ThrusterColumns;
use crate::units::UnitKind;

/// Largest number of rows of all files that are compared.
const ROWS: usize = 60_000;

/// Columns that several files share, and their identification.
#[derive(Debug, Clone, Default)]
pub(crate) struct ColumnSet {
    names: Vec<String>,
    units: Vec<String>,
    /// Channels of NMEA sentences, which need no mapping.
    sentences: Vec<(String, ColumnTarget)>,
    sample: RecordingSample,
    pub columns: IndexMap<String, ColumnMapping>,
    /// Identified content of each column, without the name of the file.
    pub guesses: Vec<ColumnGuess>,
    /// Index of the time column, and its factor to seconds.
    pub time: Option<(usize, f64)>,
    /// Notes on combinations of columns.
    pub notes: Vec<String>,
    /// True if a pair of thrusters is recorded by its commands.
    pub has_commands: bool,
}

impl ColumnSet {
    pub(crate) fn new(preview: &FilePreview) -> Self {
        Self {
            names: preview.names.clone(),
            units: preview.units.clone(),
            sentences: preview.sentences.clone(),
            ..Self::default()
        }
    }

    /// Returns true if a file has these columns.
    pub(crate) fn matches_preview(&self, preview: &FilePreview) -> bool {
        // Logs of NMEA sentences need no identification, and keep a set of their own.
        let sentences = self.sentences.is_empty() && preview.sentences.is_empty();
        sentences && self.names == preview.names && self.units == preview.units
    }

    /// Adds the rows of a file.
    pub(crate) fn add_sample(&mut self, sample: &RecordingSample) {
        if self.sample.columns.is_empty() {
            self.sample = sample.clone();
            return;
        }
        let rows = self.sample.len();
        if rows + sample.len() > ROWS {
            return;
        }
        // No step is formed from one file to the next.
        self.sample.breaks.push(rows);
        for (column, further) in self.sample.columns.iter_mut().zip(&sample.columns) {
            column.values.extend_from_slice(&further.values);
        }
    }

    /// Identifies the columns, and releases the sample.
    pub(crate) fn identify_all(&mut self, given: &[GivenColumn]) {
        for (name, target) in &self.sentences {
            self.guesses.push(guess_sentence(name, *target));
        }
        let found = identify_columns(&self.sample, given);
        for (at, column) in found.columns.iter().enumerate() {
            let guess = guess_column(column, &found);
            if column.role == Some(Role::Time) {
                self.time = Some((at, unit_seconds(&column.unit)));
            }
            if let (Some(channel), Some(unit)) = (&guess.channel, &guess.unit) {
                let mapping = ColumnMapping {
                    reversed: guess.reversed,
                    ..ColumnMapping::new(&guess.column, unit)
                };
                self.columns.insert(channel.clone(), mapping);
            }
            self.guesses.push(guess);
        }
        if let Some(pair) = ThrusterColumns::from_identification(&found, &self.sample) {
            pair.settle_guesses(&mut self.guesses[self.sentences.len()..]);
            let columns = pair.columns.iter().map(|(name, one)| ((*name).to_owned(), one.clone()));
            self.columns.extend(columns);
            self.notes.push(pair.format_note());
            self.has_commands = true;
        }
        // The samples may be large, and are not needed any more.
        self.sample = RecordingSample::default();
    }

    /// Returns true if it has a channel of that name.
    pub(crate) fn has_channel(&self, name: &str) -> bool {
        let told = || self.sentences.iter().any(|(_, held)| held.name() == name);
        self.columns.contains_key(name) || told()
    }

    fn has_any(&self, names: &[&str]) -> bool {
        names.iter().any(|name| self.has_channel(name))
    }

    /// Returns true if it is a complete trial: time, steering or propulsion, turning and speed.
    pub(crate) fn is_complete(&self) -> bool {
        let commands = self.has_any(&["delta", "delta_s", "delta_p", "n", "n_s", "n_p"]);
        let speed = self.has_any(&["u", "speed", "x", "latitude", "v_north"]);
        commands && speed && self.has_any(&["r", "psi"])
    }

    /// Returns the number of channels besides time.
    pub(crate) fn channel_count(&self) -> usize {
        self.columns.len() + self.sentences.len()
    }

    /// Returns true if the sign of the rudder is reversed; `None` if there is no rudder.
    pub(crate) fn is_rudder_reversed(&self) -> Option<bool> {
        let rudder =
            ["delta", "delta_s", "delta_p"].into_iter().find_map(|one| self.columns.get(one));
        rudder.map(|column| column.reversed)
    }
}

fn unit_seconds(unit: &str) -> f64 {
    match unit {
        // Days of a sheet were converted to seconds when the sample was read.
        "excel" => 1.0,
        unit => UnitKind::Time.unit_to_si(unit).unwrap_or(1.0),
    }
}

fn guess_sentence(name: &str, target: ColumnTarget) -> ColumnGuess {
    ColumnGuess {
        file: String::new(),
        column: name.to_owned(),
        channel: Some(target.name().to_owned()),
        unit: Some(UnitKind::from_target(target).canonical_unit().to_owned()),
        reversed: false,
        probability: 1.0,
        why: "defined by the NMEA 0183 sentence".into(),
        certain: true,
        question: None,
    }
}

fn guess_column(column: &IdentifiedColumn, all: &Identification) -> ColumnGuess {
    let nothing = |why: String, certain: bool| ColumnGuess {
        file: String::new(),
        column: column.header.clone(),
        channel: None,
        unit: None,
        reversed: false,
        probability: column.probability,
        why,
        certain,
        question: alternative_question(column),
    };
    let Some(role) = column.role else {
        return nothing(format!("ignored: {}", column.reason), column.is_certain);
    };
    // Certain, since the column is left out by rule and not by evidence.
    if let Some(why) = redundancy_reason(role, all) {
        return nothing(why, true);
    }
    let role = effective_role(role, all);
    if ColumnTarget::from_name(role.name()).is_none() {
        return nothing(format!("ignored: there is no channel for {}", role.name()), true);
    }
    ColumnGuess {
        file: String::new(),
        column: column.header.clone(),
        channel: Some(role.name().to_owned()),
        unit: Some(column.unit.clone()),
        reversed: column.is_reversed,
        probability: column.probability,
        why: guess_reason(column, role),
        // A percentage needs a declared maximum, and a changed role a confirmation by the user.
        certain: column.is_certain && column.unit != "%" && Some(role) == column.role,
        question: alternative_question(column),
    }
}

fn guess_reason(column: &IdentifiedColumn, role: Role) -> String {
    if column.unit == "%" {
        let maximum = format!("declare what 100 % is as `maximum` of {}", role.name());
        return format!("{}; a percentage, so {maximum}", column.reason);
    }
    if Some(role) != column.role {
        return format!(
            "{}; without further motion data, the speed over ground is used as the \
                        speed ahead",
            column.reason
        );
    }
    column.reason.clone()
}

/// Returns the reason for which a column is not read if another gives the same.
fn redundancy_reason(role: Role, all: &Identification) -> Option<String> {
    let has = |role: Role| all.find(role).is_some();
    let metres = has(Role::X) && has(Role::Y);
    let body = has(Role::U) && has(Role::V);
    match role {
        Role::Latitude | Role::Longitude if metres => {
            Some("ignored: positions in metres are read instead".into())
        }
        Role::Course | Role::Speed | Role::VNorth | Role::VEast if body => {
            Some("ignored: u and v are read instead".into())
        }
        Role::Course | Role::Speed if has(Role::VNorth) && has(Role::VEast) => {
            Some("ignored: velocities north and east are read instead".into())
        }
        _ => None,
    }
}

/// Returns the role of a column; a speed over ground without other motion data is the speed ahead.
fn effective_role(role: Role, all: &Identification) -> Role {
    let has = |role: Role| all.find(role).is_some();
    let alone = ![Role::U, Role::Course, Role::X, Role::Latitude].into_iter().any(has);
    if role == Role::Speed && alone { Role::U } else { role }
}

/// Returns the question to the user if an alternative is nearly as likely, and how to answer it.
fn alternative_question(column: &IdentifiedColumn) -> Option<String> {
    let other = column.alternative.as_ref()?;
    let first = AlternativeReading {
        role: column.role,
        unit: column.unit.clone(),
        is_reversed: column.is_reversed,
        probability: column.probability,
    };
    let text = |one: &AlternativeReading| match one.role {
        Some(role) if one.is_reversed => format!("{} in {}, reversed", role.name(), one.unit),
        Some(role) => format!("{} in {}", role.name(), one.unit),
        None => "not used".to_owned(),
    };
    // Argument of the command line that settles the column in this way.
    let flag = |one: &AlternativeReading| match one.role {
        Some(role) => {
            let reversed = if one.is_reversed { ":reversed" } else { "" };
            format!("--column '{}={}:{}{reversed}'", column.header, role.name(), one.unit)
        }
        None => format!("--column '{}='", column.header),
    };
    Some(format!(
        "Is `{}` {} ({:.0} %) or {} ({:.0} %)? Answer with {} or {}",
        column.header,
        text(&first),
        100.0 * first.probability,
        text(other),
        100.0 * other.probability,
        flag(&first),
        flag(other)
    ))
}
