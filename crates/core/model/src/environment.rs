//! Wind, current and depth of a prediction in comparison with those that a model's trials covered.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::model::Model;
use crate::validity::Region;

/// Depth of a trial without a recorded one, m: below the deepest sea (10,935 m).
pub const DEEP_M: f64 = 12_000.0;

/// Tolerance between a value and the range of the trials, relative to the value: the last digit of
/// an anemometer.
const RELATIVE_TOLERANCE: f64 = 0.01;

/// Environment of a prediction; absent values mean calm air, no current and deep water.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct PredictionEnvironment {
    /// True wind speed, m/s.
    pub wind_speed_m_s: Option<f64>,
    /// Speed of the water over the ground, m/s.
    pub current_speed_m_s: Option<f64>,
    /// Water depth, m.
    pub depth_m: Option<f64>,
}

/// An input of a prediction that the model's trials did not cover.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct UncoveredInput {
    /// Its name with the unit.
    pub input: String,
    /// Its value.
    pub value: f64,
    /// Least and greatest value that the trials recorded; absent if they recorded none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub covered: Option<[f64; 2]>,
    /// Consequence for the prediction.
    pub message: String,
}

/// Input, with the effect of the library by which it acts.
struct EnvironmentInput {
    name: &'static str,
    words: &'static str,
    unit: &'static str,
    /// Names of [`Region::environment`] that record it.
    recorded: &'static [&'static str],
    effect: &'static str,
    /// Basis of the prediction in the absence of trials.
    basis: &'static str,
}

const WIND: EnvironmentInput = EnvironmentInput {
    name: "wind_speed_m_s",
    words: "wind",
    unit: "m/s",
    recorded: &["wind_speed", "apparent_wind_speed"],
    effect: "wind",
    basis: "its force is computed with the coefficients of a typical ship, not fitted to trials \
            of this ship",
};
const CURRENT: EnvironmentInput = EnvironmentInput {
    name: "current_speed_m_s",
    words: "current",
    unit: "m/s",
    recorded: &[],
    effect: "current",
    basis: "it is assumed to be uniform and steady, and to act through the relative velocity only",
};
const DEPTH: EnvironmentInput = EnvironmentInput {
    name: "depth_m",
    words: "water depth",
    unit: "m",
    recorded: &["depth"],
    effect: "shallow-water",
    basis: "the change by shallow water is computed by the formulas of the law, not fitted to \
            trials",
};

impl PredictionEnvironment {
    /// Returns the inputs that the model's trials did not cover. Still air and still or deep water
    /// do not count; neither does an input of an effect that was found in trials.
    pub fn uncovered_inputs(&self, model: &Model) -> Vec<UncoveredInput> {
        // Zero wind or current is no input of the prediction.
        let positive = |value: Option<f64>| value.filter(|value| *value > 0.0);
        let asked = [
            (WIND, positive(self.wind_speed_m_s)),
            (CURRENT, positive(self.current_speed_m_s)),
            (DEPTH, self.depth_m),
        ];
        let all = asked.into_iter().filter_map(|(input, value)| Some((input, value?)));
        all.filter_map(|(input, value)| input.check_coverage(value, model)).collect()
    }
}

impl EnvironmentInput {
    fn check_coverage(&self, value: f64, model: &Model) -> Option<UncoveredInput> {
        let covered = model.validity.as_ref().and_then(|region| self.covered_range(region));
        let is_inside = covered.is_some_and(|[low, high]| {
            (low - RELATIVE_TOLERANCE * value.abs()..=high + RELATIVE_TOLERANCE * value.abs())
                .contains(&value)
        });
        // Without a recorded range, an effect that was found in trials counts as coverage.
        let carries = model.effects.iter().any(|effect| effect.name == self.effect);
        if is_inside || (covered.is_none() && carries) {
            return None;
        }
        let message = self.coverage_message(value, covered, model.validity.is_some());
        Some(UncoveredInput { input: self.name.to_owned(), value, covered, message })
    }

    fn covered_range(&self, region: &Region) -> Option<[f64; 2]> {
        self.recorded.iter().find_map(|name| region.environment.get(*name)).copied()
    }

    fn coverage_message(&self, value: f64, covered: Option<[f64; 2]>, has_trials: bool) -> String {
        let Self { words, unit, basis, .. } = self;
        let trials = match covered {
            Some([low, high]) if high >= DEEP_M => {
                format!("the trials cover {low:.1} {unit} and deeper")
            }
            Some([low, high]) => format!("the trials cover {low:.1} to {high:.1} {unit}"),
            None if has_trials => "no trial of the model recorded it".to_owned(),
            None => "the range covered by trials of the model is unknown".to_owned(),
        };
        format!("{words} of {value:.1} {unit}: {trials}; {basis}")
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::zoo::Zoo;

    fn names(environment: PredictionEnvironment, recorded: &[(&str, [f64; 2])]) -> Vec<String> {
        let mut model = Zoo::load_embedded().unwrap().find_model("mariner").unwrap();
        let columns = [("u".to_owned(), vec![5.0, 6.0])].into();
        let mut region = Region::from_samples(&columns).unwrap();
        region.environment =
            recorded.iter().map(|&(name, range)| (name.to_owned(), range)).collect();
        model.validity = Some(region);
        environment.uncovered_inputs(&model).into_iter().map(|one| one.message).collect()
    }

    #[test]
    fn what_no_trial_recorded_is_named() {
        let storm = PredictionEnvironment {
            wind_speed_m_s: Some(25.0),
            current_speed_m_s: Some(1.0),
            depth_m: Some(12.0),
        };
        let all = names(storm, &[]);
        assert_eq!(all.len(), 3, "{all:?}");
        assert!(all[0].starts_with("wind of 25.0 m/s: no trial of the model recorded it"));
        assert_eq!(names(PredictionEnvironment::default(), &[]), Vec::<String>::new());
        let calm =
            PredictionEnvironment { wind_speed_m_s: Some(0.0), ..PredictionEnvironment::default() };
        assert_eq!(names(calm, &[]), Vec::<String>::new());
    }

    #[test]
    fn a_value_within_what_was_recorded_is_not_named() {
        let wind = |speed| PredictionEnvironment {
            wind_speed_m_s: Some(speed),
            ..PredictionEnvironment::default()
        };
        let recorded = [("wind_speed", [2.0, 8.0])];
        assert!(names(wind(8.05), &recorded).is_empty());
        assert!(names(wind(25.0), &recorded)[0].contains("the trials cover 2.0 to 8.0 m/s"));
        let depth = |depth| PredictionEnvironment {
            depth_m: Some(depth),
            ..PredictionEnvironment::default()
        };
        assert!(names(depth(40.0), &[("depth", [15.0, DEEP_M])]).is_empty());
        let shallow = names(depth(9.0), &[("depth", [15.0, DEEP_M])]);
        assert!(shallow[0].contains("the trials cover 15.0 m and deeper"), "{shallow:?}");
    }
}
