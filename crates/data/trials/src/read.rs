//! Reading of a source with a mapping into a checked trial.

use sistership_model::manifest::Missing;
use sistership_model::trial::{Finding, Trial};

use crate::bridge::{BRIDGED_S, bridge};
use crate::checks;
use crate::convert::convert;
use crate::csv_file::CsvRows;
use crate::exclusion::{Exclusion, exclude};
use crate::faults;
use crate::findings::Findings;
use crate::mapping::Mapping;
use crate::outcome::{CheckOutcome, Refusal, TrialReading};
use crate::parquet_file::ParquetRows;
use crate::parts::{self, Asked};
use crate::recording::Recording;
use crate::series::{join, offset_s, series};
use crate::smoothing::smooth;
use crate::source::{Content, Sensor, Source};
use crate::stream::TableRows;
use crate::table::Table;
use crate::taker::RowsFile;
use crate::{
    csv_file, derived, ground, mat_file, nmea_file, parquet_file, position, water, workbook,
};

/// Reads, converts and checks a trial, and smooths it if the conventions require it.
///
/// # Errors
/// Returns every reason, with row and column, for which the file is not accepted.
pub fn read_trial(source: Source, mapping: &Mapping) -> Result<Trial, Refusal> {
    read_in_full(source, mapping).map(|reading| reading.trial)
}

/// Reads a trial with the data that have no place in a [`Trial`].
///
/// # Errors
/// Returns the errors of [`read_trial`].
pub fn read_in_full(source: Source, mapping: &Mapping) -> Result<TrialReading, Refusal> {
    let file = source.name.clone();
    examine(source, mapping).reading(file)
}

/// Runs the checks of [`read_trial`] and returns their findings.
pub fn check(source: Source, mapping: &Mapping) -> CheckOutcome {
    let file = source.name.clone();
    examine(source, mapping).outcome(file)
}

/// Recording with all findings.
pub(crate) struct Examined {
    recording: Recording,
    errors: Vec<Finding>,
    warnings: Vec<Finding>,
}

impl Examined {
    fn reading(self, file: String) -> Result<TrialReading, Refusal> {
        if !self.errors.is_empty() {
            return Err(Refusal { file, findings: self.errors });
        }
        let Recording { trial, start, derived, .. } = self.recording;
        Ok(TrialReading {
            trial: Trial { warnings: self.warnings, ..trial },
            start: start.map(|start| start.text),
            derived,
        })
    }

    /// Returns the faults, if they were searched.
    pub(crate) fn faults(&self) -> &[Exclusion] {
        &self.recording.faults
    }

    pub(crate) fn trial(self, file: String) -> Result<Trial, Refusal> {
        self.reading(file).map(|reading| reading.trial)
    }

    pub(crate) fn outcome(self, file: String) -> CheckOutcome {
        let Self { recording: Recording { trial, faults, .. }, errors, mut warnings } = self;
        warnings.extend(faults.iter().map(Exclusion::remark));
        CheckOutcome { file, rows: trial.len(), duration_s: trial.duration_s(), errors, warnings }
    }
}

pub(crate) fn examine(source: Source, mapping: &Mapping) -> Examined {
    let Source { name, content: input, sensors } = source;
    if mapping.stretch.is_some() {
        let asked = vec![StretchRequest { name: &name, mapping, sensors }];
        let mut read = stretches(input, asked);
        return read.remove(0);
    }
    let mut findings = Findings::default();
    let table = content(input, mapping, &mut findings);
    finish(&name, table, sensors, mapping, findings)
}

/// Request for a segment of a file, with the files of sensors that belong to it.
pub(crate) struct StretchRequest<'a> {
    pub name: &'a str,
    pub mapping: &'a Mapping,
    pub sensors: Vec<Sensor<'a>>,
}

