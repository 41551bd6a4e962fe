//! What changed in a fleet within a week, ship by ship.

use sistership_jobs::Archive;
use sistership_store::{ChangeKind, ShipChange};

use crate::date::format_date;
use crate::error::Result;
use crate::language::{Message, say};

/// Time that counts as recent, µs.
const WEEK_US: i64 = 7 * 86_400_000_000;
/// Largest number of ships.
const MOST_SHIPS: usize = 8;

/// Recent changes of a ship in words.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct RecentShip {
    pub ship: String,
    pub words: String,
    /// Time of the latest change.
    pub at: String,
}

/// Reads the changes of the last week, the ship with the latest one first.
///
/// # Errors
/// Returns an error if the store fails.
pub(super) async fn recent_ships(archive: &Archive) -> Result<Vec<RecentShip>> {
    let since_us = archive.store.now_us() - WEEK_US;
    Ok(group_changes(&archive.store.recent_changes(since_us).await?))
}

/// Groups changes, the latest first, by ship.
fn group_changes(changes: &[ShipChange]) -> Vec<RecentShip> {
    let mut ships: Vec<(&str, Vec<&ShipChange>)> = Vec::new();
    for change in changes {
        match ships.iter_mut().find(|(ship, _)| *ship == change.ship) {
            Some((_, own)) => own.push(change),
            None => ships.push((&change.ship, vec![change])),
        }
    }
    let group = |(ship, own): (&str, Vec<&ShipChange>)| RecentShip {
        ship: ship.to_owned(),
        words: change_words(&own),
        at: format_date(own.first().map_or(0, |latest| latest.at_us)),
    };
    ships.into_iter().take(MOST_SHIPS).map(group).collect()
}

/// Returns the changes of one ship in words, the latest first.
fn change_words(changes: &[&ShipChange]) -> String {
    let kinds = || changes.iter().map(|change| &change.kind);
    // Of several diagnoses and promotions the latest one counts.
    let diagnosed = kinds().find_map(|kind| match kind {
        ChangeKind::Diagnosed(verdict) => Some(verdict_words(verdict)),
        _ => None,
    });
    let promoted = kinds().find_map(|kind| match kind {
        ChangeKind::Promoted(number) => Some(say("change-promoted").with("number", number)),
        _ => None,
    });
    let made = kinds().find_map(|kind| match kind {
        ChangeKind::VersionMade(number) => Some(say("change-made").with("number", number)),
        _ => None,
    });
    let uploaded = match kinds().filter(|kind| **kind == ChangeKind::TrialUploaded).count() {
        0 => None,
        count => Some(say("change-uploaded").with("count", count)),
    };
    let added = kinds().any(|kind| *kind == ChangeKind::ShipAdded);
    let added = added.then(|| say("change-added"));
    let all = [diagnosed, promoted, made, uploaded, added];
    all.into_iter().flatten().map(String::from).collect::<Vec<_>>().join("; ")
}

/// Verdict of a diagnosis in words.
fn verdict_words(verdict: &str) -> Message {
    match verdict {
        "complete" => say("change-diagnosed-complete"),
        "effects" => say("change-diagnosed-effects"),
        _ => say("change-diagnosed-other"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changes_are_told_ship_by_ship() {
        let change = |ship: &str, kind| ShipChange { ship: ship.to_owned(), kind, at_us: 0 };
        let changes = [
            change("a", ChangeKind::Diagnosed("effects".to_owned())),
            change("b", ChangeKind::ShipAdded),
            change("a", ChangeKind::Promoted(2)),
            change("a", ChangeKind::TrialUploaded),
            change("a", ChangeKind::TrialUploaded),
        ];
        let ships = group_changes(&changes);
        assert_eq!(ships.len(), 2);
        assert_eq!(
            ships[0].words,
            "a diagnosis found a missing effect; version 2 came into use; 2 trials were uploaded"
        );
        assert_eq!(ships[1].words, "the ship was added");
    }
}
