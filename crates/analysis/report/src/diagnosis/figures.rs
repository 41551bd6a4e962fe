//! The figures of an effect as a sentence has them.

use std::collections::BTreeMap;

use sistership_diagnosis::Value;

use super::parameter::ShownParameter;
use crate::numbers::{list, significant};

/// Most parameters that a sentence names.
const MOST: usize = 3;

/// A name with what is known of it in brackets.
pub(super) fn with_figures(name: String, parameters: &BTreeMap<String, Value>) -> String {
    let figures = figures(parameters);
    if figures.is_empty() { name } else { format!("{name} ({figures})") }
}

fn figures(parameters: &BTreeMap<String, Value>) -> String {
    let of = |name: &str| parameters.get(name).map(|value| ShownParameter::of(name, value));
    for (direction, word) in [("towards_deg", "towards"), ("from_deg", "from")] {
        if let (Some(speed), Some(angle)) = (of("speed_m_s"), of(direction)) {
            return format!("{} {word} {}", short(&speed), compass(&angle));
        }
    }
    let all: Vec<ShownParameter> =
        ShownParameter::all(parameters).into_iter().map(|(_, parameter)| parameter).collect();
    let with_unit: Vec<&ShownParameter> =
        all.iter().filter(|parameter| !parameter.unit.is_empty()).collect();
    let shown = if with_unit.is_empty() { all.iter().collect() } else { with_unit };
    match shown.as_slice() {
        [only] => short(only),
        several if several.len() > MOST => String::new(),
        several => list(
            &several
                .iter()
                .map(|parameter| format!("{} {}", parameter.words, short(parameter)))
                .collect::<Vec<_>>(),
        ),
    }
}

/// Three digits and the unit: the standard error stands in the table.
fn short(parameter: &ShownParameter) -> String {
    format!("{} {}", significant(parameter.value, 2), parameter.unit).trim_end().to_owned()
}

fn compass(angle: &ShownParameter) -> String {
    format!("{:.0} deg", angle.value.rem_euclid(360.0))
}
