//! Families of ships with a common foundation: the list, and the page of one family with its ships,
//! the least reliable model first.

use askama::Template;
use sistership_jobs::Archive;
use sistership_jobs::fleet::{FamilyDrift, MemberDrift};
use sistership_store::Page;

use crate::cursor::{cursor, key};
use crate::date::date;
use crate::error::Result;
use crate::form::Fields;
use crate::picture::svg;
use crate::shell::Shell;
use crate::sparkline::sparkline;

/// Number of families on one page.
const FAMILIES: i64 = 50;
/// Number of ships on the page of a family.
const SHIPS: i64 = 50;

#[derive(Template)]
#[template(path = "families.html")]
struct FamiliesPage {
    shell: Shell,
    families: Vec<FamilyRow>,
    next: Option<String>,
}

struct FamilyRow {
    name: String,
    title: String,
    members: i64,
    created: String,
}

/// Returns the list, by name.
///
/// # Errors
/// Returns an error if a field is wrong or the store fails.
pub async fn list(archive: &Archive, shell: Shell, query: &Fields) -> Result<String> {
    let families = archive.store.families();
    let page = Page { after: key(query.text("after"))?, limit: FAMILIES };
    let list = families.list(&page).await?;
    let next = cursor(list.next.as_ref());
    let mut rows = Vec::new();
    for family in list.items {
        // Counted by the store for each family; a page has few.
        rows.push(FamilyRow {
            members: families.count(&family.name).await?,
            created: date(family.created_us),
            name: family.name,
            title: family.title,
        });
    }
    Ok(FamiliesPage { shell: shell.at("/families"), families: rows, next }.render()?)
}

#[derive(Template)]
#[template(path = "family.html")]
struct FamilyPage {
    shell: Shell,
    name: String,
    title: String,
    foundation: (String, String),
    members: i64,
    ships: Vec<MemberRow>,
}

struct MemberRow {
    ship: String,
    sentence: String,
    effects: String,
    worst: String,
    newest: String,
    trend: Option<String>,
}

/// Returns the page of one family.
///
/// # Errors
/// Returns an error if there is no family of this name or the store fails.
pub async fn one(archive: &Archive, shell: Shell, name: &str) -> Result<String> {
    let family = archive.store.families().get(name).await?;
    let head = archive.store.versions().by_id(&family.foundation).await?.head;
    let drift = FamilyDrift::of(archive, name, SHIPS).await?;
    let page = FamilyPage {
        shell: shell.at("/families"),
        name: family.name,
        title: family.title,
        foundation: (
            format!("{}/{}", head.model, head.number),
            format!("/ships/{}/versions/{}", head.model, head.number),
        ),
        members: drift.members,
        ships: drift.ships.iter().map(MemberRow::of).collect::<Result<_>>()?,
    };
    Ok(page.render()?)
}

/// Returns, for each trial, the largest residual over the axes, whether the trial was fitted, and
/// its time, µs; the oldest first.
fn residuals(member: &MemberDrift) -> Vec<(f64, bool, i64)> {
    let trials = member.drift.iter().flat_map(|drift| &drift.trials);
    trials.map(|trial| (trial.largest(), trial.fitted, trial.at_us)).collect()
}

impl MemberRow {
    fn of(member: &MemberDrift) -> Result<Self> {
        let all = residuals(member);
        let newest = all.last().map(|(worst, fitted, at_us)| {
            let fitted = if *fitted { " (fitted)" } else { "" };
            format!("{}: {:.0} %{fitted}", date(*at_us), 100.0 * worst)
        });
        let worst = member.drift.as_ref().and_then(|drift| drift.worst);
        Ok(Self {
            ship: member.ship.clone(),
            sentence: member.condition.sentence.clone(),
            effects: member.condition.effects.join(", "),
            worst: worst.map_or_else(|| "-".to_owned(), |worst| format!("{worst:.2}")),
            newest: newest.unwrap_or_default(),
            // Trials that were not fitted have a dot: only they test the model.
            trend: sparkline(all.iter().map(|(worst, fitted, _)| (*worst, !fitted)))
                .as_ref()
                .map(svg)
                .transpose()?,
        })
    }
}
