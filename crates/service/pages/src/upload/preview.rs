//! Preview of the data of a file, before it is stored.

use sistership_model::trial::{Channel, Finding};
use sistership_trials::{Exclusion, Refusal, TrialWithRows};

use crate::language::say;
use crate::numbers::format_fixed;
use crate::picture::render_svg;
use crate::plot::{ExcludedInterval, PlotTrack, TimePanels, plot_ground, plot_with_exclusions};

/// Data of a file, or its errors.
#[derive(Debug)]
pub struct FilePreview {
    pub(super) file: String,
    pub(super) rows: usize,
    pub(super) duration: String,
    pub(super) errors: Vec<Finding>,
    pub(super) remarks: Vec<Finding>,
    pub(super) track: Option<String>,
    pub(super) series: Option<String>,
    /// Place of the time axis in the plot of the channels.
    pub(super) panels: TimePanels,
}

impl FilePreview {
    /// Returns the preview of a trial with the exclusions of its file, or of a refusal.
    pub fn from_result(read: Result<TrialWithRows, Refusal>, excluded: &[Exclusion]) -> Self {
        match read {
            Ok(trial) => Self::from_trial(&trial, excluded),
            Err(Refusal { file, findings }) => Self {
                file,
                rows: 0,
                duration: String::new(),
                errors: findings,
                remarks: Vec::new(),
                track: None,
                series: None,
                panels: TimePanels::default(),
            },
        }
    }

    /// Removes the plots: a page has room for those of a few files.
    pub fn without_plots(self) -> Self {
        Self { track: None, series: None, ..self }
    }

    fn from_trial(read: &TrialWithRows, excluded: &[Exclusion]) -> Self {
        let trial = &read.trial;
        let tracks = [PlotTrack::from_trial(trial)];
        let track =
            plot_ground(&tracks, None, &say("preview-track").with("name", &trial.name).to_string());
        let label = say("preview-channels").with("name", &trial.name).to_string();
        let intervals = excluded_intervals(read, excluded);
        let (series, panels) = plot_with_exclusions(&tracks, &intervals, &label);
        Self {
            file: trial.name.clone(),
            rows: trial.len(),
            duration: format!("{} s", format_fixed(trial.duration_s(), 1)),
            errors: Vec::new(),
            remarks: trial.warnings.clone(),
            track: track.and_then(|plot| render_svg(&plot).ok()),
            series: render_svg(&series).ok(),
            panels,
        }
    }

    /// Returns true if the file can be stored.
    pub fn is_accepted(&self) -> bool {
        self.errors.is_empty()
    }
}

/// Returns the times of exclusions by rows; those of times are of manifests by hand.
fn excluded_intervals(read: &TrialWithRows, excluded: &[Exclusion]) -> Vec<ExcludedInterval> {
    let of_one = |one: &Exclusion| {
        let channels = shown_channels(one.channel.as_deref());
        let ranges = one.rows.iter().flat_map(|rows| &rows.0);
        let times: Vec<(f64, f64)> = ranges.filter_map(|rows| read.times_of_rows(rows)).collect();
        let each = channels.into_iter().flat_map(move |channel| {
            let interval = move |(from_s, to_s)| ExcludedInterval { channel, from_s, to_s };
            times.clone().into_iter().map(interval)
        });
        each.collect::<Vec<_>>()
    };
    excluded.iter().flat_map(of_one).collect()
}

/// Returns the channels of the plot in which an excluded column shows; `None` is every channel.
fn shown_channels(name: Option<&str>) -> Vec<Option<Channel>> {
    match name {
        None => vec![None],
        Some("latitude") => vec![Some(Channel::X)],
        Some("longitude") => vec![Some(Channel::Y)],
        Some("course" | "speed" | "v_north" | "v_east") => {
            vec![Some(Channel::U), Some(Channel::V)]
        }
        Some(name) => Channel::by_name(name).into_iter().map(Some).collect(),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use sistership_model::trial::Trial;
    use sistership_trials::RowRanges;

    #[test]
    fn excluded_rows_are_shaded_in_their_channels_only() {
        let mut trial = Trial { t_s: (0..50).map(f64::from).collect(), ..Trial::default() };
        for channel in [Channel::U, Channel::R] {
            trial.channels.insert(channel, vec![1.0; 50]);
        }
        let read = TrialWithRows { trial, rows: (2..52).collect() };
        let exclusion = Exclusion {
            file: "a.csv".into(),
            channel: Some("r".into()),
            rows: Some(RowRanges(vec![10..=14, 30..=30])),
            from: None,
            to: None,
            why: "spikes".into(),
        };
        let drawn = |excluded: &[Exclusion]| {
            let preview = FilePreview::from_result(Ok(read.clone()), excluded);
            let count = preview.series.unwrap().matches("class=\"excluded\"").count();
            (count, preview.panels.channels)
        };
        assert_eq!(drawn(&[]), (0, "u r".into()));
        assert_eq!(drawn(std::slice::from_ref(&exclusion)).0, 2);
        let whole = Exclusion { channel: None, ..exclusion };
        assert_eq!(drawn(&[whole]).0, 4, "whole rows are excluded in every channel");
    }
}
