//! Reading of a source with a mapping into a checked trial.

use sistership_model::manifest::MissingValues;
use sistership_model::trial::{Finding, Trial};

use crate::bridge::{BRIDGED_S, bridge_gaps};
use crate::checks;
use crate::convert::convert_table;
use crate::csv_file::CsvRows;
use crate::currents::subtract_current;
use crate::exclusion::{Exclusion, apply_exclusions};
use crate::faults;
use crate::findings::Findings;
use crate::mapping::{FaultHandling, Mapping};
use crate::outcome::{CheckOutcome, Refusal, TrialReading};
use crate::parquet_file::ParquetRows;
use crate::recording::Recording;
use crate::row_sink::RowSource;
use crate::segment_tables::{self, LabelledMapping};
use crate::series::{join_series, offset_s, table_series};
use crate::smoothing::smooth_recording;
use crate::stream::TableRows;
use crate::table::Table;
use crate::trial_file::{InputContent, SensorInput, TrialFile};
use crate::trial_rows::TrialWithRows;
use crate::{csv_file, derived, ground, nmea_file, parquet_file, position, water, workbook};

/// Reads, converts and checks a trial, and smooths it if the conventions require it.
///
/// # Errors
/// Returns every reason, with row and column, for which the file is not accepted.
pub fn read_trial(source: TrialFile, mapping: &Mapping) -> Result<Trial, Refusal> {
    read_in_full(source, mapping).map(|reading| reading.trial)
}

/// Reads a trial with the data that have no place in a [`Trial`].
///
/// # Errors
/// Returns the errors of [`read_trial`].
pub fn read_in_full(source: TrialFile, mapping: &Mapping) -> Result<TrialReading, Refusal> {
    let file = source.name.clone();
    examine_source(source, mapping).into_reading(file)
}

/// Reads a trial with the row of each sample.
///
/// # Errors
/// Returns the errors of [`read_trial`].
pub fn read_with_rows(source: TrialFile, mapping: &Mapping) -> Result<TrialWithRows, Refusal> {
    let file = source.name.clone();
    let mut checked = examine_source(source, mapping);
    let rows = std::mem::take(&mut checked.recording.rows);
    Ok(TrialWithRows { trial: checked.into_trial(file)?, rows })
}

/// Returns faults of the values of a file that its mapping does not exclude yet.
pub fn find_source_faults(source: TrialFile, mapping: &Mapping) -> Vec<Exclusion> {
    let mapping = Mapping { faults: FaultHandling::Report, ..mapping.clone() };
    examine_source(source, &mapping).recording.faults
}

/// Runs the checks of [`read_trial`] and returns their findings.
pub fn check_source(source: TrialFile, mapping: &Mapping) -> CheckOutcome {
    let file = source.name.clone();
    examine_source(source, mapping).into_outcome(file)
}

/// Recording with all findings.
pub(crate) struct CheckedRecording {
    recording: Recording,
    errors: Vec<Finding>,
    warnings: Vec<Finding>,
}

impl CheckedRecording {
    fn into_reading(self, file: String) -> Result<TrialReading, Refusal> {
        if !self.errors.is_empty() {
            return Err(Refusal { file, findings: self.errors });
        }
        let Recording { trial, start, derived, origin, .. } = self.recording;
        Ok(TrialReading {
            trial: Trial { warnings: self.warnings, ..trial },
            start: start.map(|start| start.text),
            derived,
            origin,
        })
    }

    /// Takes the faults, if they were searched.
    pub(crate) fn take_faults(&mut self) -> Vec<Exclusion> {
        std::mem::take(&mut self.recording.faults)
    }

    pub(crate) fn into_trial(self, file: String) -> Result<Trial, Refusal> {
        self.into_reading(file).map(|reading| reading.trial)
    }

    pub(crate) fn into_outcome(self, file: String) -> CheckOutcome {
        let Self { recording: Recording { trial, faults, .. }, errors, mut warnings } = self;
        warnings.extend(faults.iter().map(Exclusion::to_finding));
        CheckOutcome { file, rows: trial.len(), duration_s: trial.duration_s(), errors, warnings }
    }
}

pub(crate) fn examine_source(source: TrialFile, mapping: &Mapping) -> CheckedRecording {
    let TrialFile { name, content: input, sensors } = source;
    if mapping.stretch.is_some() {
        let asked = vec![SegmentRequest { name: &name, mapping, sensors }];
        let mut read = read_segments(input, asked);
        return read.remove(0);
    }
    let mut findings = Findings::default();
    let table = read_content(input, mapping, &mut findings);
    finish_recording(&name, table, sensors, mapping, findings)
}

