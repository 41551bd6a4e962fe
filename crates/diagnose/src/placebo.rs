//! Whether an effect that follows a record follows it: the record of another time must not do as well.

use sistership_model::Trial;

use super::base::Base;
use super::discount::{OUTSIDE, is_from_outside};
use super::search::{Judged, Search};
use sistership_estimate::refine::RefineError;

/// By which shares of a trial its records are shifted.
const SHIFTS: [f64; 3] = [0.25, 0.5, 0.75];

impl Search<'_> {
    /// Whether the effect that came last follows a record from outside, and records of another time explain the trials
    /// better.
    ///
    /// # Errors
    /// Names what a trial lacks.
    pub fn is_placebo(&self, judged: &Judged, base: &Base<'_>) -> Result<bool, RefineError> {
        let Some(last) = judged.candidates.last().filter(|candidate| is_from_outside(candidate)) else { return Ok(false) };
        let again = |search: &Search<'_>| {
            let there = search.bare(&base.taken, &search.levels)?;
            Ok(search.judge(&there, last, judged.level)?.log_evidence)
        };
        self.exceeds(judged.log_evidence, &again)
    }

    /// Whether effects explain the trials better, by a margin, than with records from outside of any other time.
    ///
    /// # Errors
    /// Names what a trial lacks.
    pub fn follow_records(&self, judged: &Judged, margin: f64) -> Result<bool, RefineError> {
        let again = |search: &Search<'_>| {
            let there = search.bare(&judged.candidates, &search.levels)?;
            Ok(search.alone(&there)?.1.log_evidence)
        };
        Ok(!self.exceeds(judged.log_evidence - margin, &again)?)
    }

    /// Whether with the records of any other time the evidence is more than so much.
    fn exceeds(&self, limit: f64, evidence: &dyn Fn(&Search<'_>) -> Result<f64, RefineError>) -> Result<bool, RefineError> {
        for share in SHIFTS {
            let shifted: Vec<Trial> = self.trials.iter().map(|trial| shifted(trial, share)).collect();
            let trials: Vec<&Trial> = shifted.iter().collect();
            if evidence(&self.on(&trials))? > limit {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// The same search on other trials.
    fn on<'b>(&'b self, trials: &'b [&'b Trial]) -> Search<'b> {
        Search { trials, ..self.clone() }
    }
}

/// A trial with its records of what is outside shifted by a share of it; their ends are joined.
fn shifted(trial: &Trial, share: f64) -> Trial {
    let mut trial = trial.clone();
    for channel in OUTSIDE {
        if let Some(values) = trial.channels.get_mut(&channel) {
            let by = (share * values.len() as f64) as usize;
            values.rotate_left(by);
        }
    }
    trial
}
