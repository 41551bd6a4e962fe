//! Published free-running trials of a ship: the figures against which its models are validated.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Figures of free-running manoeuvres from one source, in calm and deep water. Lengths are in ship
/// lengths, so that they hold at every scale.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FreeRunning {
    /// Key of the source.
    pub source: String,
    /// Sea trial or model test.
    pub kind: FreeRunningKind,
    /// Approach speed at the scale of this file, m/s; default: that of the model.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed_m_s: Option<f64>,
    /// A remark.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
    /// Turning circles.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub turns: Vec<PublishedTurn>,
    /// Zigzags.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub zigzags: Vec<PublishedZigzag>,
}

/// Kind of a free-running trial.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FreeRunningKind {
    /// The ship itself, at sea.
    SeaTrial,
    /// A model of it, in a basin or on a lake.
    ModelTest,
}

impl FreeRunningKind {
    /// Name of the kind for readers.
    pub fn display_name(self) -> &'static str {
        match self {
            Self::SeaTrial => "sea trial",
            Self::ModelTest => "model test",
        }
    }
}

/// A turning circle; lengths in ship lengths, positive towards the side of the turn.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PublishedTurn {
    /// Rudder angle, deg, positive turns to starboard.
    pub rudder_deg: f64,
    /// The figures are the mean of both sides.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub both_sides: bool,
    /// Half the width of the interval in which each figure lies with 95 %, ship lengths.
    pub uncertainty: f64,
    /// Advance, ship lengths.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub advance: Option<f64>,
    /// Transfer, ship lengths.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub transfer: Option<f64>,
    /// Tactical diameter, ship lengths.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tactical_diameter: Option<f64>,
    /// Radius of the steady turn, ship lengths.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub steady_radius: Option<f64>,
}

/// A zigzag; angles in deg.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PublishedZigzag {
    /// Rudder angle, deg, positive if the first execution is to starboard.
    pub rudder_deg: f64,
    /// Change of heading at which the rudder is reversed, deg.
    pub switch_deg: f64,
    /// The figures are the mean of both sides.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub both_sides: bool,
    /// Half the width of the interval in which each figure lies with 95 %, deg.
    pub uncertainty_deg: f64,
    /// First overshoot angle, deg.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub first_overshoot_deg: Option<f64>,
    /// Second overshoot angle, deg.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub second_overshoot_deg: Option<f64>,
}

/// Largest rudder angle of a trial, deg.
const MAX_RUDDER_DEG: f64 = 90.0;
/// Largest plausible figure of a turn, ship lengths.
const MAX_LENGTHS: f64 = 50.0;

impl FreeRunning {
    /// Checks that its source is listed and that its figures are plausible.
    ///
    /// # Errors
    /// Returns the field at fault and its remedy.
    pub fn check_figures(&self, sources: &[&str]) -> Result<(), (String, String)> {
        let wrong = |field: &str, message: &str| Err((field.to_owned(), message.to_owned()));
        if !sources.contains(&self.source.as_str()) {
            let message = format!("`{}` is not listed under `sources`", self.source);
            return Err(("source".to_owned(), message));
        }
        if self.speed_m_s.is_some_and(|speed| !(speed > 0.0 && speed < 50.0)) {
            return wrong("speed_m_s", "must be above 0 and below 50 m/s");
        }
        if self.turns.is_empty() && self.zigzags.is_empty() {
            return wrong("turns", "give at least one turn or zigzag");
        }
        self.turns.iter().try_for_each(PublishedTurn::check_figures)?;
        self.zigzags.iter().try_for_each(PublishedZigzag::check_figures)
    }
}

fn check_angle(field: &str, angle: f64, most: f64) -> Result<(), (String, String)> {
    if angle != 0.0 && angle.abs() <= most {
        return Ok(());
    }
    Err((field.to_owned(), format!("{angle} should be an angle up to {most} deg, and not 0")))
}

fn check_range(field: &str, value: Option<f64>, most: f64) -> Result<(), (String, String)> {
    match value {
        Some(value) if !(-most..=most).contains(&value) => {
            Err((field.to_owned(), format!("{value} is outside -{most} to {most}")))
        }
        _ => Ok(()),
    }
}

fn check_uncertainty(field: &str, value: f64) -> Result<(), (String, String)> {
    if value > 0.0 && value.is_finite() {
        return Ok(());
    }
    Err((field.to_owned(), "must be above 0: no trial is exact".to_owned()))
}

impl PublishedTurn {
    /// Figures by name, ship lengths.
    pub fn named_figures(&self) -> [(&'static str, Option<f64>); 4] {
        [
            ("advance", self.advance),
            ("transfer", self.transfer),
            ("tactical diameter", self.tactical_diameter),
            ("steady radius", self.steady_radius),
        ]
    }

    fn check_figures(&self) -> Result<(), (String, String)> {
        check_angle("turns.rudder_deg", self.rudder_deg, MAX_RUDDER_DEG)?;
        check_uncertainty("turns.uncertainty", self.uncertainty)?;
        let range = |(name, value): (&str, _)| {
            check_range(&format!("turns.{}", name.replace(' ', "_")), value, MAX_LENGTHS)
        };
        self.named_figures().into_iter().try_for_each(range)
    }
}

impl PublishedZigzag {
    /// Figures by name, deg.
    pub fn named_figures(&self) -> [(&'static str, Option<f64>); 2] {
        [
            ("first overshoot", self.first_overshoot_deg),
            ("second overshoot", self.second_overshoot_deg),
        ]
    }

    fn check_figures(&self) -> Result<(), (String, String)> {
        check_angle("zigzags.rudder_deg", self.rudder_deg, MAX_RUDDER_DEG)?;
        check_angle("zigzags.switch_deg", self.switch_deg, MAX_RUDDER_DEG)?;
        check_uncertainty("zigzags.uncertainty_deg", self.uncertainty_deg)?;
        let range = |(name, value): (&str, _)| {
            check_range(&format!("zigzags.{}_deg", name.replace(' ', "_")), value, 180.0)
        };
        self.named_figures().into_iter().try_for_each(range)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn trial(text: &str) -> FreeRunning {
        crate::yaml::read_document(text).unwrap()
    }

    #[test]
    fn figures_that_cannot_be_are_refused_by_field() {
        let good = "source: a\nkind: sea_trial\nturns: [{ rudder_deg: -35.0, uncertainty: 0.1, \
            advance: 3.1 }]\n";
        assert_eq!(trial(good).check_figures(&["a"]), Ok(()));
        let refused = |from: &str, to: &str| trial(&good.replace(from, to)).check_figures(&["a"]);
        assert_eq!(refused("source: a", "source: b").unwrap_err().0, "source");
        assert_eq!(refused("-35.0", "0.0").unwrap_err().0, "turns.rudder_deg");
        assert_eq!(refused("0.1", "0.0").unwrap_err().0, "turns.uncertainty");
        assert_eq!(refused("3.1", "310.0").unwrap_err().0, "turns.advance");
        assert_eq!(
            trial("source: a\nkind: model_test\n").check_figures(&["a"]).unwrap_err().0,
            "turns"
        );
    }
}
