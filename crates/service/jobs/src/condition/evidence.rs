//! Sequential evidence from the diagnoses of a champion, in the order of its trials.
//!
//! Each trial counts once, by the narrowest diagnosis that it is part of, so that new trials are
//! judged by themselves. The cumulative sum of log likelihood ratios (incomplete model to complete
//! model) of the verdicts (Page 1954, "Continuous inspection schemes", Biometrika 41) says whether
//! the champion is still valid, and since which trial it is not: one clean trial does not clear
//! three with unexplained forces. A cause too small for a single trial shows in the diagnosis of
//! all.

use std::collections::{BTreeMap, BTreeSet};

use sistership_store::{DiagnosisRow, VersionHead};

/// Error probabilities of a diagnosis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EvidenceLimits {
    /// `alpha`: probability of reporting an effect or an unexplained trial although nothing is
    /// missing, dimensionless. Source: docs/evidence/diagnosis_unseen.md, "Clean trials of more
    /// ships": at most 2 % (0 of 144, 95 % limit by the rule of three).
    pub false_alarm: f64,
    /// `beta`: probability of finding nothing although an effect of usual size is missing,
    /// dimensionless. Source: the probability by which a diagnosis states its detection limits
    /// (`diagnosis::DetectionLimit`). At half and double of each, three trials with unexplained
    /// forces are cleared by four to seven clean ones (docs/evidence/condition.md).
    pub miss: f64,
}

impl Default for EvidenceLimits {
    fn default() -> Self {
        Self { false_alarm: 0.02, miss: 0.1 }
    }
}

impl EvidenceLimits {
    /// Step of the cumulative sum after a diagnosis: the log likelihood ratio of its verdict.
    fn log_likelihood_ratio(self, holds: bool) -> f64 {
        // ln(beta / (1 - alpha)) < 0 for a complete model, ln((1 - beta) / alpha) > 0 otherwise.
        match holds {
            true => (self.miss / (1.0 - self.false_alarm)).ln(),
            false => ((1.0 - self.miss) / self.false_alarm).ln(),
        }
    }
}

/// Verdict of one diagnosis on a version.
#[derive(Debug, Clone)]
pub(super) struct DiagnosisVerdict<'a> {
    /// The diagnosis.
    pub row: &'a DiagnosisRow,
    /// `complete`, `effects` or `unexplained`.
    pub verdict: &'a str,
    /// Names of the effects that the version lacks.
    pub effects: Vec<String>,
    /// Ids of its trials, in the order of their upload.
    pub trials: Vec<String>,
    /// Trials of it with unexplained forces.
    unexplained: Vec<String>,
}

impl<'a> DiagnosisVerdict<'a> {
    /// Reads a diagnosis. For the version that resulted from it, the verdict is the one with the
    /// effects added.
    fn new(version: &VersionHead, row: &'a DiagnosisRow) -> Self {
        let is_subject = row.version_id == version.id;
        let verdict = match (is_subject, row.verdict.as_str()) {
            // The resulting version contains the effects that were found, so nothing is missing
            // from it.
            (false, "effects") => COMPLETE,
            (_, verdict) => verdict,
        };
        let effects = if is_subject { parse_list(&row.effects) } else { Vec::new() };
        let mut trials = parse_list(&row.trials);
        trials.sort();
        Self { row, verdict, effects, trials, unexplained: parse_list(&row.unexplained) }
    }

    /// True if the diagnosis finds nothing missing.
    pub fn is_complete(&self) -> bool {
        self.verdict == COMPLETE
    }

    /// Returns the first trial that contradicts the model; a missing effect concerns all trials.
    pub fn first_contradicting_trial(&self) -> Option<&String> {
        let left = self.trials.iter().find(|trial| self.unexplained.contains(trial));
        let first = self.trials.first();
        if self.effects.is_empty() { left.or(first) } else { first }
    }

    fn contains(&self, other: &Self) -> bool {
        other.trials.len() < self.trials.len()
            && other.trials.iter().all(|trial| self.trials.contains(trial))
    }
}

const COMPLETE: &str = "complete";

fn parse_list(text: &str) -> Vec<String> {
    // The store writes these lists itself; an unreadable one counts as empty.
    serde_json::from_str(text).unwrap_or_default()
}

