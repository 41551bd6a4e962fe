//! What `sistership branch` prints.

use std::path::Path;

use serde::Serialize;
use sistership_learned::{BranchChoice, Judgement, Training};

use super::written::WrittenFiles;
use crate::weights::BranchWords;

/// What is printed.
#[derive(Serialize)]
pub struct BranchDocument<'a> {
    /// The foundation.
    pub model: &'a str,
    /// What was tried, where no kind was named.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub choice: Option<&'a BranchChoice>,
    /// What was trained; none where no branch is taken.
    pub branch: Option<BranchWords<'a>>,
    /// Every setting of the training.
    pub training: Option<&'a Training>,
    /// The hash of the weights.
    pub weights_sha256: Option<&'a str>,
    /// What trials left out said; none where there is only one.
    pub judgement: Option<&'a Judgement>,
    /// Whether the branch is better there by more than one standard error.
    pub wins: Option<bool>,
    /// The model written.
    #[serde(flatten)]
    pub files: WrittenFiles<'a>,
    /// The weights written.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub weights: Option<&'a Path>,
}
