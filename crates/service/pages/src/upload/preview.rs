//! Preview of the data of a file, before it is stored.

use sistership_model::trial::{Finding, Trial};
use sistership_trials::Refusal;

use crate::picture::render_svg;
use crate::plot::{PlotTrack, plot_channels, plot_ground};

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
}

impl FilePreview {
    /// Returns the preview of a trial, or of a refusal.
    pub fn from_result(read: Result<Trial, Refusal>) -> Self {
        match read {
            Ok(trial) => Self::from_trial(&trial),
            Err(Refusal { file, findings }) => Self {
                file,
                rows: 0,
                duration: String::new(),
                errors: findings,
                remarks: Vec::new(),
                track: None,
                series: None,
            },
        }
    }

    /// Removes the plots: a page has room for those of a few files.
    pub fn without_plots(self) -> Self {
        Self { track: None, series: None, ..self }
    }

    fn from_trial(trial: &Trial) -> Self {
        let tracks = [PlotTrack::from_trial(trial)];
        let track = plot_ground(&tracks, None, &format!("Track of {}", trial.name));
        let series = plot_channels(&tracks, &format!("Channels of {} over time", trial.name));
        Self {
            file: trial.name.clone(),
            rows: trial.len(),
            duration: format!("{:.1} s", trial.duration_s()),
            errors: Vec::new(),
            remarks: trial.warnings.clone(),
            track: track.and_then(|plot| render_svg(&plot).ok()),
            series: render_svg(&series).ok(),
        }
    }

    /// Returns true if the file can be stored.
    pub fn is_accepted(&self) -> bool {
        self.errors.is_empty()
    }
}
