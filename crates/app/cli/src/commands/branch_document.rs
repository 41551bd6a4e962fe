//! Output of `sistership branch`.

use std::path::Path;

use serde::Serialize;
use sistership_learned::{BranchChoice, CorrectionEvaluation, CorrectionTraining};

use super::written_files::WrittenFiles;
use crate::weights::CorrectionSummary;

/// Output document.
#[derive(Serialize)]
pub struct BranchDocument<'a> {
    /// The foundation.
    pub model: &'a str,
    /// Comparison of the kinds, if none was named.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub choice: Option<&'a BranchChoice>,
    /// The learned correction; null if none is used.
    pub branch: Option<CorrectionSummary<'a>>,
    /// Every setting of the training.
    pub training: Option<&'a CorrectionTraining>,
    /// The hash of the weights.
    pub weights_sha256: Option<&'a str>,
    /// Cross-validation on held-out trials; null if there is only one trial.
    pub judgement: Option<&'a CorrectionEvaluation>,
    /// True if the correction is better there by more than one standard error.
    pub wins: Option<bool>,
    /// The model written.
    #[serde(flatten)]
    pub files: WrittenFiles<'a>,
    /// The weights written.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub weights: Option<&'a Path>,
}
