//! Jobs and trials as pages show them.

use serde_json::Value;
use sistership_store::{Job, Trial};

/// A job as a page shows it.
pub(super) struct JobRow {
    pub id: String,
    pub ship: String,
    pub state: &'static str,
    pub percent: u32,
    pub message: String,
    pub created: String,
}

impl JobRow {
    pub fn of(job: Job) -> Self {
        let percent = (100.0 * job.progress.clamp(0.0, 1.0)).round() as u32;
        let (state, created, outcome) = (job.state.as_str(), date(job.created_us), outcome(&job));
        let message = outcome.or(job.error).unwrap_or(job.message);
        Self { id: job.id, ship: job.ship.unwrap_or_default(), state, percent, message, created }
    }
}

/// What came of a job that is done.
fn outcome(job: &Job) -> Option<String> {
    let result: Value = serde_json::from_str(job.result.as_deref()?).ok()?;
    if let Some(verdict) = result["verdict"].as_str() {
        return Some(found(verdict, &result));
    }
    let (alias, source) = (result["alias"].as_str()?, result["source"].as_str()?);
    Some(format!("version {}, {alias}, from {source}", result["version"]))
}

/// What a diagnosis has found.
fn found(verdict: &str, result: &Value) -> String {
    let diagnosed = result["diagnosed"].as_str().unwrap_or_default();
    let effects: Vec<&str> =
        result["effects"].as_array().into_iter().flatten().filter_map(Value::as_str).collect();
    match effects.as_slice() {
        [] => format!("{diagnosed} diagnosed: {verdict}"),
        effects => format!(
            "{diagnosed} diagnosed: lacks {}; version {}",
            effects.join(", "),
            result["version"]
        ),
    }
}

/// A trial as a page shows it.
pub(super) struct TrialRow {
    pub id: String,
    pub name: String,
    pub manoeuvre: String,
    pub rows: i64,
    pub duration: String,
    pub warnings: usize,
}

impl TrialRow {
    pub fn of(trial: Trial) -> Self {
        let warnings = serde_json::from_str::<Vec<Value>>(&trial.warnings)
            .map_or(0, |warnings| warnings.len());
        let (manoeuvre, duration) =
            (trial.manoeuvre.unwrap_or_default(), format!("{:.0} s", trial.duration_s));
        Self {
            id: trial.id,
            name: trial.name,
            manoeuvre,
            rows: trial.sample_rows,
            duration,
            warnings,
        }
    }
}

/// A time as `2026-11-21 10:06` UTC; the civil calendar from days, after Howard Hinnant.
pub(super) fn date(us: i64) -> String {
    let seconds = us.div_euclid(1_000_000);
    let (days, second) = (seconds.div_euclid(86_400), seconds.rem_euclid(86_400));
    let shifted = days + 719_468;
    let (era, day_of_era) = (shifted.div_euclid(146_097), shifted.rem_euclid(146_097));
    let year_of_era =
        (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let from_march = (5 * day_of_year + 2) / 153;
    let (day, month) = (
        day_of_year - (153 * from_march + 2) / 5 + 1,
        from_march + if from_march < 10 { 3 } else { -9 },
    );
    let year = year_of_era + era * 400 + i64::from(month <= 2);
    format!("{year:04}-{month:02}-{day:02} {:02}:{:02}", second / 3600, second / 60 % 60)
}

#[cfg(test)]
mod tests {
    use super::date;

    #[test]
    fn dates_are_those_of_the_calendar() {
        assert_eq!(date(0), "1970-01-01 00:00");
        assert_eq!(date(951_782_400_000_000), "2000-02-29 00:00");
        assert_eq!(date(1_798_761_599_000_000), "2026-12-31 23:59");
        assert_eq!(date(1_800_000_000_000_000), "2027-01-15 08:00");
    }
}
