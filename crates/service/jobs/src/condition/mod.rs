//! Validity of a ship's model: all diagnoses of its champion and the drift since it was fitted,
//! combined.

mod description;
mod effect_sequence;
mod evidence;
mod joint_trials;
mod recent_drift;
#[cfg(test)]
mod tests;

use std::collections::BTreeSet;

use serde::Serialize;
use sistership_store::{DiagnosisRow, Store, StoreError, VersionHead, read_all_pages};
use utoipa::ToSchema;

use self::evidence::{ConditionEvidence, DiagnosisVerdict, EvidenceLimits};
use crate::aliases::{CHAMPION, find_alias};

pub use effect_sequence::EffectSequence;
pub use joint_trials::{MAX_JOINT_TRIALS, fitted_samples, trials_to_diagnose};
pub use recent_drift::{DRIFT_LIMIT, RecentDrift};

/// Validity of the champion of a ship, by all its diagnoses and its drift.
#[derive(Debug, Clone, Default, Serialize, ToSchema)]
pub struct Condition {
    /// `holds`, `does_not_hold`, or `unknown` if its champion was never diagnosed.
    pub model: ModelValidity,
    /// The same in one sentence.
    pub sentence: String,
    /// The number of its champion.
    pub version: Option<i64>,
    /// Verdict on the champion: `complete`, `effects`, `unexplained`, or `drift` if only the drift
    /// contradicts it.
    pub verdict: Option<String>,
    /// Names of the effects that the champion lacks.
    pub effects: Vec<String>,
    /// Ids of the trials that it was diagnosed on.
    pub trials: Vec<String>,
    /// Ids of the trials that contradict it.
    pub against: Vec<String>,
    /// The most informative diagnosis: of those that contradict it, the one of most trials.
    pub found_by: Option<DiagnosisReference>,
    /// The first trial of this condition: from it on the champion is not valid, or every trial was
    /// clean.
    pub since: Option<SinceTrial>,
    /// Unexplained force on its newest trials relative to the trials it was fitted on.
    pub drift: Option<RecentDrift>,
    /// The diagnoses by which each trial counts, in the order of the trials, then that of all
    /// trials.
    pub diagnoses: Vec<WeighedDiagnosis>,
    /// The version with the effects that the champion lacks.
    pub with_effects: Option<VersionWithEffects>,
    /// Id of the newest diagnosis, and the number of deleted trials; part of the entity tag.
    #[serde(skip)]
    state: String,
}

/// Validity of a model.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum ModelValidity {
    /// Its residual is explained by the measurement noise.
    Holds,
    /// Something is missing.
    DoesNotHold,
    /// It was never diagnosed.
    #[default]
    Unknown,
}

/// Reference to a diagnosis.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct DiagnosisReference {
    /// Its id.
    pub diagnosis: String,
    /// Time of the diagnosis, microseconds since 1970.
    pub at_us: i64,
    /// Path of its report, as data and as a page (`?format=html`).
    pub report: String,
}

/// The first trial of a condition.
#[derive(Debug, Clone, Default, PartialEq, Serialize, ToSchema)]
pub struct SinceTrial {
    /// Its id.
    pub trial: String,
    /// Its name for people.
    pub name: String,
    /// Time of its upload, microseconds since 1970.
    pub at_us: i64,
}

/// A diagnosis that counts.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct WeighedDiagnosis {
    /// The diagnosis.
    #[serde(flatten)]
    pub by: DiagnosisReference,
    /// Ids of its trials.
    pub trials: Vec<String>,
    /// `complete`, `effects` or `unexplained`.
    pub verdict: String,
    /// True for the diagnosis of all trials, which other diagnoses share.
    pub whole: bool,
}

/// Version that resulted from a diagnosis.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct VersionWithEffects {
    /// Its number.
    pub number: i64,
    /// Its path.
    pub at: String,
}

impl Condition {
    /// Reads the present condition of a ship.
    ///
    /// # Errors
    /// Returns an error if the store does not answer.
    pub async fn read_current(store: &Store, ship: &str) -> Result<Self, StoreError> {
        let Some(champion) = find_alias(store, ship, CHAMPION).await? else {
            return Ok(Self {
                sentence: "Unknown: it has no champion yet.".into(),
                ..Self::default()
            });
        };
        let version = store.versions().get_head(ship, champion.version_number).await?;
        let (diagnoses, id) = (store.diagnoses(), version.id.as_str());
        let rows =
            read_all_pages(|page| async move { diagnoses.by_version(id, &page).await }).await?;
        // What a deleted trial showed must not count.
        let deleted = store.deleted_trials(&diagnosed_trials(&rows)).await?;
        let mut condition = Self::from_diagnoses(&version, &rows, &deleted);
        if let Some(since) = &mut condition.since {
            let trial = store.trials().get(&since.trial).await?;
            (since.name, since.at_us) = (trial.name, trial.created_us);
        }
        condition.sentence = condition.describe();
        if let Some(made) = condition.version_with_effects(&version, &rows) {
            condition.with_effects =
                Some(VersionWithEffects::from_head(store.versions().by_id(made).await?.head));
        }
        Ok(condition)
    }

    /// Returns the condition by the diagnoses of a champion, latest first, without those on deleted
    /// trials. The sentence, names of trials and the version with effects are not filled in.
    pub fn from_diagnoses(
        version: &VersionHead,
        rows: &[DiagnosisRow],
        deleted: &[String],
    ) -> Self {
        // The store gives the latest diagnosis first.
        let evidence = ConditionEvidence::new(version, rows, deleted, EvidenceLimits::default());
        let number = Some(version.number);
        if evidence.sequence.is_empty() {
            return Self { version: number, ..Self::default() };
        }
        let drift = latest_drift(version, rows);
        let condition = Self {
            version: number,
            trials: evidence.counted_trials().into_iter().collect(),
            diagnoses: weighed_diagnoses(&evidence),
            state: diagnosis_state(rows, deleted),
            drift,
            ..Self::default()
        };
        // Drift alone is enough: it may rise before a diagnosis on single trials finds a cause.
        let drifted = condition.drift.as_ref().is_some_and(RecentDrift::is_above_limit);
        match evidence.contradicting_diagnoses().is_empty() && !drifted {
            true => condition.with_valid_model(&evidence),
            false => condition.with_invalid_model(&evidence),
        }
    }