/// Request for a segment of a file, with the files of sensors that belong to it.
pub(crate) struct SegmentRequest<'a> {
    pub name: &'a str,
    pub mapping: &'a Mapping,
    pub sensors: Vec<SensorInput<'a>>,
}

/// Reads several segments of one file in one pass.
pub(crate) fn read_segments(
    input: InputContent,
    requests: Vec<SegmentRequest>,
) -> Vec<CheckedRecording> {
    let mut header = Findings::default();
    let parts: Vec<LabelledMapping> = requests
        .iter()
        .map(|request| LabelledMapping { label: request.name, mapping: request.mapping })
        .collect();
    let tables = parts.first().and_then(|first| {
        let visit = SegmentsVisitor(&parts);
        each_row(input, first.mapping, &mut header, visit)
    });
    // If the file cannot be opened, each segment reports the findings on the header.
    let nothing = || parts.iter().map(|_| (None, header.clone())).collect();
    let tables: Vec<(Option<Table>, Findings)> = tables.unwrap_or_else(nothing);
    let each = requests.into_iter().zip(tables);
    each.map(|(SegmentRequest { name, mapping, sensors }, (table, findings))| {
        finish_recording(name, table, sensors, mapping, findings)
    })
    .collect()
}

/// Operation on the rows of a file, whatever its format.
pub(crate) trait RowsVisitor {
    type Output;
    fn visit_rows(self, file: impl RowSource, header: &Findings) -> Self::Output;
}

struct SegmentsVisitor<'a>(&'a [LabelledMapping<'a>]);

impl RowsVisitor for SegmentsVisitor<'_> {
    type Output = Vec<(Option<Table>, Findings)>;

    fn visit_rows(self, file: impl RowSource, header: &Findings) -> Self::Output {
        segment_tables::read_tables(file, self.0, header)
    }
}

/// Opens a file of which not all rows are stored, and visits its rows; returns `None` after errors.
pub(crate) fn each_row<V: RowsVisitor>(
    input: InputContent,
    mapping: &Mapping,
    findings: &mut Findings,
    visit: V,
) -> Option<V::Output> {
    check_part(&input, mapping, findings)?;
    match input {
        InputContent::Csv(reader) => {
            let file = CsvRows::open(reader, mapping, findings)?;
            Some(visit.visit_rows(file, findings))
        }
        InputContent::ParquetFile(file) => {
            let file = ParquetRows::open(file, mapping, findings)?;
            Some(visit.visit_rows(file, findings))
        }
        InputContent::ParquetBytes(bytes) => {
            let file = ParquetRows::open(bytes, mapping, findings)?;
            Some(visit.visit_rows(file, findings))
        }
        // Other formats cannot be streamed: they are read into a table whose rows are visited.
        other => {
            let table = read_content(other, mapping, findings)?;
            Some(visit.visit_rows(TableRows::new(table), findings))
        }
    }
}

/// Refuses a part of a file that has none.
fn check_part(input: &InputContent, mapping: &Mapping, findings: &mut Findings) -> Option<()> {
    if mapping.part.is_none() || input.has_parts() {
        return Some(());
    }
    let message = "a file of this format has no parts; remove `#part=NAME` behind its name";
    findings.error(None, None, message);
    None
}

/// Converts a table to a checked, smoothed recording with its findings.
fn finish_recording(
    name: &str,
    table: Option<Table>,
    sensors: Vec<SensorInput>,
    mapping: &Mapping,
    mut findings: Findings,
) -> CheckedRecording {
    let mut recording = match table {
        Some(table) => build_recording(name, table, sensors, mapping, &mut findings),
        None => Recording::default(),
    };
    if !findings.has_errors()
        && let Some(smoothing) = mapping.conventions.smoothing
    {
        smooth_recording(&mut recording, smoothing, &mut findings);
    }
    let (errors, warnings) = findings.into_lists();
    CheckedRecording { recording, errors, warnings }
}

fn build_recording(
    name: &str,
    mut table: Table,
    sensors: Vec<SensorInput>,
    mapping: &Mapping,
    findings: &mut Findings,
) -> Recording {
    // Sensors first, so that exclusions, gaps and derived channels apply to all channels alike.
    for sensor in sensors {
        if let Some((other, offset_s)) = sensor_table(sensor, &table, findings) {
            join_series(&mut table, table_series(other, offset_s), findings);
        }
    }
    apply_exclusions(&mut table, &mapping.exclude, findings);
    // Faults are searched before gaps are bridged: interpolated values are no readings.
    let faults = match mapping.faults {
        FaultHandling::Ignore => Vec::new(),
        FaultHandling::Report | FaultHandling::Exclude => faults::table_faults(name, &table),
    };
    if mapping.faults == FaultHandling::Exclude {
        apply_exclusions(&mut table, &faults, findings);
    }
    if mapping.conventions.missing == MissingValues::Bridge {
        bridge_gaps(&mut table, mapping.conventions.bridge_s.unwrap_or(BRIDGED_S), findings);
    }
    let mut recording = convert_table(name, table, mapping, findings);
    recording.faults = faults;
    recording.origin = mapping.declared.origin;
    derive_channels(&mut recording, mapping, findings);
    if let Some(current) = &mapping.current {
        subtract_current(&mut recording, current, findings);
    }
    checks::run_checks(&mut recording, findings);
    recording
}

