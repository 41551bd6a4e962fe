//! Description of the condition of a ship in one sentence.

use super::{Condition, ModelValidity};

impl Condition {
    pub(super) fn describe(&self) -> String {
        match self.model {
            ModelValidity::Unknown => {
                "Unknown: its champion has not been diagnosed on a trial yet.".into()
            }
            ModelValidity::Holds => format!(
                "Its model holds: on {} the residual agrees with the noise.",
                count_trials(self.trials.len())
            ),
            ModelValidity::DoesNotHold => {
                format!(
                    "Its model does not hold{}: {}.",
                    self.describe_since(),
                    self.describe_evidence()
                )
            }
        }
    }

    fn describe_since(&self) -> String {
        let named = self.since.as_ref().filter(|since| !since.name.is_empty());
        named.map_or_else(String::new, |since| format!(" since the trial {}", since.name))
    }

    /// Describes the evidence against the model.
    fn describe_evidence(&self) -> String {
        let (against, all) = (self.against.len(), count_trials(self.trials.len()));
        // "on 3 trials" if all of them contradict the model, else "on 2 of 3 trials".
        let on = if against == self.trials.len() { all } else { format!("{against} of {all}") };
        let effects = self.effects.join(" and ");
        let found = match (effects.is_empty(), self.verdict.as_deref()) {
            // No diagnosis contradicts the model; the drift is described below.
            (_, Some("drift")) => None,
            (true, _) => {
                Some(format!("on {on} something is missing that no known effect explains"))
            }
            (false, Some("effects")) => Some(format!("on {on} it lacks {effects}")),
            (false, _) => Some(format!(
                "on {on} it lacks {effects}, and something that no known effect explains"
            )),
        };
        let drift = self.drift.as_ref().filter(|drift| drift.is_above_limit()).map(|drift| {
            format!(
                "the unexplained force on new trials is {:.1} times that on the fitted trials \
                 (axis {})",
                drift.ratio, drift.axis
            )
        });
        found.into_iter().chain(drift).collect::<Vec<_>>().join("; ")
    }
}

fn count_trials(count: usize) -> String {
    match count {
        1 => "1 trial".to_owned(),
        count => format!("{count} trials"),
    }
}
