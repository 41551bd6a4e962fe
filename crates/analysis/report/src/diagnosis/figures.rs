//! Figures of an effect in a sentence.

use std::collections::BTreeMap;

use sistership_diagnosis::Value;

use super::parameter::ShownParameter;
use crate::numbers::{list, significant};

/// Largest number of parameters in a sentence.
const MOST: usize = 3;

/// Name followed by its figures in brackets.
pub(super) fn with_figures(name: String, parameters: &BTreeMap<String, Value>) -> String {
    let figures = figures(parameters);
    if figures.is_empty() { name } else { format!("{name} ({figures})") }
}

/// Figures as words: a speed with its direction, or the parameters that have units.
fn figures(parameters: &BTreeMap<String, Value>) -> String {
    let of = |name: &str| parameters.get(name).map(|value| ShownParameter::of(name, value));
    // A velocity is stated as speed and direction.
    for (direction, word) in [("towards_deg", "towards"), ("from_deg", "from")] {
        if let (Some(speed), Some(angle)) = (of("speed_m_s"), of(direction)) {
            return format!("{} {word} {}", short(&speed), compass(&angle));
        }
    }
    let all: Vec<ShownParameter> =
        ShownParameter::all(parameters).into_iter().map(|(_, parameter)| parameter).collect();
    let with_unit: Vec<&ShownParameter> =
        all.iter().filter(|parameter| !parameter.unit.is_empty()).collect();
    // Parameters without unit are only named if there is no other.
    let shown = if with_unit.is_empty() { all.iter().collect() } else { with_unit };
    match shown.as_slice() {
        [only] => short(only),
        // Too many figures for a sentence: they are in the table.
        several if several.len() > MOST => String::new(),
        several => list(
            &several
                .iter()
                .map(|parameter| format!("{} {}", parameter.words, short(parameter)))
                .collect::<Vec<_>>(),
        ),
    }
}

/// Value with two digits and unit: the standard error is in the table.
fn short(parameter: &ShownParameter) -> String {
    format!("{} {}", significant(parameter.value, 2), parameter.unit).trim_end().to_owned()
}

/// Direction from 0 to 360 degrees.
fn compass(angle: &ShownParameter) -> String {
    format!("{:.0} deg", angle.value.rem_euclid(360.0))
}