fn read_content(
    content: InputContent,
    mapping: &Mapping,
    findings: &mut Findings,
) -> Option<Table> {
    check_part(&content, mapping, findings)?;
    match content {
        InputContent::Csv(reader) => csv_file::read_csv(reader, mapping, findings),
        InputContent::ParquetBytes(bytes) => parquet_file::read_parquet(bytes, mapping, findings),
        InputContent::ParquetFile(file) => parquet_file::read_parquet(file, mapping, findings),
        InputContent::Workbook(input) => workbook::read_workbook(input, mapping, findings),
        InputContent::Columns(file) => file.read_table(mapping, findings),
        InputContent::Nmea(input) => nmea_file::read_nmea(input, mapping, findings),
        InputContent::Other(what) => {
            findings.error(None, None, format!("the file is {what}"));
            None
        }
    }
}

/// Returns the table of the file of a sensor, and the offset of its time.
fn sensor_table(
    sensor: SensorInput,
    base: &Table,
    findings: &mut Findings,
) -> Option<(Table, f64)> {
    let mut own = Findings::default();
    let read = read_content(sensor.content, &sensor.mapping, &mut own).and_then(|table| {
        match offset_s(base.start.as_ref(), table.start.as_ref(), sensor.clock_offset_s) {
            Ok(offset_s) => Some((table, offset_s)),
            Err(message) => {
                own.error(None, None, message);
                None
            }
        }
    });
    findings.absorb_file(&sensor.name, own);
    read
}

/// Derives channels from those that instruments record.
fn derive_channels(recording: &mut Recording, mapping: &Mapping, findings: &mut Findings) {
    let antenna = mapping.declared.antenna;
    position::fixes_to_metres(recording, findings);
    if let Some(antenna) = antenna {
        position::move_to_midship(recording, antenna, findings);
    }
    let wanted = &mapping.declared.derive;
    // The order matters: velocities of an antenna need the yaw rate, and derived velocities are
    // only computed where course and speed have not given any.
    derived::derive_yaw_rate(recording, wanted, findings);
    ground::ground_velocities(recording, antenna, findings);
    derived::derive_velocities(recording, wanted, findings);
    water::assign_velocities(recording, findings);
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use sistership_model::manifest::Smoothing;
    use sistership_model::trial::Channel;

    fn csv(text: &str, mapping: &Mapping) -> Result<Trial, Refusal> {
        read_trial(TrialFile::from_csv("a.csv", text.as_bytes()), mapping)
    }

    #[test]
    fn a_file_with_canonical_names_becomes_a_trial() {
        let trial = csv(
            "t_s,u_kn,psi_deg,note\n0,10,350,a\n1,11,5,b\n2,12,10,c\n",
            &Mapping::with_canonical_names(),
        )
        .unwrap();
        assert!((trial.channel(Channel::U).unwrap()[0] - 5.144_444).abs() < 1e-5);
        let psi = trial.channel(Channel::Psi).unwrap();
        assert!((psi[1] - psi[0] - 15.0_f64.to_radians()).abs() < 1e-12);
        assert_eq!((trial.name.as_str(), trial.warnings.len()), ("a.csv", 1));
    }

    #[test]
    fn every_error_is_told_at_once() {
        let refusal =
            csv("t_s,u_m_s,delta_rad\n0,1,35\n1,,20\n1,99,10\n", &Mapping::with_canonical_names())
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
        let mut mapping = Mapping::with_canonical_names();
        mapping.conventions.smoothing = Some(Smoothing { window: 9, degree: 2 });
        let smooth = csv(&text, &mapping).unwrap();
        assert!((smooth.channel(Channel::U).unwrap()[0]).abs() < 1e-12);
        mapping.conventions.smoothing = Some(Smoothing { window: 8, degree: 2 });
        assert!(csv(&text, &mapping).unwrap_err().to_string().contains("odd"));
    }

    #[test]
    fn check_tells_rows_and_duration() {
        let outcome = check_source(
            TrialFile::from_csv("a.csv", "t_s,u_m_s\n0,1\n2,2\n4,3\n".as_bytes()),
            &Mapping::with_canonical_names(),
        );
        assert_eq!((outcome.rows, outcome.duration_s, outcome.is_accepted()), (3, 4.0, true));
    }
}
