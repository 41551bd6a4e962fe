//! Changes within a trial, in words.

use sistership_diagnosis::{ChangeCourse, EffectChange};

use super::figures::with_figures;
use crate::numbers::join_words;

/// Returns one sentence per change.
pub(crate) fn change_sentences(all: &[EffectChange]) -> Vec<String> {
    all.iter().map(change_sentence).collect()
}

/// Sentence of a change, with the effects that are nearly as probable.
fn change_sentence(of: &EffectChange) -> String {
    let first = change_words(of);
    let or: Vec<String> = of.or.iter().map(|name| name.replace('-', " ")).collect();
    // The sentence starts with a capital letter, the phrase does not.
    let capital = first.chars().take(1).flat_map(char::to_uppercase);
    let first: String = capital.chain(first.chars().skip(1)).collect();
    match or.is_empty() {
        true => format!("{first}."),
        false => format!("{first}; nearly as probable is {}.", join_words(&or)),
    }
}

/// Returns a change in words: `in turn.csv a rudder damage (share lost 35 %) begins at 412 s`.
pub fn change_words(of: &EffectChange) -> String {
    let name = with_figures(of.effect.replace('-', " "), &of.parameters);
    let time = |t_s: Option<f64>| t_s.map_or_else(String::new, |t_s| format!(" at {t_s:.0} s"));
    // Interval of the time, if the change is located less sharply.
    let between = of.between_s.map_or_else(String::new, |[first, last]| {
        format!(" (between {first:.0} s and {last:.0} s)")
    });
    let course = match of.course {
        ChangeCourse::Begins => format!("begins{}{between}", time(of.at_s)),
        ChangeCourse::Ends => format!("ends{}{between}", time(of.at_s)),
        ChangeCourse::Drifts => "grows throughout the trial".to_owned(),
        ChangeCourse::Throughout => "acts throughout, but not in all other trials".to_owned(),
    };
    format!("in {} {name} {course}", of.trial)
}

#[cfg(test)]
mod tests {
    use super::*;
    use sistership_diagnosis::ValueWithError;

    fn damage(course: ChangeCourse) -> EffectChange {
        let lost = ValueWithError { value: 35.0, se: 2.0 };
        EffectChange {
            effect: "rudder-damage".into(),
            form: "share-lost".into(),
            meaning: String::new(),
            trial: "turn.csv".into(),
            course,
            at_s: Some(412.0),
            between_s: Some([405.0, 420.0]),
            parameters: [("share_lost_percent".to_owned(), lost)].into(),
            evidence: 80.0,
            or: vec!["rudder-offset".into()],
        }
    }

    #[test]
    fn a_change_is_told_with_its_time() {
        let told = change_sentences(&[damage(ChangeCourse::Begins)]).remove(0);
        assert_eq!(
            told,
            "In turn.csv rudder damage (35 %) begins at 412 s (between 405 s and 420 s); nearly as \
             probable is rudder offset."
        );
    }

    #[test]
    fn what_has_no_time_is_told_without() {
        let told =
            change_words(&EffectChange { or: Vec::new(), ..damage(ChangeCourse::Throughout) });
        assert!(told.ends_with("acts throughout, but not in all other trials"), "{told}");
    }
}
