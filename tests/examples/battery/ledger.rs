//! What was sent, what was acknowledged, and whether it is there: once, and unchanged.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use reqwest::Method;
use serde_json::Value;

use crate::client::{Client, Reply};
use crate::tally::Tally;
use crate::writes::{Kind, Write};

/// A write, and how it was acknowledged, if it was.
#[derive(Debug, Clone)]
pub struct Entry {
    /// The write.
    pub write: Write,
    /// The answer of success.
    pub acknowledged: Option<Value>,
}

/// All writes.
#[derive(Debug, Default)]
pub struct Ledger(Mutex<Vec<Entry>>);

impl Ledger {
    /// Keeps a write that is about to be sent; gives its place.
    pub fn begin(&self, write: &Write) -> usize {
        let mut entries = self.entries();
        entries.push(Entry { write: write.clone(), acknowledged: None });
        entries.len() - 1
    }

    /// Keeps an answer of success. One that differs from an earlier one to the same key is wrong.
    pub fn acknowledge(&self, place: usize, reply: &Reply, tally: &Tally) {
        let Entry { write, acknowledged } = &mut self.entries()[place];
        let said = reply.json();
        match acknowledged {
            Some(before) if *before != said => {
                tally.wrong(format!(
                    "{:?} {}: answered {before}, then {said}",
                    write.kind, write.mark
                ));
            }
            _ => *acknowledged = Some(said),
        }
    }

    /// Sends a write and keeps what came of it: `Some(true)` where it was acknowledged, none where
    /// nobody knows.
    pub async fn send(&self, place: usize, client: &Client, tally: &Tally) -> Option<bool> {
        let write = self.entries()[place].write.clone();
        let reply = write.send(client).await?;
        match reply.ok() {
            true => self.acknowledge(place, &reply, tally),
            false => self.refused(&write, &reply, tally),
        }
        Some(reply.ok())
    }

    /// Sends a write of which nobody knows what came, under its key: the answer must be that of the
    /// first time.
    pub async fn repeat(&self, place: usize, client: &Client, tally: &Tally) -> Option<bool> {
        let keyed = self.entries()[place].write.key.is_some()
            || self.entries()[place].write.kind == Kind::Tag;
        if keyed { self.send(place, client, tally).await } else { Some(false) }
    }

    /// All that was written.
    pub fn entries(&self) -> MutexGuard<'_, Vec<Entry>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// What is written is right: a refusal is wrong, unless the server says that it cannot now, or
    /// that a key is taken.
    fn refused(&self, write: &Write, reply: &Reply, tally: &Tally) {
        if reply.status < 500 && reply.status != 429 && !in_progress(reply) {
            let detail = &reply.json()["detail"];
            tally.wrong(format!(
                "{:?} {} is refused: {} {detail}",
                write.kind, write.mark, reply.status
            ));
        }
    }

    /// Looks for every write on a server: what was acknowledged is there, once and unchanged, and
    /// nothing is there twice.
    pub async fn check(&self, client: &Client, tally: &Tally) {
        let entries = self.entries().clone();
        // Of a ship of which nothing was acknowledged, nothing need be there.
        let acknowledged = entries.iter().filter(|entry| entry.acknowledged.is_some());
        let ships: BTreeSet<&str> = acknowledged.map(|entry| entry.write.ship.as_str()).collect();
        for ship in ships {
            let of = |kind: Kind| {
                entries
                    .iter()
                    .filter(move |entry| entry.write.kind == kind && entry.write.ship == ship)
            };
            self::trials(&of(Kind::Trial).collect::<Vec<_>>(), ship, client, tally).await;
            self::versions(&of(Kind::Version).collect::<Vec<_>>(), ship, client, tally).await;
            self::jobs(&of(Kind::Refinement).collect::<Vec<_>>(), ship, client, tally).await;
            self::moves(&of(Kind::Alias).collect::<Vec<_>>(), ship, client, tally).await;
            self::tags(&of(Kind::Tag).collect::<Vec<_>>(), ship, client, tally).await;
        }
        for entry in entries.iter().filter(|entry| entry.acknowledged.is_some()) {
            match entry.write.kind {
                Kind::Ship => named(entry, "/v1/ships", client, tally).await,
                Kind::Law => named(entry, "/v1/laws", client, tally).await,
                _ => {}
            }
        }
    }
}

