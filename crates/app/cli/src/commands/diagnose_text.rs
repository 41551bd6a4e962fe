//! Text output of a diagnosis.

use std::collections::BTreeMap;

use sistership_diagnosis::{
    ConfoundedEffect, Diagnosis, HypothesisReport, LimitedBy, MissingEffect, NextTrial,
    UnexplainedSegment, Verdict,
};
use sistership_model::Model;
use sistership_report::{change_words, dependence_sentence, distinct_hypotheses, origin_sentence};

use super::channels::TABLE_CHANNELS;
use super::describe_status;
use super::written_files::WrittenFiles;
use crate::table::{TextTable, format_number, format_optional};

/// Largest number of hypotheses that are listed.
const MAX_HYPOTHESES: usize = 8;

/// Formats a diagnosis as text.
pub fn format_diagnosis(diagnosis: &Diagnosis, model: &Model, files: &WrittenFiles<'_>) -> String {
    // From the verdict to the details: a reader may stop after any part.
    let mut parts = vec![format!(
        "{} ({})\n{}\n",
        diagnosis.diagnosed,
        describe_status(model.status),
        format_verdict(diagnosis)
    )];
    parts.extend(diagnosis.effects.iter().map(format_effect));
    if !diagnosis.unexplained.is_empty() {
        parts.push(format!("Unexplained segments\n{}", format_unexplained(&diagnosis.unexplained)));
        parts.extend(format_changes(diagnosis));
        parts.extend(origin_sentence(&diagnosis.origins).map(|said| said + "\n"));
        parts.extend(diagnosis.depends_on.iter().map(|left| dependence_sentence(left) + "\n"));
    }
    parts.extend(diagnosis.next_trial.as_ref().map(format_next_trial));
    parts.extend(format_limits(diagnosis));
    parts.push(format!("Root mean square errors: {}\n{}", diagnosis.how, format_errors(diagnosis)));
    parts.push(format!(
        "Most probable hypotheses (evidence: natural logarithm)\n{}",
        format_hypotheses(&diagnosis.hypotheses)
    ));
    parts.push(format_remarks(diagnosis, files));
    parts.join("\n")
}

/// Formats the verdict for a reader who knows nothing of the method.
fn format_verdict(diagnosis: &Diagnosis) -> String {
    let names: Vec<&str> = diagnosis.effects.iter().map(|effect| effect.name.as_str()).collect();
    match diagnosis.verdict {
        Verdict::Complete => {
            "COMPLETE: nothing is missing above the sizes that these trials would show".to_owned()
        }
        Verdict::Effects => format!("EFFECTS: the model lacks {}", names.join(" and ")),
        // Effects may be found and forces remain unexplained at the same time.
        Verdict::Unexplained if names.is_empty() => {
            "UNEXPLAINED: something is missing that no known effect explains".to_owned()
        }
        Verdict::Unexplained => {
            format!(
                "UNEXPLAINED: the model lacks {}, and something that no known effect explains",
                names.join(" and ")
            )
        }
    }
}

/// Formats an effect with its parameters, whose names carry their units, and with the effects from
/// which it can hardly be distinguished.
fn format_effect(found: &MissingEffect) -> String {
    let mut table = TextTable::new(["parameter", "value", "standard error"]);
    for (name, value) in &found.parameters {
        table.add_row([name.clone(), format_number(value.value), format_number(value.se)]);
    }
    let (name, form, meaning, evidence) =
        (&found.name, &found.form, &found.meaning, found.evidence);
    let head = format!(
        "{name} ({form}): {meaning}; evidence {evidence:.1} (above 5 is very strong)\n{table}"
    );
    let other = |other: &ConfoundedEffect| {
        format!(
            "{} (angle {:.1} deg, evidence lower by {:.1})",
            other.name, other.angle_deg, other.behind
        )
    };
    let others: Vec<String> = found.confounded_with.iter().map(other).collect();
    if others.is_empty() {
        head
    } else {
        format!("{head}  these trials hardly distinguish it from {}\n", others.join(", "))
    }
}

fn format_unexplained(stretches: &[UnexplainedSegment]) -> TextTable {
    let mut table = TextTable::new(["trial", "channel", "from s", "to s", "rms / noise"]);
    for stretch in stretches {
        let figures = [stretch.from_s, stretch.to_s, stretch.rms_over_noise].map(format_number);
        table.add_row([stretch.trial.clone(), stretch.channel.clone()].into_iter().chain(figures));
    }
    table
}