/// Reads several segments of one file in one pass.
pub(crate) fn stretches(input: Content, requests: Vec<StretchRequest>) -> Vec<Examined> {
    let mut header = Findings::default();
    let parts: Vec<Asked> = requests
        .iter()
        .map(|request| Asked { label: request.name, mapping: request.mapping })
        .collect();
    let tables = parts.first().and_then(|first| {
        let visit = PartsVisit(&parts);
        each_row(input, first.mapping, &mut header, visit)
    });
    // If the file cannot be opened, each segment reports the findings on the header.
    let nothing = || parts.iter().map(|_| (None, header.clone())).collect();
    let tables: Vec<(Option<Table>, Findings)> = tables.unwrap_or_else(nothing);
    let each = requests.into_iter().zip(tables);
    each.map(|(StretchRequest { name, mapping, sensors }, (table, findings))| {
        finish(name, table, sensors, mapping, findings)
    })
    .collect()
}

/// Operation on the rows of a file, whatever its format.
pub(crate) trait Visit {
    type Output;
    fn visit(self, file: impl RowsFile, header: &Findings) -> Self::Output;
}

struct PartsVisit<'a>(&'a [Asked<'a>]);

impl Visit for PartsVisit<'_> {
    type Output = Vec<(Option<Table>, Findings)>;

    fn visit(self, file: impl RowsFile, header: &Findings) -> Self::Output {
        parts::read(file, self.0, header)
    }
}

/// Opens a file of which not all rows are stored, and visits its rows; returns `None` after errors.
pub(crate) fn each_row<V: Visit>(
    input: Content,
    mapping: &Mapping,
    findings: &mut Findings,
    visit: V,
) -> Option<V::Output> {
    match input {
        Content::Csv(reader) => {
            let file = CsvRows::open(reader, mapping, findings)?;
            Some(visit.visit(file, findings))
        }
        Content::ParquetFile(file) => {
            let file = ParquetRows::open(file, mapping, findings)?;
            Some(visit.visit(file, findings))
        }
        Content::ParquetBytes(bytes) => {
            let file = ParquetRows::open(bytes, mapping, findings)?;
            Some(visit.visit(file, findings))
        }
        // Other formats cannot be streamed: they are read into a table whose rows are visited.
        other => {
            let table = content(other, mapping, findings)?;
            Some(visit.visit(TableRows::new(table), findings))
        }
    }
}

/// Converts a table to a checked, smoothed recording with its findings.
fn finish(
    name: &str,
    table: Option<Table>,
    sensors: Vec<Sensor>,
    mapping: &Mapping,
    mut findings: Findings,
) -> Examined {
    let mut recording = match table {
        Some(table) => record(name, table, sensors, mapping, &mut findings),
        None => Recording::default(),
    };
    if !findings.has_errors()
        && let Some(smoothing) = mapping.conventions.smoothing
    {
        smooth(&mut recording, smoothing, &mut findings);
    }
    let (errors, warnings) = findings.finish();
    Examined { recording, errors, warnings }
}

fn record(
    name: &str,
    mut table: Table,
    sensors: Vec<Sensor>,
    mapping: &Mapping,
    findings: &mut Findings,
) -> Recording {
    // Sensors first, so that exclusions, gaps and derived channels apply to all channels alike.
    for sensor in sensors {
        if let Some((other, offset_s)) = sensor_table(sensor, &table, findings) {
            join(&mut table, series(other, offset_s), findings);
        }
    }
    exclude(&mut table, &mapping.exclude, findings);
    // Faults are searched before gaps are bridged: interpolated values are no readings.
    let faults = if mapping.seeks_faults { faults::find(name, &table) } else { Vec::new() };
    if mapping.conventions.missing == Missing::Bridge {
        bridge(&mut table, mapping.conventions.bridge_s.unwrap_or(BRIDGED_S), findings);
    }
    let mut recording = convert(name, table, mapping, findings);
    recording.faults = faults;
    made(&mut recording, mapping, findings);
    checks::run(&mut recording, findings);
    recording
}

fn content(content: Content, mapping: &Mapping, findings: &mut Findings) -> Option<Table> {
    match content {
        Content::Csv(reader) => csv_file::read(reader, mapping, findings),
        Content::ParquetBytes(bytes) => parquet_file::read(bytes, mapping, findings),
        Content::ParquetFile(file) => parquet_file::read(file, mapping, findings),
        Content::Workbook(input) => workbook::read(input, mapping, findings),
        Content::Matlab(input) => mat_file::read(input, mapping, findings),
        Content::Nmea(input) => nmea_file::read(input, mapping, findings),
        Content::Other(what) => {
            findings.error(None, None, format!("the file is {what}"));
            None
        }
    }
}

