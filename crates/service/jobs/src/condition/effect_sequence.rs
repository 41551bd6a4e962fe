//! Diagnoses in sequence: the information of earlier trials on the effects of a ship.

use std::collections::BTreeSet;

use serde_json::Value;
use sistership_diagnosis::EffectHistory;
use sistership_store::{DiagnosisRow, Version, read_all_pages};

use crate::archive::Archive;
use crate::error::DeriveError;

/// Place of new trials in the sequence of the diagnoses of a version.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct EffectSequence {
    /// True if no diagnosis of the version has any of the trials: each counts once.
    pub is_new: bool,
    /// Information of the trials before them, if there are any.
    pub earlier: Option<EffectHistory>,
}

impl EffectSequence {
    /// Reads what the newest diagnosis of a version in the sequence has kept.
    ///
    /// # Errors
    /// Returns an error if the store does not answer.
    pub async fn read(
        archive: &Archive,
        version: &Version,
        trials: &[String],
    ) -> Result<Self, DeriveError> {
        let (diagnoses, id) = (archive.store.diagnoses(), version.head.id.as_str());
        let all =
            read_all_pages(|page| async move { diagnoses.by_version(id, &page).await }).await?;
        let own: Vec<DiagnosisRow> = all.into_iter().filter(|row| row.version_id == id).collect();
        // A trial counts once, in whichever diagnosis it came first.
        let known: BTreeSet<String> = own
            .iter()
            .flat_map(|row| serde_json::from_str::<Vec<String>>(&row.trials).unwrap_or_default())
            .collect();
        if trials.iter().any(|trial| known.contains(trial)) {
            return Ok(Self::default());
        }
        // The latest is first; those of trials that had been diagnosed before keep no history.
        for row in own {
            let report = archive.store.reports().get(&row.report_id).await?;
            let document: Value = serde_json::from_str(&report.document).unwrap_or_default();
            let history = serde_json::from_value(document["history"].clone()).ok();
            if history.is_some() {
                return Ok(Self { is_new: true, earlier: history });
            }
        }
        Ok(Self { is_new: true, earlier: None })
    }
}