/// What writers at the same time share.
pub struct Shared {
    /// What they write.
    pub ledger: Ledger,
    /// What is wrong.
    pub tally: Arc<Tally>,
    /// They shall end.
    pub stop: AtomicBool,
}

impl Shared {
    /// With nothing written yet.
    pub fn new(tally: &Arc<Tally>) -> Self {
        Self { ledger: Ledger::default(), tally: Arc::clone(tally), stop: AtomicBool::new(false) }
    }
}

/// Whether a key is said to be carried out by another.
pub fn in_progress(reply: &Reply) -> bool {
    reply.status == 409
        && reply.json()["detail"].as_str().is_some_and(|detail| detail.contains("Idempotency-Key"))
}

/// Ships and laws: the text that was sent is what is kept.
async fn named(entry: &Entry, list: &str, client: &Client, tally: &Tally) {
    let name = &entry.write.mark;
    let request = client.request(Method::GET, &format!("{list}/{name}"));
    let Some(reply) = client.send(request).await else {
        return tally.wrong(format!("{list}/{name}: no answer"));
    };
    if reply.status == 404 {
        return tally.lost(format!("{list}/{name}"));
    }
    let (said, found) = (entry.acknowledged.as_ref().unwrap_or(&Value::Null), reply.json());
    let same = ["name", "sha256", "title", "revision", "created_us"]
        .iter()
        .all(|field| said[field] == found[field]);
    if !same && !found.is_null() {
        tally.wrong(format!("{list}/{name}: acknowledged as {said}, found as {found}"));
    }
}

/// Each acknowledged item of a list is there unchanged; each mark is there once.
fn compare(kind: Kind, said: &[(&str, Option<&Value>)], found: &[(String, &Value)], tally: &Tally) {
    let mut by_mark: BTreeMap<&str, Vec<&Value>> = BTreeMap::new();
    found.iter().for_each(|(mark, item)| by_mark.entry(mark).or_default().push(item));
    for (mark, acknowledged) in said {
        let items = by_mark.get(mark).map_or(&[][..], Vec::as_slice);
        match (acknowledged, items) {
            (Some(said), []) => tally.lost(format!("{kind:?} {mark}, acknowledged as {said}")),
            (_, [_, _, ..]) => {
                tally.wrong(format!("{kind:?} {mark} is there {} times", items.len()))
            }
            (Some(said), [found]) if !same(kind, said, found) => {
                tally.wrong(format!("{kind:?} {mark}: acknowledged as {said}, found as {found}"));
            }
            _ => {}
        }
    }
}

/// What may not change of an item.
fn same(kind: Kind, said: &Value, found: &Value) -> bool {
    match kind {
        Kind::Refinement => said["id"] == found["id"] && said["request"] == found["request"],
        Kind::Alias => said["version"] == found["to"] && said["revision"] == found["revision"],
        _ => said == found || *found == without_author(said),
    }
}

/// As a store finds it that was left before authors were kept.
fn without_author(said: &Value) -> Value {
    let mut said = said.clone();
    if let Some(author) = said.get_mut("author") {
        *author = Value::Null;
    }
    said
}

async fn trials(entries: &[&Entry], ship: &str, client: &Client, tally: &Tally) {
    if entries.is_empty() {
        return;
    }
    let Some(items) = client.items(&format!("/v1/trials?ship={ship}")).await else {
        return tally.wrong(format!("the trials of {ship} are not listed"));
    };
    let found: Vec<_> = items.iter().map(|item| (text(item, "name"), item)).collect();
    let said: Vec<_> = entries
        .iter()
        .map(|entry| {
            (entry.write.mark.as_str(), entry.acknowledged.as_ref().map(|said| &said["trials"][0]))
        })
        .collect();
    compare(Kind::Trial, &said, &found, tally);
    for (_, item) in found.iter().rev().take(20) {
        let path = format!("/v1/trials/{}/samples", text(item, "id"));
        let samples =
            client.send(client.request(Method::GET, &path).header("accept", "text/csv")).await;
        if !samples.is_some_and(|samples| samples.ok()) {
            tally.lost(format!("the samples of {item}"));
        }
    }
}

