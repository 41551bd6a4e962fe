//! Jobs and trials as lists show them.

use serde_json::Value;
use sistership_store::{Job, Trial};

use crate::date::format_date;
use crate::language::{say, say_word};
use crate::numbers::format_fixed;

/// A job in a list.
pub(crate) struct JobRow {
    pub id: String,
    pub kind: String,
    pub ship: String,
    pub state: &'static str,
    pub percent: u32,
    pub message: String,
    pub created: String,
}

impl JobRow {
    pub fn from_job(job: Job) -> Self {
        let percent = (100.0 * job.progress.clamp(0.0, 1.0)).round() as u32;
        let (state, created, outcome) =
            (job.state.as_str(), format_date(job.created_us), outcome_text(&job));
        // A result takes precedence over an error, and this over the last message.
        let message = outcome.or(job.error).unwrap_or(job.message);
        let (id, kind, ship) = (job.id, job.kind, job.ship.unwrap_or_default());
        Self { id, kind, ship, state, percent, message, created }
    }

    /// Kind in words.
    pub fn kind_words(&self) -> String {
        say_word("job-kind", &self.kind)
    }

    /// State in words.
    pub fn state_words(&self) -> String {
        say_word("job-state", self.state)
    }
}

/// Returns the result of a completed job in words.
fn outcome_text(job: &Job) -> Option<String> {
    let result: Value = serde_json::from_str(job.result.as_deref()?).ok()?;
    if let Some(verdict) = result["verdict"].as_str() {
        return Some(diagnosis_text(verdict, &result));
    }
    let (version, alias) = (result["version"].as_i64()?, result["alias"].as_str()?);
    let text = match result["from"].as_str() {
        Some(from) => say("outcome-version-from").with("from", from),
        None => say("outcome-version"),
    };
    Some(text.with("number", version).with("alias", alias).to_string())
}

/// Returns the result of a diagnosis in words.
fn diagnosis_text(verdict: &str, result: &Value) -> String {
    let diagnosed = result["diagnosed"].as_str().unwrap_or_default();
    let effects: Vec<&str> =
        result["effects"].as_array().into_iter().flatten().filter_map(Value::as_str).collect();
    let text = match effects.as_slice() {
        [] => say("outcome-diagnosed").with("verdict", say_word("verdict", verdict)),
        effects => say("outcome-lacks")
            .with("effects", effects.join(", "))
            .with("number", result["version"].to_string()),
    };
    text.with("model", diagnosed).to_string()
}

/// A trial in a list.
pub(crate) struct TrialRow {
    pub id: String,
    pub name: String,
    pub manoeuvre: String,
    pub rows: i64,
    pub duration: String,
    pub warnings: usize,
    pub created: String,
}

impl TrialRow {
    pub fn from_trial(trial: Trial) -> Self {
        let warnings = serde_json::from_str::<Vec<Value>>(&trial.warnings)
            .map_or(0, |warnings| warnings.len());
        Self {
            id: trial.id,
            name: trial.name,
            manoeuvre: trial.manoeuvre.unwrap_or_default(),
            rows: trial.sample_rows,
            duration: format!("{} s", format_fixed(trial.duration_s, 0)),
            warnings,
            created: format_date(trial.created_us),
        }
    }
}
