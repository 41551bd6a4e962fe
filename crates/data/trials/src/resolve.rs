//! Resolution of the headers of a file to the columns that are read.

use sistership_model::manifest::{VelocityFrame, WindKind};
use sistership_model::trial::Channel;

use crate::declarations::Declarations;
use crate::findings::Findings;
use crate::mapping::{Mapping, WrittenTime};
use crate::names;
use crate::table::{ColumnTarget, RawQuantity, TableColumn};
use crate::units::{UnitKind, plain_unit};

/// Similarity of two names (Jaro-Winkler, 0 to 1) from which one is suggested for the other.
const ALIKE: f64 = 0.8;
/// Largest number of column names in a message.
const LISTED: usize = 40;

/// Returns the columns to read of a file whose first row is its header, or `None` after errors.
pub(crate) fn resolve_headers(
    headers: &[String],
    mapping: &Mapping,
    findings: &mut Findings,
) -> Option<Vec<TableColumn>> {
    resolve_heading(HeaderRows { names: headers, units: &[], row: 1 }, mapping, findings)
}

/// Header of a table.
#[derive(Debug, Clone, Copy)]
pub(crate) struct HeaderRows<'a> {
    pub names: &'a [String],
    /// Units in a row of their own, or empty.
    pub units: &'a [String],
    /// Row of the names.
    pub row: usize,
}

/// Returns the columns to read, or `None` after errors.
pub(crate) fn resolve_heading(
    heading: HeaderRows,
    mapping: &Mapping,
    findings: &mut Findings,
) -> Option<Vec<TableColumn>> {
    if let Some(time) = &mapping.unidentified {
        return Some(unidentified_columns(heading, time));
    }
    let HeaderRows { names: headers, units, row } = heading;
    let mut resolver =
        ColumnResolver { headers, units, row, mapping, columns: Vec::new(), findings };
    // In order of precedence: a column or a channel that one step takes is closed to the next.
    resolver.add_mapped();
    resolver.add_canonical();
    resolver.add_raw();
    resolver.add_time();
    resolver.report_duplicates();
    resolver.require_columns();
    resolver.report_ignored();
    let ColumnResolver { columns, findings, .. } = resolver;
    (!findings.has_errors()).then_some(columns)
}

/// Returns every column unconverted.
fn unidentified_columns(heading: HeaderRows, time: &WrittenTime) -> Vec<TableColumn> {
    let of_column = |(index, header): (usize, &String)| {
        let unit = time.0.filter(|(at, _)| *at == index).map(|(_, unit)| unit);
        let target = match unit {
            Some(_) => ColumnTarget::Time,
            None => ColumnTarget::Unidentified(u16::try_from(index).unwrap_or(u16::MAX)),
        };
        let unit = unit.unwrap_or("1").to_owned();
        // Days of a sheet become seconds here; other written times are seconds once the clock has
        // read them.
        let to_si = if unit == "excel" { 86_400.0 } else { 1.0 };
        TableColumn { index, header: header.clone(), target, unit, to_si, at_rest: 0.0 }
    };
    heading.names.iter().enumerate().map(of_column).collect()
}

struct ColumnResolver<'a> {
    headers: &'a [String],
    units: &'a [String],
    row: usize,
    mapping: &'a Mapping,
    columns: Vec<TableColumn>,
    findings: &'a mut Findings,
}

