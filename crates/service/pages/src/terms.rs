//! Terms of naval architecture in the language of a page, by their names in data.

use sistership_jobs::condition::{Condition, ModelValidity, RecentDrift};
use sistership_report::{field_words, imo_verdict};

use crate::language::{Message, has_word, say, say_word};
use crate::numbers::format_fixed;

/// Returns the words for a particular such as `rudder_area_m2`, and its unit; empty without one.
pub(crate) fn particular_words(name: &str) -> (String, &'static str) {
    let (plain, unit) = field_words(name);
    let unit = if unit == "–" { "" } else { unit };
    match has_word("particular", name) {
        true => (say_word("particular", name), unit),
        // Particulars of files may have any name.
        false => (capitalize(&plain), unit),
    }
}

/// Returns words with a capital first letter; the others stay, as German nouns have capitals too.
pub(crate) fn capitalize(words: impl AsRef<str>) -> String {
    let words = words.as_ref();
    let (first, rest) = words.split_at(words.chars().next().map_or(0, char::len_utf8));
    first.to_uppercase() + rest
}

/// Returns the words for a figure such as `turn 35 deg: advance`.
pub(crate) fn figure_words(name: &str) -> String {
    let Some((manoeuvre, figure)) = name.split_once(": ") else { return say_word("figure", name) };
    let figure = say_word("figure", figure);
    match manoeuvre.split_once(' ') {
        Some(("turn", rudder)) => {
            let rudder = rudder.trim_end_matches(" deg");
            say("figure-of-turn").with("rudder", rudder).with("figure", figure).into()
        }
        Some(("zigzag", angles)) => {
            say("figure-of-zigzag").with("angles", angles).with("figure", figure).into()
        }
        _ => name.to_owned(),
    }
}

/// Returns the verdict on all criteria of IMO MSC.137(76) in a sentence, and its class; `imo` has
/// name and verdict of each criterion.
pub(crate) fn imo_words(imo: &[(&str, Option<bool>)]) -> (String, &'static str) {
    let (_, class) = imo_verdict(imo);
    let named = |pass: Option<bool>| {
        let own = imo.iter().filter(|(_, known)| *known == pass);
        own.map(|(name, _)| say_word("criterion", name)).collect::<Vec<_>>()
    };
    let (failed, unknown) = (named(Some(false)), named(None));
    let sentence = match (imo.is_empty(), failed.is_empty(), unknown.is_empty()) {
        (true, ..) => say("imo-not-evaluated"),
        (_, false, _) => say("imo-fails").with("criteria", join_words(&failed)),
        (_, _, false) => say("imo-partly").with("criteria", join_words(&unknown)),
        _ => say("imo-meets"),
    };
    (sentence.into(), class)
}

/// Returns a list of words as in `a, b and c`.
pub(crate) fn join_words(words: &[String]) -> String {
    match words {
        [] => String::new(),
        [one] => one.clone(),
        [first @ .., last] => {
            say("list-and").with("first", first.join(", ")).with("last", last).into()
        }
    }
}

/// Returns the condition of a ship in one sentence, as [`Condition::sentence`] has it in English.
pub(crate) fn condition_sentence(condition: &Condition) -> String {
    let since = condition.since.as_ref().filter(|since| !since.name.is_empty());
    let sentence = match (condition.model, since) {
        (ModelValidity::Unknown, _) if condition.version.is_none() => say("condition-no-champion"),
        (ModelValidity::Unknown, _) => say("condition-not-diagnosed"),
        (ModelValidity::Holds, _) => {
            say("condition-holds").with("trials", count_trials(condition.trials.len()))
        }
        (ModelValidity::DoesNotHold, Some(since)) => {
            say("condition-fails-since").with("since", &since.name)
        }
        (ModelValidity::DoesNotHold, None) => say("condition-fails"),
    };
    match condition.model {
        ModelValidity::DoesNotHold => {
            sentence.with("evidence", describe_evidence(condition)).into()
        }
        _ => sentence.into(),
    }
}

/// Describes the evidence against a model.
fn describe_evidence(of: &Condition) -> String {
    let (against, all) = (of.against.len(), count_trials(of.trials.len()));
    let trials = match against == of.trials.len() {
        true => all,
        false => say("condition-some-trials").with("against", against).with("all", all),
    };
    let effects = join_words(&of.effects);
    let found = match (effects.is_empty(), of.verdict.as_deref()) {
        // No diagnosis contradicts the model; the drift is described below.
        (_, Some("drift")) => None,
        (true, _) => Some(say("condition-unexplained").with("trials", trials)),
        (false, Some("effects")) => Some(say("condition-lacks").with("trials", trials)),
        (false, _) => Some(say("condition-lacks-more").with("trials", trials)),
    };
    let found = found.map(|found| found.with("effects", effects).to_string());
    let drift = of.drift.as_ref().filter(|drift| drift.is_above_limit()).map(drift_words);
    found.into_iter().chain(drift).collect::<Vec<_>>().join("; ")
}

fn drift_words(drift: &RecentDrift) -> String {
    let ratio = format_fixed(drift.ratio, 1);
    say("condition-drifted").with("ratio", ratio).with("axis", &drift.axis).into()
}

fn count_trials(count: usize) -> Message {
    say("condition-count-trials").with("count", count)
}

#[cfg(test)]
#[allow(clippy::field_reassign_with_default, reason = "a field of conditions is private")]
mod tests {
    use super::*;
    use crate::language::Language;

    #[test]
    fn the_verdict_of_imo_is_that_of_reports() {
        let all = [
            ("advance", Some(true)),
            ("tactical diameter", None),
            ("10/10 first overshoot", Some(false)),
        ];
        for imo in [&all[..0], &all[..1], &all[..2], &all[..]] {
            assert_eq!(imo_words(imo), imo_verdict(imo));
        }
        let german = Language::German.run_blocking(|| imo_words(&all).0);
        assert!(german.contains("erster Überschwingwinkel 10/10"), "{german}");
    }

    #[test]
    fn figures_and_particulars_have_terms() {
        let of = |language: Language, name| language.run_blocking(|| figure_words(name));
        assert_eq!(of(Language::English, "turn 35 deg: advance"), "turn 35 deg: advance");
        assert_eq!(
            of(Language::Norwegian, "turn -35 deg: tactical diameter"),
            "svingesirkel -35°: taktisk diameter"
        );
        assert_eq!(of(Language::German, "zigzag 20/20: period"), "Z-Manöver 20/20: Periode");
        let lpp = Language::German.run_blocking(|| particular_words("lpp_m"));
        assert_eq!(lpp, ("Länge zwischen den Loten".to_owned(), "m"));
        assert_eq!(particular_words("skeg_area_m2"), ("Skeg area".to_owned(), "m²"));
    }

    #[test]
    fn a_condition_reads_as_in_the_rest_interface() {
        let mut condition = Condition::default();
        condition.version = Some(2);
        condition.model = ModelValidity::DoesNotHold;
        condition.trials = ["a", "b", "c"].map(str::to_owned).to_vec();
        condition.against = condition.trials[..2].to_vec();
        condition.effects = vec!["wind".to_owned(), "current".to_owned()];
        condition.verdict = Some("effects".to_owned());
        let expected = "Its model does not hold: on 2 of 3 trials it lacks wind and current.";
        assert_eq!(condition_sentence(&condition), expected);
        let german = Language::German.run_blocking(|| condition_sentence(&condition));
        assert_eq!(german, "Das Modell gilt nicht: auf 2 von 3 Versuchen fehlt wind und current.");
    }
}