/// Evidence of all diagnoses of a version.
#[derive(Debug, Default)]
pub(super) struct ConditionEvidence<'a> {
    /// The diagnosis by which each trial counts, in the order of the trials.
    pub sequence: Vec<DiagnosisVerdict<'a>>,
    /// Newest diagnosis that combines trials of other diagnoses.
    pub whole: Option<DiagnosisVerdict<'a>>,
    /// Index in the sequence at which the cumulative sum began to rise, if it is above zero at the
    /// end.
    alarm: Option<usize>,
}

impl<'a> ConditionEvidence<'a> {
    /// Combines diagnoses, latest first; those on a deleted trial do not count.
    pub fn new(
        version: &VersionHead,
        rows: &'a [DiagnosisRow],
        deleted: &[String],
        limits: EvidenceLimits,
    ) -> Self {
        let is_kept = |observation: &DiagnosisVerdict<'_>| {
            !observation.trials.iter().any(|trial| deleted.contains(trial))
        };
        let all: Vec<DiagnosisVerdict<'a>> =
            rows.iter().map(|row| DiagnosisVerdict::new(version, row)).filter(is_kept).collect();
        let gathers = |one: &&DiagnosisVerdict<'_>| all.iter().any(|other| one.contains(other));
        let whole = all.iter().find(gathers).cloned();
        let sequence = narrowest_diagnoses(&all);
        let alarm = alarm_start(&sequence, limits);
        Self { sequence, whole, alarm }
    }

    /// Returns the diagnoses that contradict the version, that of all trials first.
    pub fn contradicting_diagnoses(&self) -> Vec<&DiagnosisVerdict<'a>> {
        let whole = self.whole.iter().filter(|whole| !whole.is_complete());
        let since = self.sequence.iter().skip(self.alarm.unwrap_or(self.sequence.len()));
        whole.chain(since.filter(|one| !one.is_complete())).collect()
    }

    /// Returns the first trial from which the version is not valid.
    pub fn invalid_since(&self) -> Option<&String> {
        let alarm = self.alarm.and_then(|at| self.sequence[at].first_contradicting_trial());
        let whole = self.whole.as_ref().filter(|whole| !whole.is_complete());
        alarm.or_else(|| whole.and_then(DiagnosisVerdict::first_contradicting_trial))
    }

    /// Returns the first trial after the last one that contradicted the version.
    pub fn valid_since(&self) -> Option<&String> {
        let last = self.sequence.iter().rposition(|one| !one.is_complete()).map_or(0, |at| at + 1);
        self.sequence.get(last).and_then(|one| one.trials.first())
    }

    /// Returns the ids of all trials that count.
    pub fn counted_trials(&self) -> BTreeSet<String> {
        self.sequence.iter().flat_map(|one| one.trials.iter().cloned()).collect()
    }
}

/// Selects the narrowest diagnosis of each trial, the latest of equal ones, in the order of the
/// trials.
fn narrowest_diagnoses<'a>(all: &[DiagnosisVerdict<'a>]) -> Vec<DiagnosisVerdict<'a>> {
    let mut of_trial: BTreeMap<&str, usize> = BTreeMap::new();
    for (at, one) in all.iter().enumerate() {
        for trial in &one.trials {
            let chosen = of_trial.entry(trial).or_insert(at);
            if one.trials.len() < all[*chosen].trials.len() {
                *chosen = at;
            }
        }
    }
    // `of_trial` is ordered by trial id, and ids are ordered by upload.
    let mut taken = BTreeSet::new();
    of_trial.into_values().filter(|at| taken.insert(*at)).map(|at| all[at].clone()).collect()
}

