//! Result of the diagnosis in one plain sentence.

use sistership_diagnosis::{Diagnosis, MissingEffect, OriginKind, RemainderOrigin, Verdict};

use super::changes::change_words;
use super::figures::with_figures;
use crate::numbers::join_words;

/// Result of the diagnosis, as a sentence for readers without further knowledge of it.
pub(crate) fn result_sentence(diagnosis: &Diagnosis) -> String {
    let lacks = join_words(&diagnosis.effects.iter().map(effect_text).collect::<Vec<_>>());
    match (diagnosis.verdict, diagnosis.effects.is_empty()) {
        (Verdict::Complete, _) => {
            "Your model holds: what remains between it and these trials is what the noise predicts."
                .into()
        }
        (Verdict::Unexplained, true) => {
            format!(
                "Something is missing from your model that no known effect explains{}.",
                remainder_place(diagnosis)
            )
        }
        (Verdict::Unexplained, false) => {
            format!(
                "Your model lacks: {lacks}; and something that no known effect explains{}.",
                remainder_place(diagnosis)
            )
        }
        (Verdict::Effects, _) => format!("Your model lacks: {lacks}."),
    }
}

/// Effect with its figures: `current (0.60 m/s towards 45 deg)`.
pub(crate) fn effect_text(found: &MissingEffect) -> String {
    with_figures(effect_name(found), &found.parameters)
}

/// Name of an effect; a missing term is named by the term.
fn effect_name(found: &MissingEffect) -> String {
    let words = found.name.replace('-', " ");
    // A form that starts with a capital letter is the name of a coefficient.
    if found.form.starts_with(|first: char| first.is_ascii_uppercase()) {
        format!("{words} {}", found.form)
    } else {
        words
    }
}

/// Place of the remainder: the change that explains it, or the first unexplained segment.
fn remainder_place(diagnosis: &Diagnosis) -> String {
    // A change in time takes precedence over an unexplained segment.
    if let Some(first) = diagnosis.changes.first() {
        return format!(" throughout: {}", change_words(first));
    }
    diagnosis.unexplained.first().map_or_else(String::new, |stretch| {
        let of_stretch = || motion_word(&stretch.channel).to_owned();
        let what = diagnosis.origins.first().map_or_else(of_stretch, origin_words);
        format!(
            ", most of all in {what} of {} from {:.0} s to {:.0} s",
            stretch.trial, stretch.from_s, stretch.to_s
        )
    })
}

/// Origin of the remainder in words.
pub(super) fn origin_words(origin: &RemainderOrigin) -> String {
    let motion = motion_word(&origin.channel);
    match origin.of {
        OriginKind::Acceleration => motion.to_owned(),
        OriginKind::Readings => format!("the readings of {motion}"),
    }
}

/// Motion of the equation of a channel.
pub(crate) fn motion_word(channel: &str) -> &str {
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
