//! The answer in one plain sentence.

use sistership_diagnose::{Diagnosis, Found, Verdict};

use super::parameter::ShownParameter;
use crate::numbers::{list, significant};

/// Most parameters that a sentence names.
const MOST: usize = 3;

/// What was found, for a stranger.
pub(crate) fn sentence(diagnosis: &Diagnosis) -> String {
    let lacks = list(&diagnosis.effects.iter().map(effect).collect::<Vec<_>>());
    match (diagnosis.verdict, diagnosis.effects.is_empty()) {
        (Verdict::Complete, _) => {
            "Your model holds: what remains between it and these trials is what the noise predicts."
                .into()
        }
        (Verdict::Unexplained, true) => {
            format!(
                "Something is missing from your model that no known effect explains{}.",
                where_(diagnosis)
            )
        }
        (Verdict::Unexplained, false) => {
            format!(
                "Your model lacks: {lacks}; and something that no known effect explains{}.",
                where_(diagnosis)
            )
        }
        (Verdict::Effects, _) => format!("Your model lacks: {lacks}."),
    }
}

/// An effect with what is known of it: `current (0.60 m/s towards 45 deg)`.
pub(crate) fn effect(found: &Found) -> String {
    let (name, figures) = (name(found), figures(found));
    if figures.is_empty() { name } else { format!("{name} ({figures})") }
}

/// What an effect is called: a missing term by the term.
fn name(found: &Found) -> String {
    let words = found.name.replace('-', " ");
    if found.form.starts_with(|first: char| first.is_ascii_uppercase()) {
        format!("{words} {}", found.form)
    } else {
        words
    }
}

fn figures(found: &Found) -> String {
    let of = |name: &str| found.parameters.get(name).map(|value| ShownParameter::of(name, value));
    for (direction, word) in [("towards_deg", "towards"), ("from_deg", "from")] {
        if let (Some(speed), Some(angle)) = (of("speed_m_s"), of(direction)) {
            return format!("{} {word} {}", short(&speed), compass(&angle));
        }
    }
    let all: Vec<ShownParameter> = ShownParameter::all(&found.parameters)
        .into_iter()
        .map(|(_, parameter)| parameter)
        .collect();
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

/// Where it is: the stretch that the diagnosis puts first.
fn where_(diagnosis: &Diagnosis) -> String {
    diagnosis.unexplained.first().map_or_else(String::new, |stretch| {
        let what = motion(&stretch.channel);
        format!(
            ", most of all in {what} of {} from {:.0} s to {:.0} s",
            stretch.trial, stretch.from_s, stretch.to_s
        )
    })
}

/// The motion whose equation a channel stands for.
pub(crate) fn motion(channel: &str) -> &str {
    match channel {
        "u" => "surge",
        "v" => "sway",
        "r" => "yaw",
        "p" => "roll",
        "psi" => "the heading",
        "x" => "the position north",
        "y" => "the position east",
        other => other,
    }
}