    fn with_valid_model(self, evidence: &ConditionEvidence<'_>) -> Self {
        // Ids are ordered by time, so the larger one is the newer diagnosis.
        let newest = evidence.whole.iter().chain(evidence.sequence.last());
        let found_by = newest.max_by(|a, b| a.row.id.cmp(&b.row.id));
        Self {
            model: ModelValidity::Holds,
            verdict: Some("complete".to_owned()),
            found_by: found_by.map(|one| DiagnosisReference::from_row(one.row)),
            since: evidence.valid_since().map(|trial| SinceTrial::from_id(trial)),
            ..self
        }
    }

    fn with_invalid_model(self, evidence: &ConditionEvidence<'_>) -> Self {
        let against = evidence.contradicting_diagnoses();
        let drifted = self.drift.as_ref().and_then(|drift| drift.since.as_ref());
        let since = evidence.invalid_since().or(drifted).map(|trial| SinceTrial::from_id(trial));
        // The diagnosis of most trials has the smallest standard errors.
        let found_by = against.iter().max_by_key(|one| one.trials.len());
        Self {
            model: ModelValidity::DoesNotHold,
            verdict: Some(overall_verdict(&against).to_owned()),
            effects: missing_effects(&against),
            against: contradicting_trials(&against),
            found_by: found_by.map(|one| DiagnosisReference::from_row(one.row)),
            since,
            ..self
        }
    }

    /// Returns the id of the version with the missing effects, if there is one.
    fn version_with_effects<'a>(
        &self,
        version: &VersionHead,
        rows: &'a [DiagnosisRow],
    ) -> Option<&'a String> {
        let mut of_version = rows.iter().filter(|row| row.version_id == version.id);
        let made = of_version.find_map(|row| row.made_id.as_ref());
        // If the model is valid by all evidence, nothing needs to be added to it.
        made.filter(|_| self.model == ModelValidity::DoesNotHold)
    }

    /// Tag that differs between any two states of the condition.
    pub fn entity_tag(&self) -> String {
        let version = self.version.map(|number| format!(".{number}")).unwrap_or_default();
        version + &self.state
    }
}

/// Returns the ids of the trials of diagnoses, each once.
pub fn diagnosed_trials(rows: &[DiagnosisRow]) -> Vec<String> {
    let list = |row: &DiagnosisRow| serde_json::from_str(&row.trials).unwrap_or_default();
    let ids: BTreeSet<String> =
        rows.iter().flat_map(list as fn(&DiagnosisRow) -> Vec<String>).collect();
    ids.into_iter().collect()
}

fn diagnosis_state(rows: &[DiagnosisRow], deleted: &[String]) -> String {
    let newest = rows.first().map_or("", |newest| newest.id.as_str());
    format!(".{newest}.{}", deleted.len())
}

/// Returns the drift recorded by the newest diagnosis of a version that has one.
fn latest_drift(version: &VersionHead, rows: &[DiagnosisRow]) -> Option<RecentDrift> {
    let mut of_version = rows.iter().filter(|row| row.version_id == version.id);
    of_version.find_map(|row| serde_json::from_str(row.drift.as_deref()?).ok())
}

fn weighed_diagnoses(evidence: &ConditionEvidence<'_>) -> Vec<WeighedDiagnosis> {
    let one = |one: &DiagnosisVerdict<'_>, whole| WeighedDiagnosis {
        by: DiagnosisReference::from_row(one.row),
        trials: one.trials.clone(),
        verdict: one.verdict.to_owned(),
        whole,
    };
    let parts = evidence.sequence.iter().map(|part| one(part, false));
    parts.chain(evidence.whole.iter().map(|whole| one(whole, true))).collect()
}

fn overall_verdict(against: &[&DiagnosisVerdict<'_>]) -> &'static str {
    match (against.is_empty(), against.iter().any(|one| one.verdict == "unexplained")) {
        (true, _) => "drift",
        (false, true) => "unexplained",
        (false, false) => "effects",
    }
}

fn missing_effects(against: &[&DiagnosisVerdict<'_>]) -> Vec<String> {
    let mut named: Vec<String> = Vec::new();
    for effect in against.iter().flat_map(|one| &one.effects) {
        if !named.contains(effect) {
            named.push(effect.clone());
        }
    }
    named
}

fn contradicting_trials(against: &[&DiagnosisVerdict<'_>]) -> Vec<String> {
    let trials: BTreeSet<&String> = against.iter().flat_map(|one| &one.trials).collect();
    trials.into_iter().cloned().collect()
}

impl SinceTrial {
    fn from_id(trial: &str) -> Self {
        Self { trial: trial.to_owned(), ..Self::default() }
    }
}

impl DiagnosisReference {
    fn from_row(diagnosed: &DiagnosisRow) -> Self {
        let report = format!("/v1/reports/{}", diagnosed.report_id);
        Self { diagnosis: diagnosed.id.clone(), at_us: diagnosed.created_us, report }
    }
}

impl VersionWithEffects {
    fn from_head(head: VersionHead) -> Self {
        Self {
            number: head.number,
            at: format!("/v1/models/{}/versions/{}", head.model, head.number),
        }
    }
}
