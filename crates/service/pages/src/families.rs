//! Families of ships with a common foundation: the list, and the page of one family with its ships,
//! the least reliable model first.

use askama::Template;
use sistership_jobs::Archive;
use sistership_jobs::fleet::{FamilyDrift, MemberDrift};
use sistership_store::PageRequest;

use crate::cursor::{decode_cursor, encode_cursor};
use crate::date::format_date;
use crate::error::Result;
use crate::form::FormFields;
use crate::language::say;
use crate::numbers::format_fixed;
use crate::pickers;
use crate::picture::render_svg;
use crate::shell::PageShell;
use crate::sparkline::sparkline;
use crate::terms::condition_sentence;

/// Number of families on one page.
const FAMILIES_PER_PAGE: i64 = 50;
/// Number of ships on the page of a family.
const SHIPS_PER_PAGE: i64 = 50;

#[derive(Template)]
#[template(path = "families.html")]
struct FamiliesPage {
    shell: PageShell,
    families: Vec<FamilyRow>,
    next: Option<String>,
    /// Names that the field of the foundation offers.
    known: Vec<String>,
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
pub async fn families_page(
    archive: &Archive,
    shell: PageShell,
    query: &FormFields,
) -> Result<String> {
    let families = archive.store.families();
    let page =
        PageRequest { after: decode_cursor(query.get_text("after"))?, limit: FAMILIES_PER_PAGE };
    let list = families.list(&page).await?;
    let next = encode_cursor(list.next.as_ref());
    let mut rows = Vec::new();
    for family in list.items {
        // Counted by the store for each family; a page has few.
        rows.push(FamilyRow {
            members: families.count_members(&family.name).await?,
            created: format_date(family.created_us),
            name: family.name,
            title: family.title,
        });
    }
    let known = pickers::model_names(archive).await?;
    let shell = shell.at_place("/families");
    Ok(FamiliesPage { shell, families: rows, next, known }.render()?)
}

#[derive(Template)]
#[template(path = "family.html")]
struct FamilyPage {
    shell: PageShell,
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
pub async fn family_page(archive: &Archive, shell: PageShell, name: &str) -> Result<String> {
    let family = archive.store.families().get(name).await?;
    let head = archive.store.versions().by_id(&family.foundation).await?.head;
    let drift = FamilyDrift::read_members(archive, name, SHIPS_PER_PAGE).await?;
    let page = FamilyPage {
        shell: shell.at_place("/families"),
        name: family.name,
        title: family.title,
        foundation: (
            format!("{}/{}", head.model, head.number),
            format!("/ships/{}/versions/{}", head.model, head.number),
        ),
        members: drift.members,
        ships: drift.ships.iter().map(MemberRow::from_member).collect::<Result<_>>()?,
    };
    Ok(page.render()?)
}

/// Returns, for each trial, the largest residual over the axes, whether the trial was fitted, and
/// its time, µs; the oldest first.
fn trial_residuals(member: &MemberDrift) -> Vec<(f64, bool, i64)> {
    let trials = member.drift.iter().flat_map(|drift| &drift.trials);
    trials.map(|trial| (trial.largest_residual(), trial.fitted, trial.at_us)).collect()
}

impl MemberRow {
    fn from_member(member: &MemberDrift) -> Result<Self> {
        let all = trial_residuals(member);
        let newest = all.last().map(|(worst, fitted, at_us)| {
            let text = if *fitted { say("family-newest-fitted") } else { say("family-newest") };
            let share = format_fixed(100.0 * worst, 0);
            text.with("at", format_date(*at_us)).with("share", share).to_string()
        });
        let worst = member.drift.as_ref().and_then(|drift| drift.worst);
        Ok(Self {
            ship: member.ship.clone(),
            sentence: condition_sentence(&member.condition),
            effects: member.condition.effects.join(", "),
            worst: worst.map_or_else(|| "-".to_owned(), |worst| format_fixed(worst, 2)),
            newest: newest.unwrap_or_default(),
            // Trials that were not fitted have a dot: only they test the model.
            trend: sparkline(all.iter().map(|(worst, fitted, _)| (*worst, !fitted)))
                .as_ref()
                .map(render_svg)
                .transpose()?,
        })
    }
}
