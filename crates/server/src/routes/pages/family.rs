//! The page of a family: its members, the one whose model holds least first.

use askama::Template;
use axum::extract::State;
use axum::response::Response;

use super::super::drift::{FamilyDrift, MemberDrift};
use super::answer::answer;
use super::rows::date;
use crate::app::App;
use crate::problem::Result;
use crate::web::Place;

/// Ships on the page.
const SHIPS: i64 = 50;
/// Newest trials of each.
const TRIALS: usize = 5;

#[derive(Template)]
#[template(path = "family.html")]
struct FamilyPage {
    name: String,
    title: String,
    members: i64,
    ships: Vec<Row>,
}

struct Row {
    ship: String,
    sentence: String,
    effects: String,
    worst: String,
    trials: String,
}

pub(super) async fn page(State(app): State<App>, Place(name): Place<String>) -> Result<Response> {
    let family = app.store().families().get(&name).await?;
    let drift = FamilyDrift::of(&app, &name, SHIPS).await?;
    let ships = drift.ships.iter().map(Row::of).collect();
    answer(&FamilyPage { name: family.name, title: family.title, members: drift.members, ships })
}

impl Row {
    fn of(member: &MemberDrift) -> Self {
        let trials = member.drift.as_ref().map_or(&[][..], |drift| &drift.trials);
        let newest = trials.iter().rev().take(TRIALS).map(|trial| {
            let worst = trial.residual.values().copied().fold(0.0, f64::max);
            format!(
                "{}: {:.0} %{}",
                date(trial.at_us),
                100.0 * worst,
                if trial.fitted { " (fitted)" } else { "" }
            )
        });
        let worst = member.drift.as_ref().and_then(|drift| drift.worst);
        Self {
            ship: member.ship.clone(),
            sentence: member.condition.sentence.clone(),
            effects: member.condition.effects.join(", "),
            worst: worst.map_or_else(|| "-".to_owned(), |worst| format!("{worst:.2}")),
            trials: newest.collect::<Vec<_>>().join("; "),
        }
    }
}
