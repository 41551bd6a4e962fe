//! Whether settings can be used at all.

use super::cma_es::CmaEs;
use super::settings::{Prior, Range, Settings};

impl Settings {
    /// Checks the numbers.
    ///
    /// # Errors
    /// Names the field and what it may be.
    pub fn check(&self) -> Result<(), (String, String)> {
        let named = |(field, message): (&str, &str)| (field.to_owned(), message.to_owned());
        self.check_ranges().map_err(named)?;
        self.check_positions().map_err(|message| named(("mixture_positions", message)))?;
        self.check_counts().map_err(named)?;
        self.check_times().map_err(named)?;
        let of = |field: &str, message: String| (field.to_owned(), message);
        let cma_es = self.cma_es.as_ref().map_or(Ok(()), CmaEs::check);
        cma_es.map_err(|error| of("cma_es", error.to_string()))?;
        self.constraints.check().map_err(|error| of("constraints", error.to_string()))?;
        self.bands.check().map_err(|error| of("bands", error.to_string()))
    }

    fn check_ranges(&self) -> Result<(), Refused> {
        if self.ranges.is_empty() || self.ranges.len() > 20 {
            return Err(("ranges", "give 1 to 20 tuning ranges"));
        }
        let is_ordered = |range: &Range| {
            range.lambda_min > 0.0
                && range.lambda_min <= range.lambda_max
                && range.lambda_max.is_finite()
        };
        if !self.ranges.iter().all(is_ordered) {
            return Err(("ranges", "lambda_min must be above 0 and not above lambda_max"));
        }
        if !self.ranges.iter().all(|range| (0.0..=1.0).contains(&range.alpha_max)) {
            return Err(("ranges", "alpha_max must be from 0 to 1"));
        }
        if self.roll_strength.is_some_and(|roll| !is_positive(roll)) {
            return Err(("roll_strength", "must be above 0"));
        }
        if self.strengths.len() > 100 || !self.strengths.iter().all(|one| is_positive(*one)) {
            return Err(("strengths", "give at most 100, each above 0"));
        }
        Ok(())
    }

    fn check_positions(&self) -> Result<(), &'static str> {
        let positions = &self.mixture_positions;
        if positions.len() > 20 || positions.iter().any(|at| !(0.0..=1.0).contains(at)) {
            return Err("give at most 20, each from 0 to 1");
        }
        if !positions.is_empty() && self.prior != Prior::Mixture {
            return Err("are of the prior `mixture`");
        }
        Ok(())
    }

    fn check_counts(&self) -> Result<(), Refused> {
        if !(2..=1000).contains(&self.lambda_count) {
            return Err(("lambda_count", "must be from 2 to 1000"));
        }
        if !(2..=100).contains(&self.folds) {
            return Err(("folds", "must be from 2 to 100"));
        }
        if self.calibration_samples == Some(0) {
            return Err(("calibration_samples", "must be at least 1"));
        }
        if !self.method.keeps_constraints() && !self.constraints.is_empty() {
            return Err(("constraints", "are kept by the methods `published` and `weak` only"));
        }
        Ok(())
    }

    fn check_times(&self) -> Result<(), Refused> {
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
        let refused = times.into_iter().find(|(_, time)| !time.is_none_or(is_positive));
        refused.map_or(Ok(()), |(field, _)| Err((field, "must be above 0 s")))
    }
}

/// A field, and what it may be.
type Refused = (&'static str, &'static str);

fn is_positive(value: f64) -> bool {
    value > 0.0 && value.is_finite()
}