/// The document of a registered version does not depend on its number, so that twins have one hash.
async fn versions(entries: &[&Entry], ship: &str, client: &Client, tally: &Tally) {
    if entries.is_empty() {
        return;
    }
    let Some(items) = client.items(&format!("/v1/models/{ship}/versions")).await else {
        return tally.wrong(format!("the versions of {ship} are not listed"));
    };
    let mut numbers: Vec<u64> = items.iter().filter_map(|item| item["number"].as_u64()).collect();
    numbers.sort_unstable();
    if !numbers.iter().copied().eq(1..=items.len() as u64) {
        tally.wrong(format!("the versions of {ship} have gaps: {numbers:?}"));
    }
    let found: Vec<_> = items.iter().map(|item| (text(item, "sha256"), item)).collect();
    let hashes: Vec<_> = entries.iter().map(|entry| entry.acknowledged.as_ref()).collect();
    let said: Vec<_> = hashes
        .iter()
        .flatten()
        .map(|said| (said["sha256"].as_str().unwrap_or("none"), Some(*said)))
        .collect();
    compare(Kind::Version, &said, &found, tally);
    let distinct: BTreeSet<&String> = found.iter().map(|(hash, _)| hash).collect();
    let twins = found.len() - distinct.len();
    let known = said
        .iter()
        .filter(|(hash, _)| found.iter().filter(|(other, _)| other == hash).count() > 1)
        .count();
    if twins > known {
        tally.wrong(format!("{twins} versions of {ship} are twins of others"));
    }
}

async fn jobs(entries: &[&Entry], ship: &str, client: &Client, tally: &Tally) {
    if entries.is_empty() {
        return;
    }
    let Some(items) = client.items(&format!("/v1/jobs?ship={ship}")).await else {
        return tally.wrong(format!("the jobs of {ship} are not listed"));
    };
    let items: Vec<&Value> = items.iter().filter(|item| item["kind"] == "refinement").collect();
    let found: Vec<_> = items.iter().map(|item| (text(item, "id"), *item)).collect();
    let acknowledged: Vec<&Value> =
        entries.iter().filter_map(|entry| entry.acknowledged.as_ref()).collect();
    let said: Vec<_> = acknowledged
        .iter()
        .map(|said| (said["id"].as_str().unwrap_or("none"), Some(*said)))
        .collect();
    compare(Kind::Refinement, &said, &found, tally);
    if items.len() > entries.len() {
        tally.wrong(format!("{} jobs of {ship} came of {} keys", items.len(), entries.len()));
    }
}

async fn moves(entries: &[&Entry], ship: &str, client: &Client, tally: &Tally) {
    let acknowledged = entries.iter().any(|entry| entry.acknowledged.is_some());
    if !acknowledged {
        return;
    }
    let Some(items) = client.items(&format!("/v1/models/{ship}/aliases/ledger/history")).await
    else {
        return tally.lost(format!("the alias `ledger` of {ship}"));
    };
    let found: Vec<_> = items.iter().map(|item| (text(item, "reason"), item)).collect();
    let said: Vec<_> = entries
        .iter()
        .map(|entry| (entry.write.mark.as_str(), entry.acknowledged.as_ref()))
        .collect();
    compare(Kind::Alias, &said, &found, tally);
    let mut revisions: Vec<u64> =
        items.iter().filter_map(|item| item["revision"].as_u64()).collect();
    revisions.sort_unstable();
    if !revisions.iter().copied().eq(1..=items.len() as u64) {
        tally.wrong(format!("the moves of `ledger` of {ship} have gaps: {revisions:?}"));
    }
}

async fn tags(entries: &[&Entry], ship: &str, client: &Client, tally: &Tally) {
    if entries.is_empty() {
        return;
    }
    let found = client.get(&format!("/v1/ships/{ship}/tags")).await.to_string();
    for entry in entries.iter().filter(|entry| entry.acknowledged.is_some()) {
        if !found.contains(&format!("\"{}\"", entry.write.mark)) {
            tally.lost(format!("the tag {} of {ship}", entry.write.mark));
        }
    }
}

fn text(item: &Value, field: &str) -> String {
    item[field].as_str().unwrap_or_default().to_owned()
}