/// Formats the changes within trials (begin, end, drift); `None` if there are none.
fn format_changes(diagnosis: &Diagnosis) -> Option<String> {
    let lines: Vec<String> =
        diagnosis.changes.iter().map(|one| format!("  {}\n", change_words(one))).collect();
    let of_the_day = "specific to these trials, not added to the model";
    (!lines.is_empty()).then(|| format!("Changes within trials ({of_the_day})\n{}", lines.concat()))
}

fn format_next_trial(next: &NextTrial) -> String {
    let (speed, heading) = (format_number(next.speed_m_s), format_number(next.heading_deg));
    format!(
        "Recommended next trial: {} at {speed} m/s, heading {heading} deg; it distinguishes {}\n",
        next.manoeuvre,
        next.separates.join(" and ")
    )
}

/// Formats the detection limits of effects; `None` if there are none.
fn format_limits(diagnosis: &Diagnosis) -> Option<String> {
    let mut table = TextTable::new(["effect", "form", "parameter", "limit", "usual", "detectable"]);
    for limit in &diagnosis.limits {
        // The cause says what would lower the limit.
        let told = limit.limited_by.map_or("yes", |cause| match cause {
            LimitedBy::Model => "no: refine the model first",
            LimitedBy::Trials => "no: other trials are needed",
            LimitedBy::Sensors => "no: the instruments are too noisy",
        });
        let names = [&limit.effect, &limit.form, &limit.parameter].map(Clone::clone);
        let sizes = [format_optional(limit.size), format_number(limit.usual), told.to_owned()];
        table.add_row(names.into_iter().chain(sizes));
    }
    (!diagnosis.limits.is_empty()).then(|| {
        format!(
            "Detection limits: sizes that would be detected with 90 % \
                          probability\n{table}"
        )
    })
}

/// Formats the errors on held-out trials, before and after, also relative to the noise.
fn format_errors(diagnosis: &Diagnosis) -> TextTable {
    let mut table = TextTable::new([
        "channel",
        "unit",
        "before",
        "after",
        "change",
        "noise",
        "before / noise",
        "after / noise",
    ]);
    for (name, unit, factor) in TABLE_CHANNELS {
        let of =
            // `f64::MAX` marks the error of a simulation that left the physical range.
            |all: &BTreeMap<String, f64>| all.get(name).copied().filter(|value| *value != f64::MAX);
        let (before, after, noise) = (
            of(&diagnosis.before),
            of(&diagnosis.after),
            of(&diagnosis.noise).filter(|n| *n > 0.0),
        );
        // Neither simulation has an error of this channel.
        if before.is_none() && after.is_none() {
            continue;
        }
        let shown = |value: Option<f64>| format_optional(value.map(|value| value * factor));
        let over = |value: Option<f64>| {
            format_optional(value.zip(noise).map(|(value, noise)| value / noise))
        };
        let change = before.zip(after).filter(|(before, _)| *before > 0.0);
        let change = change.map_or("-".to_owned(), |(before, after)| {
            format!("{:+.0} %", 100.0 * (after / before - 1.0))
        });
        let figures =
            [shown(before), shown(after), change, shown(noise), over(before), over(after)];
        table.add_row([name.to_owned(), unit.to_owned()].into_iter().chain(figures));
    }
    table
}

fn format_hypotheses(hypotheses: &[HypothesisReport]) -> TextTable {
    let mut table = TextTable::new(["hypothesis", "evidence", "held-out", "selected"]);
    for hypothesis in distinct_hypotheses(hypotheses).into_iter().take(MAX_HYPOTHESES) {
        let name = if hypothesis.effects.is_empty() {
            "no effect".to_owned()
        } else {
            hypothesis.effects.join(" + ")
        };
        let refused = || hypothesis.refused.as_ref().map(|reason| format!("no: {reason}"));
        let selected =
            if hypothesis.taken { "yes".to_owned() } else { refused().unwrap_or_default() };
        table.add_row([
            name,
            format_number(hypothesis.evidence),
            format_optional(hypothesis.held_out),
            selected,
        ]);
    }
    table
}

fn format_remarks(diagnosis: &Diagnosis, files: &WrittenFiles<'_>) -> String {
    let mut lines: Vec<String> =
        diagnosis.remarks.iter().map(|remark| format!("remark: {remark}")).collect();
    lines.extend(match (files.out, &diagnosis.model) {
        (Some(path), _) => Some(format!("model with the effects written to {}", path.display())),
        (None, Some(_)) => {
            Some("model not written: give --out MODEL.yaml to keep it with the effects".to_owned())
        }
        (None, None) => None,
    });
    lines.extend(files.report.map(|path| format!("report written to {}", path.display())));
    lines.join("\n")
}
