//! Segmentation of long logs: the segments that become trials, and the rest.

use std::fmt;
use std::path::Path;

use serde::Serialize;
use sistership_model::manifest::{FileTime, ManifestTrial};
use sistership_trials::segmentation::{
    LogSample, ManoeuvreSegment, SegmentFinder, SegmentationResult, TimeSpan,
};
use sistership_trials::{ManifestFile, SteeringSample, scan_file};

use crate::output::{format_count, print_note};
use crate::table::TextTable;

/// Resolution of written times, parts of a second.
const PARTS_PER_SECOND: f64 = 10.0;

/// Log with its segments.
#[derive(Serialize)]
pub struct SegmentedLog {
    file: String,
    rows: u64,
    duration_s: f64,
    length_m: f64,
    speed_m_s: f64,
    /// Scatter of the rudder in course keeping.
    rudder_scatter_deg: f64,
    stretches: Vec<ManoeuvreSegment>,
    /// Steady course keeping: not used for the fit, but a model's drift shows in it.
    steady: Vec<TimeSpan>,
}

/// Replaces each file that is a log, and no single trial, by its segments.
pub fn segment_logs(
    manifest: &mut ManifestFile,
    folder: &Path,
    length_m: Option<f64>,
) -> Vec<SegmentedLog> {
    let (mut logs, mut trials, mut sensors) = (Vec::new(), Vec::new(), Vec::new());
    for (at, trial) in manifest.manifest.trials.iter().enumerate() {
        let own = manifest.sensors.get(at).cloned().unwrap_or_default();
        match segment_file(manifest, trial, folder, length_m) {
            Some(found) if found.is_log() && !found.stretches.is_empty() => {
                let entries =
                    found.stretches.iter().map(|one| segment_entry(trial, one, found.whole));
                trials.extend(entries);
                logs.push(SegmentedLog::from_segmentation(&trial.file, found));
            }
            // A log without manoeuvres stays one trial, with a note.
            Some(found) if found.is_log() => {
                let hours = found.whole.duration_s() / 3600.0;
                print_note(&format!(
                    "note: {}: {hours:.1} h without a manoeuvre: rudder and propeller only keep \
                     the course",
                    trial.file
                ));
                trials.push(trial.clone());
            }
            _ => trials.push(trial.clone()),
        }
        // Every segment has the sensors of its file.
        sensors.resize(trials.len(), own);
    }
    (manifest.manifest.trials, manifest.sensors) = (trials, sensors);
    logs
}

/// Segments a file; `None` if it cannot be read, which is reported later when the manifest is read.
fn segment_file(
    manifest: &ManifestFile,
    trial: &ManifestTrial,
    folder: &Path,
    length_m: Option<f64>,
) -> Option<SegmentationResult> {
    // One pass over the rows: a log may be larger than the memory.
    let mut finder = SegmentFinder::new(length_m);
    let each = |steering: &SteeringSample| finder.push(&to_sample(steering));
    scan_file(&folder.join(trial.file_path()), &manifest.trial_mapping(trial), each).ok()?;
    finder.finish().ok()
}

fn to_sample(steering: &SteeringSample) -> LogSample {
    let SteeringSample { t_s, rudder_rad, revolutions_rps, yaw_rate_rad_s, heading_rad, speed_m_s } =
        *steering;
    LogSample { t_s, rudder_rad, revolutions_rps, yaw_rate_rad_s, heading_rad, speed_m_s }
}

/// Returns the manifest entry of a segment; begin or end are omitted if they are those of the file.
fn segment_entry(
    trial: &ManifestTrial,
    stretch: &ManoeuvreSegment,
    whole: TimeSpan,
) -> ManifestTrial {
    let (from_s, to_s) = rounded_ends(stretch.span);
    let time = |time_s: f64, is_inside: bool| is_inside.then_some(FileTime::Seconds(time_s));
    ManifestTrial {
        from: time(from_s, from_s > whole.from_s),
        to: time(to_s, to_s < whole.to_s),
        // A name without angles: only manoeuvres named with their angles are evaluated as standard
        // ones.
        manoeuvre: Some(format!("found: {}", stretch.kind)),
        ..trial.clone()
    }
}

/// Rounds both ends down, so that neighbouring segments meet and do not overlap.
fn rounded_ends(span: TimeSpan) -> (f64, f64) {
    let down = |time_s: f64| (time_s * PARTS_PER_SECOND).floor() / PARTS_PER_SECOND;
    (down(span.from_s), down(span.to_s))
}

impl SegmentedLog {
    fn from_segmentation(file: &str, found: SegmentationResult) -> Self {
        Self {
            file: file.to_owned(),
            rows: found.rows,
            duration_s: found.whole.duration_s(),
            length_m: found.length_m,
            speed_m_s: found.speed_m_s,
            rudder_scatter_deg: found.rudder_scatter_rad.to_degrees(),
            stretches: found.stretches,
            steady: found.steady,
        }
    }

    fn segment_table(&self) -> TextTable {
        let mut table = TextTable::new([
            "",
            "from (s)",
            "to (s)",
            "min",
            "found",
            "rudder rms",
            "yaw rms",
            "speed",
            "why",
        ]);
        for (at, stretch) in self.stretches.iter().enumerate() {
            let (from_s, to_s) = rounded_ends(stretch.span);
            let excitation = &stretch.excitation;
            table.add_row([
                (at + 1).to_string(),
                format!("{from_s:.1}"),
                format!("{to_s:.1}"),
                format!("{:.1}", stretch.span.duration_s() / 60.0),
                stretch.kind.to_string(),
                format!("{:.1} deg", excitation.rudder_rms_deg),
                format!("{:.2} deg/s", excitation.yaw_rate_rms_deg_s),
                format!("{:.0} %", 100.0 * excitation.speed_range),
                stretch.why.clone(),
            ]);
        }
        table
    }
}

impl fmt::Display for SegmentedLog {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let hours = |seconds: f64| seconds / 3600.0;
        let steady_s: f64 = self.steady.iter().map(TimeSpan::duration_s).sum();
        writeln!(
            out,
            "{}: a log of {:.1} h and {} rows with {}",
            self.file,
            hours(self.duration_s),
            self.rows,
            format_count(self.stretches.len(), "manoeuvre"),
        )?;
        writeln!(
            out,
            "(ship length {:.0} m, speed {:.1} m/s; standard deviation of the rudder in course \
             keeping {:.1} deg)\n{}",
            self.length_m,
            self.speed_m_s,
            self.rudder_scatter_deg,
            self.segment_table()
        )?;
        writeln!(
            out,
            "{:.1} h ({:.0} %) in {} are steady course keeping: not used for the fit, but for \
             drift of the model\n",
            hours(steady_s),
            100.0 * steady_s / self.duration_s,
            format_count(self.steady.len(), "part"),
        )
    }
}
