//! Output document of `sistership import`.

use std::path::PathBuf;

use serde::Serialize;
use sistership_trials::{ColumnGuess, Exclusion, TrialCurrent};

use super::import_log::SegmentedLog;

/// Result of an import.
#[derive(Serialize)]
pub(super) struct ImportDocument {
    pub manifest: PathBuf,
    pub guesses: Vec<GuessRow>,
    /// Remarks that concern several columns.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<String>,
    /// Logs that were segmented.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub logs: Vec<SegmentedLog>,
    /// Faulty values that are excluded.
    pub excluded: Vec<Exclusion>,
    /// Currents that are subtracted.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub currents: Vec<TrialCurrent>,
    pub trials: Vec<String>,
    pub errors: Vec<String>,
    /// Missing channels by law; empty for laws that the trials can identify.
    pub lacking: Vec<LawNeeds>,
    #[serde(skip)]
    pub explain: bool,
}

#[derive(Serialize)]
pub(super) struct GuessRow {
    pub file: String,
    pub column: String,
    pub channel: Option<String>,
    pub unit: Option<String>,
    pub reversed: bool,
    pub certain: bool,
    /// Posterior probability of the reading.
    pub probability: f64,
    pub why: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub question: Option<String>,
}

#[derive(Serialize)]
pub(super) struct LawNeeds {
    pub law: String,
    pub lacks: Vec<String>,
}

impl From<ColumnGuess> for GuessRow {
    fn from(guess: ColumnGuess) -> Self {
        let ColumnGuess {
            file,
            column,
            channel,
            unit,
            reversed,
            probability,
            why,
            certain,
            question,
        } = guess;
        Self { file, column, channel, unit, reversed, certain, probability, why, question }
    }
}