/// Returns the table of the file of a sensor, and the offset of its time.
fn sensor_table(sensor: Sensor, base: &Table, findings: &mut Findings) -> Option<(Table, f64)> {
    let mut own = Findings::default();
    let read =
        content(sensor.content, &sensor.mapping, &mut own).and_then(|table| {
            match offset_s(base.start.as_ref(), table.start.as_ref(), sensor.clock_offset_s) {
                Ok(offset_s) => Some((table, offset_s)),
                Err(message) => {
                    own.error(None, None, message);
                    None
                }
            }
        });
    findings.absorb(&sensor.name, own);
    read
}

/// Derives channels from those that instruments record.
fn made(recording: &mut Recording, mapping: &Mapping, findings: &mut Findings) {
    let antenna = mapping.declared.antenna;
    position::local(recording, findings);
    if let Some(antenna) = antenna {
        position::to_midship(recording, antenna, findings);
    }
    let wanted = &mapping.declared.derive;
    // The order matters: velocities of an antenna need the yaw rate, and derived velocities are
    // only computed where course and speed have not given any.
    derived::yaw_rate(recording, wanted, findings);
    ground::velocities(recording, antenna, findings);
    derived::velocities(recording, wanted, findings);
    water::settle(recording, findings);
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use sistership_model::manifest::Smoothing;
    use sistership_model::trial::Channel;

    fn csv(text: &str, mapping: &Mapping) -> Result<Trial, Refusal> {
        read_trial(Source::csv("a.csv", text.as_bytes()), mapping)
    }

    #[test]
    fn a_file_with_canonical_names_becomes_a_trial() {
        let trial =
            csv("t_s,u_kn,psi_deg,note\n0,10,350,a\n1,11,5,b\n2,12,10,c\n", &Mapping::canonical())
                .unwrap();
        assert!((trial.channel(Channel::U).unwrap()[0] - 5.144_444).abs() < 1e-5);
        let psi = trial.channel(Channel::Psi).unwrap();
        assert!((psi[1] - psi[0] - 15.0_f64.to_radians()).abs() < 1e-12);
        assert_eq!((trial.name.as_str(), trial.warnings.len()), ("a.csv", 1));
    }

    #[test]
    fn every_error_is_told_at_once() {
        let refusal = csv("t_s,u_m_s,delta_rad\n0,1,35\n1,,20\n1,99,10\n", &Mapping::canonical())
            .unwrap_err();
        let text = refusal.to_string();
        assert!(text.contains("row 3: column `u_m_s`: the cell is empty"), "{text}");
        assert!(
            text.contains("row 4: column `u_m_s`: 99.0000 m/s") && text.contains("declare `deg`"),
            "{text}"
        );
    }

    #[test]
    fn smoothing_is_done_on_demand_and_its_refusal_is_an_error() {
        let text: String =
            (0..50).map(|k| format!("{k},{}\n", (k as f64).powi(2) * 1e-3)).collect();
        let text = format!("t_s,u_m_s\n{text}");
        let mut mapping = Mapping::canonical();
        mapping.conventions.smoothing = Some(Smoothing { window: 9, degree: 2 });
        let smooth = csv(&text, &mapping).unwrap();
        assert!((smooth.channel(Channel::U).unwrap()[0]).abs() < 1e-12);
        mapping.conventions.smoothing = Some(Smoothing { window: 8, degree: 2 });
        assert!(csv(&text, &mapping).unwrap_err().to_string().contains("odd"));
    }

    #[test]
    fn check_tells_rows_and_duration() {
        let outcome = check(
            Source::csv("a.csv", "t_s,u_m_s\n0,1\n2,2\n4,3\n".as_bytes()),
            &Mapping::canonical(),
        );
        assert_eq!((outcome.rows, outcome.duration_s, outcome.accepted()), (3, 4.0, true));
    }
}
