//! Checks of settings.

use super::cma_es::CmaEs;
use super::outcome::RefineError;
use super::settings::{ALGORITHM_REVISION, Prior, RefinementSettings, TuningRange};

/// A setting that cannot be used.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct SettingFault {
    /// The field.
    pub field: String,
    /// Values that are allowed.
    pub message: String,
}

impl RefinementSettings {
    /// Checks that all settings are in range and consistent.
    ///
    /// # Errors
    /// Returns every field that cannot be used, with the values that are allowed.
    pub fn check(&self) -> Result<(), Vec<SettingFault>> {
        let fault =
            |field: &str, message: String| SettingFault { field: field.to_owned(), message };
        // All rules are checked, so that one answer names every fault.
        let rules = [self.choice_rules(), self.count_rules(), self.time_rules()].concat();
        let broken = rules.into_iter().filter(|(.., is_kept)| !is_kept);
        let cma_es = self.cma_es.as_ref().map_or(Ok(()), CmaEs::check);
        let parts = [
            ("cma_es", cma_es.map_err(|error| error.to_string())),
            ("constraints", self.constraints.check().map_err(|error| error.to_string())),
            ("bands", self.bands.check().map_err(|error| error.to_string())),
        ];
        let of_parts =
            parts.into_iter().filter_map(|(field, part)| Some(fault(field, part.err()?)));
        let all: Vec<SettingFault> = broken
            .map(|(field, message, _)| fault(field, message.to_owned()))
            .chain(of_parts)
            .collect();
        if all.is_empty() { Ok(()) } else { Err(all) }
    }

    /// Rules for ranges, strengths and positions.
    fn choice_rules(&self) -> Vec<SettingRule> {
        let is_ordered = |range: &TuningRange| {
            range.lambda_min > 0.0
                && range.lambda_min <= range.lambda_max
                && range.lambda_max.is_finite()
        };
        let is_share = |share: &f64| (0.0..=1.0).contains(share);
        let (ranges, positions) = (&self.ranges, &self.mixture_positions);
        let strengths = self.strengths.len() <= 100 && self.strengths.iter().all(is_positive);
        let places = positions.len() <= 20 && positions.iter().all(is_share);
        let ordered = "lambda_min must be above 0 and not above lambda_max";
        let pulled = ranges.iter().all(|range| is_share(&range.alpha_max));
        let of_mixture = positions.is_empty() || self.prior == Prior::Mixture;
        vec![
            ("ranges", "give 1 to 20 tuning ranges", (1..=20).contains(&ranges.len())),
            ("ranges", ordered, ranges.iter().all(is_ordered)),
            ("ranges", "alpha_max must be from 0 to 1", pulled),
            ("strengths", "give at most 100, each above 0", strengths),
            ("mixture_positions", "give at most 20, each from 0 to 1", places),
            ("mixture_positions", "apply to the prior `mixture` only", of_mixture),
            ("roll_strength", "must be above 0", self.roll_strength.iter().all(is_positive)),
        ]
    }

    /// Rules for numbers of values, folds and samples, and for the methods that keep constraints.
    fn count_rules(&self) -> Vec<SettingRule> {
        let kept = self.method.keeps_constraints() || self.constraints.is_empty();
        let is_own_revision = self.algorithm_revision == ALGORITHM_REVISION;
        vec![
            ("algorithm_revision", OTHER_REVISION, is_own_revision),
            ("lambda_count", "must be from 2 to 1000", (2..=1000).contains(&self.lambda_count)),
            ("folds", "must be from 2 to 100", (2..=100).contains(&self.folds)),
            ("calibration_samples", "must be at least 1", self.calibration_samples != Some(0)),
            ("constraints", "are supported by the methods `published` and `weak` only", kept),
        ]
    }

    /// Rules for times: all are above 0 s.
    fn time_rules(&self) -> Vec<SettingRule> {
        let times = [
            ("difference_s", self.difference_s),
            ("restart_s", self.restart_s),
            ("smoothing_s", self.smoothing_s),
            ("part_s", self.part_s),
            ("window_s", self.window_s),
            ("hop_s", self.hop_s),
            ("segment_s", self.segment_s),
            ("residual_s", self.residual_s),
            ("step_s", self.step_s),
        ];
        let rule = |(field, time): (_, Option<f64>)| {
            (field, "must be above 0 s", time.iter().all(is_positive))
        };
        let longer_s = &self.longer_restarts_s;
        let are_usable = longer_s.len() <= 10 && longer_s.iter().all(is_positive);
        let longer = ("longer_restarts_s", "give at most 10, each above 0 s", are_usable);
        times.into_iter().map(rule).chain([longer]).collect()
    }
}

/// Combines faults into one error with the field of the first.
pub(super) fn combined_error(faults: Vec<SettingFault>) -> RefineError {
    // The error has one field; further faults follow in its message.
    let further =
        faults.iter().skip(1).map(|fault| format!("; {}: {}", fault.field, fault.message));
    let further: String = further.collect();
    let SettingFault { field, message } = faults.into_iter().next().unwrap_or_default();
    RefineError::Setting { field, message: message + &further }
}

/// Refusal of settings for another revision of the algorithm.
const OTHER_REVISION: &str = "must be the one revision that this program supports; omit it, \
                              or use the version of sistership that made these settings";

/// A rule: field, allowed values, and true if it is kept.
type SettingRule = (&'static str, &'static str, bool);

fn is_positive(value: &f64) -> bool {
    *value > 0.0 && value.is_finite()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_setting_that_cannot_be_used_is_named() {
        assert_eq!(RefinementSettings::default().check(), Ok(()));
        let settings = RefinementSettings {
            algorithm_revision: ALGORITHM_REVISION + 1,
            folds: 1,
            strengths: vec![1.0, f64::NAN],
            roll_strength: Some(-1.0),
            window_s: Some(0.0),
            hop_s: Some(f64::INFINITY),
            mixture_positions: vec![2.0],
            ..RefinementSettings::default()
        };
        let faults = settings.check().err().unwrap_or_default();
        let fields: Vec<&str> = faults.iter().map(|fault| fault.field.as_str()).collect();
        let expected = [
            "strengths",
            "mixture_positions",
            "mixture_positions",
            "roll_strength",
            "algorithm_revision",
            "folds",
            "window_s",
            "hop_s",
        ];
        assert_eq!(fields, expected);
        let told = combined_error(faults).to_string();
        assert!(told.contains("strengths") && told.contains("hop_s: must be above 0 s"), "{told}");
    }
}
