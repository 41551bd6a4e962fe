//! The next step for a ship: what its condition, trials and versions call for.

use sistership_jobs::condition::{Condition, ModelValidity};

use super::versions::VersionRow;
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
    pub text: String,
    pub button: String,
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
            let text = format!("A {} of this ship is under way: {} %.", job.kind, job.percent);
            return Some(Self::open_place(text, "See its progress", format!("/jobs/{}", job.id)));
        }
        if !of.has_trials {
            let text = "The ship has no trials yet. Turning circles and zigzags tell most.";
            let place = format!("/ships/{name}/upload");
            return Some(Self::open_place(text.to_owned(), "Upload trials", place));
        }
        let refined = of.versions.iter().any(|version| !version.method.starts_with("published"));
        (!refined).then(|| Self {
            text: "The ship has trials, and no model that is fitted to them.".to_owned(),
            button: "Refine its model".to_owned(),
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
                format!("Version {} has the missing effects.", made.number),
                &format!("Look at version {}", made.number),
                at(made.number),
            ),
            (_, _, None) => Self::open_place(
                "No version is in use yet.".to_owned(),
                "Look at the newest version",
                at(newest.unwrap_or(1)),
            ),
            (_, _, Some(champion)) if newest.is_some_and(|newest| newest > champion) => {
                Self::open_place(
                    format!("Version {champion} is in use, and there is a newer one."),
                    "Compare them",
                    format!("/compare?v={name}/{champion}&v={name}/{}", newest.unwrap_or(champion)),
                )
            }
            // Trials may be there that the champion has not seen.
            (ModelValidity::Unknown, _, Some(champion)) => Self {
                text: format!("Version {champion} was not diagnosed since it came into use."),
                button: "Diagnose it".to_owned(),
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
                format!("Version {champion} is in use. Its report has the verdict on it."),
                "Look at the report",
                format!("/v1/reports/{report}?format=html"),
            ),
            None => Self::open_place(
                format!("Version {champion} is in use."),
                "Look at it",
                format!("/ships/{}/versions/{champion}", of.name),
            ),
        }
    }

    fn open_place(text: String, button: &str, place: String) -> Self {
        Self { text, button: button.to_owned(), action: StepAction::Open(place) }
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