/// Returns the index at which the cumulative sum began to rise, if it is above zero at the end.
fn alarm_start(sequence: &[DiagnosisVerdict<'_>], limits: EvidenceLimits) -> Option<usize> {
    let (mut sum, mut start) = (0.0, None);
    for (at, one) in sequence.iter().enumerate() {
        // Page's test: S_k = max(0, S_(k-1) + step_k).
        sum = f64::max(0.0, sum + limits.log_likelihood_ratio(one.is_complete()));
        start = if sum > 0.0 { start.or(Some(at)) } else { None };
    }
    start
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn version() -> VersionHead {
        VersionHead {
            id: "v".into(),
            model: "kcs".into(),
            number: 1,
            parent: None,
            law: "abkowitz".into(),
            method: "weak".into(),
            sha256: String::new(),
            created_us: 0,
            author: "ann".into(),
        }
    }

    fn row(id: usize, trials: &[&str], verdict: &str) -> DiagnosisRow {
        DiagnosisRow {
            id: format!("{id:03}"),
            version_id: "v".into(),
            made_id: None,
            report_id: "r".into(),
            verdict: verdict.into(),
            effects: if verdict == "effects" { r#"["current"]"# } else { "[]" }.into(),
            trials: serde_json::to_string(trials).unwrap(),
            unexplained: "[]".into(),
            drift: None,
            created_us: 0,
        }
    }

    /// Diagnoses in the order in which they were made, as the store gives them.
    fn newest_first(mut rows: Vec<DiagnosisRow>) -> Vec<DiagnosisRow> {
        rows.reverse();
        rows
    }

    fn weighed(rows: &[DiagnosisRow]) -> ConditionEvidence<'_> {
        ConditionEvidence::new(&version(), rows, &[], EvidenceLimits::default())
    }

    #[test]
    fn one_clean_trial_does_not_clear_three_bad_ones() {
        let bad = |at: usize, trial: &str| row(at, &[trial], "unexplained");
        let mut rows = vec![row(0, &["a"], "complete"), bad(1, "b"), bad(2, "c"), bad(3, "d")];
        rows.push(row(4, &["e"], "complete"));
        let rows = newest_first(rows);
        let evidence = weighed(&rows);
        assert_eq!(
            (evidence.contradicting_diagnoses().len(), evidence.invalid_since().unwrap().as_str()),
            (3, "b")
        );
        assert_eq!(evidence.counted_trials().len(), 5);
    }

    /// Three trials that leave something, then clean ones, with errors of a diagnosis at half and
    /// at double of what is measured.
    #[test]
    fn many_clean_trials_do_and_how_many_hardly_depends_on_the_rates() {
        let default = EvidenceLimits::default();
        for factors in [(1.0, 1.0), (0.5, 1.0), (2.0, 1.0), (1.0, 0.5), (1.0, 2.0)] {
            let limits = EvidenceLimits {
                false_alarm: factors.0 * default.false_alarm,
                miss: factors.1 * default.miss,
            };
            let cleared = (0..20).find(|&clean| {
                let verdict = |at| if at < 3 { "unexplained" } else { "complete" };
                let name = |at| format!("{at:02}");
                let rows = (0..3 + clean).map(|at| row(at, &[&name(at)], verdict(at))).collect();
                let rows = newest_first(rows);
                ConditionEvidence::new(&version(), &rows, &[], limits)
                    .contradicting_diagnoses()
                    .is_empty()
            });
            println!("{factors:?}: cleared by {cleared:?}");
            assert!((4..=8).contains(&cleared.unwrap()), "{factors:?}: {cleared:?}");
        }
    }

    #[test]
    fn a_trial_counts_once_by_its_narrowest_diagnosis_and_the_whole_beside() {
        let rows = newest_first(vec![
            row(0, &["a"], "complete"),
            row(1, &["b"], "complete"),
            row(2, &["a", "b"], "effects"),
            row(3, &["b"], "complete"),
        ]);
        let evidence = weighed(&rows);
        let ids: Vec<&str> = evidence.sequence.iter().map(|one| one.row.id.as_str()).collect();
        assert_eq!(ids, ["000", "003"]);
        assert_eq!(evidence.whole.as_ref().unwrap().row.id, "002");
        assert_eq!(
            (evidence.contradicting_diagnoses().len(), evidence.invalid_since().unwrap().as_str()),
            (1, "a")
        );
    }

    #[test]
    fn what_was_found_on_a_deleted_trial_does_not_count() {
        let rows = newest_first(vec![row(0, &["a"], "complete"), row(1, &["b"], "unexplained")]);
        let deleted = ["b".to_owned()];
        let evidence =
            ConditionEvidence::new(&version(), &rows, &deleted, EvidenceLimits::default());
        assert!(evidence.contradicting_diagnoses().is_empty());
        assert_eq!(evidence.valid_since().unwrap(), "a");
    }

    #[test]
    fn the_trial_that_leaves_something_is_named_among_several() {
        let mut left = row(0, &["a", "b", "c"], "unexplained");
        left.unexplained = r#"["b"]"#.into();
        let rows = [left];
        assert_eq!(weighed(&rows).invalid_since().unwrap(), "b");
    }
}
