//! First steps on a server without a fleet: add a ship, upload its trials, refine its model.

use sistership_jobs::Archive;
use sistership_store::PageRequest;

use crate::error::Result;
use crate::language::{Message, say};

/// Number of ships from which on the steps are no longer shown.
const FEW_SHIPS: usize = 2;

/// Steps that are done.
#[derive(Debug, Default)]
pub(super) struct FirstSteps {
    /// Name of the first ship.
    pub ship: Option<String>,
    pub has_trials: bool,
    pub has_model: bool,
}

impl FirstSteps {
    /// Reads how far the first ship of a fleet is; `None` once the steps are done, or for a larger
    /// fleet.
    ///
    /// # Errors
    /// Returns an error if the store fails.
    pub async fn find(archive: &Archive, ships: &[&str]) -> Result<Option<Self>> {
        let Some(ship) = ships.first() else { return Ok(Some(Self::default())) };
        // A user who has a fleet knows the way.
        if ships.len() > FEW_SHIPS {
            return Ok(None);
        }
        let store = &archive.store;
        let trials = store.trials().list(ship, &PageRequest::first_page(1)).await?;
        let versions = store.versions().list(ship, &PageRequest::first_page(1)).await?;
        let (has_trials, has_model) = (!trials.items.is_empty(), !versions.items.is_empty());
        let steps = Self { ship: Some((*ship).to_owned()), has_trials, has_model };
        Ok((!steps.is_done()).then_some(steps))
    }

    fn is_done(&self) -> bool {
        self.has_trials && self.has_model
    }

    /// State, title, address and explanation of each step.
    pub fn steps(&self) -> [FirstStep; 3] {
        let at = |place: &str| self.ship.as_ref().map(|ship| format!("/ships/{ship}{place}"));
        let done = [self.ship.is_some(), self.has_trials, self.has_model];
        // Steps can be done in another order: the first gap is next.
        let next = done.iter().position(|done| !done);
        let state = |index: usize| match (done[index], next == Some(index)) {
            (true, _) => "done",
            (false, true) => "next",
            (false, false) => "later",
        };
        [
            FirstStep {
                state: state(0),
                title: say("step-add-title"),
                address: Some("/new-ship".to_owned()),
                text: say("step-add-text"),
            },
            FirstStep {
                state: state(1),
                title: say("step-upload-title"),
                address: at("/upload"),
                text: say("step-upload-text"),
            },
            FirstStep {
                state: state(2),
                title: say("step-refine-title"),
                address: at(""),
                text: say("step-refine-text"),
            },
        ]
    }
}

/// One step: `state` is `done`, `next` or `later`.
pub(super) struct FirstStep {
    pub state: &'static str,
    pub title: Message,
    pub address: Option<String>,
    pub text: Message,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exactly_one_step_is_next() {
        let states = |steps: FirstSteps| steps.steps().map(|step| step.state);
        assert_eq!(states(FirstSteps::default()), ["next", "later", "later"]);
        let ship = Some("own".to_owned());
        let uploaded = FirstSteps { ship, has_trials: true, has_model: false };
        assert_eq!(uploaded.steps()[1].address.as_deref(), Some("/ships/own/upload"));
        assert_eq!(states(uploaded), ["done", "done", "next"]);
    }
}
