//! Summary of the diagnosis in three sentences for an officer: the result, the recommended action,
//! and the effects that these trials could not show.

use sistership_diagnosis::{Diagnosis, LimitedBy, OriginKind, Verdict};

use super::evidence::next_trial_instruction;
use super::sentence::result_sentence;
use crate::numbers::join_words;

/// Returns the three sentences, in this order.
pub(crate) fn summary_sentences(diagnosis: &Diagnosis) -> [String; 3] {
    [result_sentence(diagnosis), advice_sentence(diagnosis), limits_sentence(diagnosis)]
}

fn advice_sentence(diagnosis: &Diagnosis) -> String {
    match (&diagnosis.next_trial, diagnosis.verdict) {
        (Some(next), _) => next_trial_instruction(next),
        // If the remainder is in the readings, the model is not to blame.
        (None, Verdict::Unexplained) if is_of_readings(diagnosis) => {
            "Look at the instrument that says so before the model is changed.".into()
        }
        (None, Verdict::Unexplained) => {
            "Look into the log of that trial for what happened then, before the model is changed."
                .into()
        }
        (None, Verdict::Effects) if diagnosis.model.is_some() => {
            "Use the model with what was found: it simulates trials better that its fit had not \
             seen."
                .into()
        }
        (None, Verdict::Effects) => {
            "Look at ship and instruments for what was found; the model stays as it is.".into()
        }
        (None, Verdict::Complete) => "Go on using the model as it is.".into(),
    }
}

fn is_of_readings(diagnosis: &Diagnosis) -> bool {
    diagnosis.origins.first().is_some_and(|origin| origin.of == OriginKind::Readings)
}

fn limits_sentence(diagnosis: &Diagnosis) -> String {
    let of = |cause: LimitedBy| {
        let names = diagnosis.cannot_tell.iter().filter(|(_, own)| **own == cause);
        names.map(|(name, _)| name.replace('-', " ")).collect::<Vec<_>>()
    };
    let parts = [
        (LimitedBy::Model, "until the model is refined further"),
        (LimitedBy::Trials, "because these trials do not excite it by itself"),
        (LimitedBy::Sensors, "because the instruments scatter too much"),
    ];
    let part = |(cause, why): (LimitedBy, &str)| {
        let names = of(cause);
        (!names.is_empty()).then(|| format!("{} ({why})", join_words(&names)))
    };
    let parts: Vec<String> = parts.into_iter().filter_map(part).collect();
    match parts.is_empty() {
        true => "Every other effect of a usual size would have been shown.".into(),
        false => format!("These trials cannot tell: {}.", parts.join("; ")),
    }
}