impl ColumnResolver<'_> {
    /// Adds the columns that the manifest names.
    fn add_mapped(&mut self) {
        for (name, mapped) in &self.mapping.columns {
            let Some(target) = ColumnTarget::from_name(name) else {
                let message =
                    format!("`{name}` is not a channel; channels are {}", channel_names());
                self.findings.error(None, Some(&mapped.column), message);
                continue;
            };
            match self.find_header(&mapped.column) {
                Ok(index) => {
                    self.report_contradiction(index, target, &mapped.unit);
                    self.add_column(index, target, &mapped.unit);
                    // `add_column` adds nothing if the unit is wrong: the last column may then be
                    // another.
                    let added = self.columns.last_mut().filter(|column| column.index == index);
                    if let Some(column) = added.filter(|_| mapped.reversed) {
                        column.to_si = -column.to_si;
                    }
                }
                Err(message) => self.findings.error(Some(self.row), Some(&mapped.column), message),
            }
        }
    }

    /// Reports a header with one unit where the manifest states another: one of the two is wrong.
    fn report_contradiction(&mut self, index: usize, target: ColumnTarget, unit: &str) {
        // Units are compared by their factors, so that spellings of the same unit agree.
        let (kind, header) = (UnitKind::from_target(target), &self.headers[index]);
        let below = self.units.get(index).filter(|unit| kind.unit_to_si(unit).is_ok());
        if let Some(named) = kind.unit_in_header(header).or(below.map(String::as_str))
            && let (Ok(one), Ok(other)) = (kind.unit_to_si(named), kind.unit_to_si(unit))
            && one != other
        {
            let says = if self.is_mapped(target) { "the manifest says" } else { "its name says" };
            let message = format!(
                "the header has the unit `{named}`, but {says} `{}`; correct the wrong one",
                unit.trim()
            );
            let header = header.clone();
            self.findings.error(Some(self.row), Some(&header), message);
        }
    }

    fn find_header(&self, wanted: &str) -> Result<usize, String> {
        let mut found =
            self.headers.iter().enumerate().filter(|(_, header)| header.as_str() == wanted.trim());
        // Two columns with the same header cannot be distinguished by name.
        match (found.next(), found.next()) {
            (Some((index, _)), None) => Ok(index),
            (Some(_), Some(_)) => Err("two columns have this name; rename one of them".into()),
            (None, _) => Err(format!(
                "no such column{}; the file has {}",
                self.suggest_name(wanted),
                self.list_headers()
            )),
        }
    }

    fn suggest_name(&self, wanted: &str) -> String {
        let close =
            self.headers.iter().map(|header| (strsim::jaro_winkler(header, wanted), header));
        match close.max_by(|a, b| a.0.total_cmp(&b.0)) {
            Some((alike, header)) if alike >= ALIKE => format!(", did you mean `{header}`?"),
            _ => String::new(),
        }
    }

    fn list_headers(&self) -> String {
        let names: Vec<String> =
            self.headers.iter().take(LISTED).map(|header| format!("`{header}`")).collect();
        let more = self.headers.len().saturating_sub(LISTED);
        if more > 0 { format!("{} and {more} more", names.join(", ")) } else { names.join(", ") }
    }

    fn add_column(&mut self, index: usize, target: ColumnTarget, unit: &str) {
        let header = self.headers[index].clone();
        match unit_factor(target, unit, &self.mapping.declared) {
            Ok(to_si) => self.columns.push(TableColumn {
                index,
                header,
                target: self.redirect_target(target),
                unit: plain_unit(unit).into(),
                to_si,
                at_rest: if plain_unit(unit) == PULSE { PULSE_AT_REST } else { 0.0 },
            }),
            Err(message) => {
                self.findings.error(None, Some(&header), format!("{}: {message}", target.name()))
            }
        }
    }

    /// Assigns apparent wind and speeds through the water to channels of their own, so that later
    /// steps cannot mistake them for the true wind and for speeds over the ground.
    fn redirect_target(&self, target: ColumnTarget) -> ColumnTarget {
        let ColumnTarget::Channel(channel) = target else { return target };
        let conventions = &self.mapping.conventions;
        let is_apparent = conventions.wind.kind == WindKind::Apparent;
        let is_through_water = conventions.velocity == VelocityFrame::Water;
        ColumnTarget::Channel(match channel {
            Channel::WindSpeed if is_apparent => Channel::ApparentWindSpeed,
            Channel::WindFrom if is_apparent => Channel::ApparentWindFrom,
            Channel::U if is_through_water => Channel::UWater,
            Channel::V if is_through_water => Channel::VWater,
            other => other,
        })
    }

    /// Adds columns with a canonical name, for channels that the manifest leaves open.
    fn add_canonical(&mut self) {
        for index in 0..self.headers.len() {
            if let Some((target, unit)) = self.target_of_header(index)
                && !matches!(target, ColumnTarget::Raw(_))
            {
                self.report_contradiction(index, target, &unit);
                self.add_column(index, target, &unit);
            }
        }
    }

    /// Adds canonical columns from which channels are computed, if the channels themselves are
    /// absent.
    fn add_raw(&mut self) {
        // A channel with a column of its own is not computed from others.
        let given: Vec<ColumnTarget> = self.columns.iter().map(|column| column.target).collect();
        for index in 0..self.headers.len() {
            if let Some((ColumnTarget::Raw(raw), unit)) = self.target_of_header(index)
                && !raw
                    .computed_channels()
                    .iter()
                    .any(|&channel| given.contains(&ColumnTarget::Channel(channel)))
            {
                self.report_contradiction(index, ColumnTarget::Raw(raw), &unit);
                self.add_column(index, ColumnTarget::Raw(raw), &unit);
            }
        }
    }

    /// Returns the target and unit named by a header, for a free column and a target that the
    /// manifest leaves open.
    fn target_of_header(&self, index: usize) -> Option<(ColumnTarget, String)> {
        let header = &self.headers[index];
        let below = self.units.get(index).and_then(|unit| {
            names::target_with_unit(header, unit).map(|target| (target, unit.clone()))
        });
        let named = names::canonical_target(header).map(|(target, unit)| (target, unit.to_owned()));
        // A unit in the name precedes one in the row below.
        let free = self.is_free(index) && !self.is_ignored(header);
        named.or(below).filter(|(target, _)| free && !self.is_mapped(*target))
    }

    fn is_free(&self, index: usize) -> bool {
        self.columns.iter().all(|column| column.index != index)
    }

    fn is_mapped(&self, target: ColumnTarget) -> bool {
        self.mapping.columns.iter().any(|(name, _)| ColumnTarget::from_name(name) == Some(target))
    }

    fn is_ignored(&self, header: &str) -> bool {
        self.mapping.declared.ignore.iter().any(|ignored| ignored.trim() == header)
    }

    /// Adds the first column with a common name of time, if no other column is time.
    fn add_time(&mut self) {
        let free = |index: usize| self.is_free(index) && !self.is_ignored(&self.headers[index]);
        if !self.is_mapped(ColumnTarget::Time)
            && self.columns.iter().all(|column| column.target != ColumnTarget::Time)
        {
            let named =
                (0..self.headers.len()).find(|&k| free(k) && names::is_time(&self.headers[k]));
            if let Some(index) = named {
                // A unit in the row below the header, or that the format states.
                let known = |unit: &&String| UnitKind::Time.unit_to_si(unit).is_ok();
                let unit = self.units.get(index).filter(known).cloned();
                self.add_column(index, ColumnTarget::Time, unit.as_deref().unwrap_or("auto"));
            }
        }
    }

    fn report_duplicates(&mut self) {
        for (position, column) in self.columns.iter().enumerate() {
            // Each column is compared with earlier ones only, so that a pair is reported once.
            let before = &self.columns[..position];
            let message = if let Some(first) =
                before.iter().find(|first| first.target == column.target)
            {
                format!(
                    "`{}` and `{}` both give {}; keep one",
                    first.header,
                    column.header,
                    column.target.name()
                )
            } else if let Some(first) = before.iter().find(|first| first.index == column.index) {
                format!(
                    "is mapped to {} and to {}; a column can be mapped to one channel only",
                    first.target.name(),
                    column.target.name()
                )
            } else {
                continue;
            };
            self.findings.error(Some(self.row), Some(&column.header), message);
        }
    }

    fn require_columns(&mut self) {
        // A missing column may be the consequence of an error that is reported already.
        if self.findings.has_errors() {
            return;
        }
        if !self.columns.iter().any(|column| column.target == ColumnTarget::Time) {
            let message = format!(
                "no column for time{}; name it `t_s` or map `t`; the file has {}",
                self.suggest_name("t_s"),
                self.list_headers()
            );
            self.findings.error(Some(self.row), None, message);
        } else if self.columns.len() == 1 {
            let message = format!(
                "no column for any channel; name them as {} or map them; the file has {}",
                canonical_names(),
                self.list_headers()
            );
            self.findings.error(Some(self.row), None, message);
        }
    }

    fn report_ignored(&mut self) {
        let used = |index: usize| self.columns.iter().any(|column| column.index == index);
        let ignored: Vec<&str> = self
            .headers
            .iter()
            .enumerate()
            .filter(|(index, header)| !used(*index) && !self.is_ignored(header))
            .map(|(_, header)| header.as_str())
            .collect();
        if !ignored.is_empty() {
            self.findings.warning(
                Some(self.row),
                None,
                format!("columns not read: {}", ignored.join(", ")),
            );
        }
    }
}

