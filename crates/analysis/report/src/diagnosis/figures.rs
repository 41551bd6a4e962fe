//! Figures of an effect in a sentence.

use std::collections::BTreeMap;

use sistership_diagnosis::ValueWithError;

use super::parameter::DisplayParameter;
use crate::numbers::{format_significant, join_words};

/// Largest number of parameters in a sentence.
const MOST: usize = 3;

/// Name followed by its figures in brackets.
pub(super) fn with_figures(name: String, parameters: &BTreeMap<String, ValueWithError>) -> String {
    let figures = figures_text(parameters);
    if figures.is_empty() { name } else { format!("{name} ({figures})") }
}

/// Figures as words: a speed with its direction, or the parameters that have units.
fn figures_text(parameters: &BTreeMap<String, ValueWithError>) -> String {
    let of =
        |name: &str| parameters.get(name).map(|value| DisplayParameter::from_value(name, value));
    // A velocity is stated as speed and direction.
    for (direction, word) in [("towards_deg", "towards"), ("from_deg", "from")] {
        if let (Some(speed), Some(angle)) = (of("speed_m_s"), of(direction)) {
            return format!("{} {word} {}", short_value(&speed), compass_angle(&angle));
        }
    }
    let all: Vec<DisplayParameter> = DisplayParameter::from_values(parameters)
        .into_iter()
        .map(|(_, parameter)| parameter)
        .collect();
    let with_unit: Vec<&DisplayParameter> =
        all.iter().filter(|parameter| !parameter.unit.is_empty()).collect();
    // Parameters without unit are only named if there is no other.
    let shown = if with_unit.is_empty() { all.iter().collect() } else { with_unit };
    match shown.as_slice() {
        [only] => short_value(only),
        // Too many figures for a sentence: they are in the table.
        several if several.len() > MOST => String::new(),
        several => join_words(
            &several
                .iter()
                .map(|parameter| format!("{} {}", parameter.words, short_value(parameter)))
                .collect::<Vec<_>>(),
        ),
    }
}

/// Value with two digits and unit: the standard error is in the table.
fn short_value(parameter: &DisplayParameter) -> String {
    format!("{} {}", format_significant(parameter.value, 2), parameter.unit).trim_end().to_owned()
}

/// Direction from 0 to 360 degrees.
fn compass_angle(angle: &DisplayParameter) -> String {
    format!("{:.0} deg", angle.value.rem_euclid(360.0))
}
