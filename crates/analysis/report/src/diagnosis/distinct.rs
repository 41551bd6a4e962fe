//! Hypotheses for readers: each set of effects once.

use std::collections::BTreeSet;

use sistership_diagnosis::HypothesisReport;

/// Returns each set of effects once, in the given order. A set that was evaluated several times is
/// kept where it was selected, or else at its first place, the most probable.
pub fn distinct_hypotheses(all: &[HypothesisReport]) -> Vec<&HypothesisReport> {
    let taken: Vec<Vec<&str>> =
        all.iter().filter(|hypothesis| hypothesis.taken).map(sorted_effects).collect();
    let mut seen = BTreeSet::new();
    let kept = all.iter().filter(|hypothesis| {
        let effects = sorted_effects(hypothesis);
        // A set that was selected is shown only as the selected hypothesis.
        (hypothesis.taken || !taken.contains(&effects)) && seen.insert(effects)
    });
    kept.collect()
}

/// Names of the effects in alphabetical order, so that sets compare equal.
fn sorted_effects(hypothesis: &HypothesisReport) -> Vec<&str> {
    let mut effects: Vec<&str> = hypothesis.effects.iter().map(String::as_str).collect();
    effects.sort_unstable();
    effects
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_taken_stands_for_its_repetitions() {
        let hypothesis = |effects: &[&str], evidence: f64, taken: bool| HypothesisReport {
            effects: effects.iter().map(|&effect| effect.to_owned()).collect(),
            evidence,
            held_out: None,
            parameters: Default::default(),
            taken,
            refused: None,
        };
        let all = [
            hypothesis(&["a", "b"], 9.0, false),
            hypothesis(&["b", "a"], 8.0, true),
            hypothesis(&["c"], 7.0, false),
            hypothesis(&["c"], 6.0, false),
        ];
        let kept: Vec<f64> =
            distinct_hypotheses(&all).into_iter().map(|hypothesis| hypothesis.evidence).collect();
        assert_eq!(kept, [8.0, 7.0]);
    }
}