/// Full command of a thruster in a unit of commands: a lever counts to 1, the pulses of a speed
/// controller span 400 us to either side of rest.
fn full_command(unit: &str) -> Option<f64> {
    match unit {
        "%" => Some(100.0),
        "lever" => Some(1.0),
        PULSE => Some(400.0),
        _ => None,
    }
}

/// Unit of the pulses of a speed controller, us.
const PULSE: &str = "pwm";

/// Pulse of a thruster at rest, us.
const PULSE_AT_REST: f64 = 1500.0;

/// Returns the factor to canonical units; a command refers to the declared maximum.
pub(crate) fn unit_factor(
    target: ColumnTarget,
    unit: &str,
    declared: &Declarations,
) -> Result<f64, String> {
    let command = plain_unit(unit);
    let Some(most) = full_command(command) else {
        return UnitKind::from_target(target).unit_to_si(unit);
    };
    // `delta_s` may use the maximum declared for `delta`.
    let of_pair = target.name().split('_').next().unwrap_or_default();
    let full = declared.maximum.get(target.name()).or_else(|| declared.maximum.get(of_pair));
    match full {
        Some(full) => Ok(full.value / most * UnitKind::from_target(target).unit_to_si(&full.unit)?),
        None => Err(format!(
            "`{command}` needs the value of {most}; declare `maximum: {{ {of_pair}: {{ value: ..., \
             unit: {} }} }}`",
            UnitKind::from_target(target).canonical_unit()
        )),
    }
}

/// Returns every channel name of manifests.
pub(crate) fn channel_names() -> String {
    let names = std::iter::once("t").chain(Channel::all_channels().map(Channel::name));
    names.chain(RawQuantity::all_quantities().map(RawQuantity::name)).collect::<Vec<_>>().join(", ")
}

fn canonical_names() -> String {
    Channel::all_channels().map(Channel::column_name).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
#[path = "resolve_tests.rs"]
mod tests;
