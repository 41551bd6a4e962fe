//! The next step for a ship: what its condition, trials and versions call for.

use sistership_jobs::condition::{Condition, ModelValidity};

use super::versions::VersionRow;
use crate::language::{Message, say};
use crate::rows::JobRow;

/// What a step follows from.
pub(super) struct ShipSituation<'a> {
    pub name: &'a str,
    pub condition: &'a Condition,
    /// Newest jobs.
    pub jobs: &'a [JobRow],
    /// Versions, the newest first.
    pub versions: &'a [VersionRow],
    pub has_trials: bool,
}

/// Next step: explanation, and what its button does.
pub(super) struct NextStep {
    pub text: Message,
    pub button: Message,
    pub action: StepAction,
}

/// Action of the button of a step.
pub(super) enum StepAction {
    /// Leads to an address.
    Open(String),
    /// Queues a refinement with default settings.
    Refine,
    /// Queues a diagnosis of a version.
    Diagnose(i64),
}

impl NextStep {
    /// Returns the step for a ship.
    pub fn for_ship(of: &ShipSituation<'_>) -> Self {
        Self::pending_work(of).unwrap_or_else(|| Self::condition_step(of))
    }

    /// Work that goes on or is still to do, before the model in use can be judged.
    fn pending_work(of: &ShipSituation<'_>) -> Option<Self> {
        let name = of.name;
        let waits = |state: &str| ["running", "queued"].contains(&state);
        if let Some(job) = of.jobs.iter().find(|job| waits(job.state)) {
            let text =
                say("next-job-runs").with("kind", job.kind_words()).with("percent", job.percent);
            return Some(Self::open_place(
                text,
                say("next-see-progress"),
                format!("/jobs/{}", job.id),
            ));
        }
        if !of.has_trials {
            let place = format!("/ships/{name}/upload");
            return Some(Self::open_place(say("next-no-trials"), say("next-upload"), place));
        }
        let refined = of.versions.iter().any(|version| !version.method.starts_with("published"));
        (!refined).then(|| Self {
            text: say("next-not-refined"),
            button: say("next-refine"),
            action: StepAction::Refine,
        })
    }

    fn condition_step(of: &ShipSituation<'_>) -> Self {
        let name = of.name;
        let at = |number: i64| format!("/ships/{name}/versions/{number}");
        let newest = of.versions.first().map(|version| version.number);
        let (condition, champion) = (of.condition, of.condition.version);
        match (condition.model, &condition.with_effects, champion) {
            // A model that does not hold comes before everything else.
            (ModelValidity::DoesNotHold, Some(made), _) => Self::open_place(
                say("next-has-effects").with("number", made.number),
                say("next-look-at-version").with("number", made.number),
                at(made.number),
            ),
            (_, _, None) => Self::open_place(
                say("next-none-in-use"),
                say("next-look-at-newest"),
                at(newest.unwrap_or(1)),
            ),
            (_, _, Some(champion)) if newest.is_some_and(|newest| newest > champion) => {
                Self::open_place(
                    say("next-newer").with("number", champion),
                    say("next-compare"),
                    format!("/compare?v={name}/{champion}&v={name}/{}", newest.unwrap_or(champion)),
                )
            }
            // Trials may be there that the champion has not seen.
            (ModelValidity::Unknown, _, Some(champion)) => Self {
                text: say("next-not-diagnosed").with("number", champion),
                button: say("next-diagnose"),
                action: StepAction::Diagnose(champion),
            },
            (_, _, Some(champion)) => Self::report_step(of, champion),
        }
    }

    fn report_step(of: &ShipSituation<'_>, champion: i64) -> Self {
        // The report may have been removed, or never made.
        let own = of.versions.iter().find(|version| version.number == champion);
        match own.and_then(|version| version.report.as_ref()) {
            Some(report) => Self::open_place(
                say("next-has-report").with("number", champion),
                say("next-look-at-report"),
                format!("/v1/reports/{report}?format=html"),
            ),
            None => Self::open_place(
                say("next-in-use").with("number", champion),
                say("next-look-at-it"),
                format!("/ships/{}/versions/{champion}", of.name),
            ),
        }
    }

    fn open_place(text: Message, button: Message, place: String) -> Self {
        Self { text, button, action: StepAction::Open(place) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn step(condition: &Condition, has_trials: bool) -> NextStep {
        let (jobs, versions) = (&[], &[]);
        NextStep::for_ship(&ShipSituation { name: "own", condition, jobs, versions, has_trials })
    }

    #[test]
    fn trials_come_before_refinement_and_this_before_a_diagnosis() {
        let condition = Condition::default();
        let first = step(&condition, false);
        assert!(matches!(first.action, StepAction::Open(place) if place == "/ships/own/upload"));
        assert!(matches!(step(&condition, true).action, StepAction::Refine));
    }
}
