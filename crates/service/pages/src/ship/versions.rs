//! The list of versions on the page of a ship.

use std::collections::BTreeMap;

use serde::Deserialize;
use sistership_jobs::Archive;
use sistership_store::{Alias, PageRequest, Store, StoreError, VersionHead};

use crate::date::format_date;
use crate::error::Result;
use crate::numbers::format_significant;

/// Number of versions on the page; their errors are read from their documents.
const LISTED_VERSIONS: i64 = 12;

pub(super) struct VersionRow {
    pub number: i64,
    pub aliases: Vec<String>,
    /// Label and address of the version it was made from.
    pub parent: Option<(String, String)>,
    pub law: String,
    pub method: String,
    pub error: String,
    pub created: String,
    pub author: String,
    pub report: Option<String>,
}

/// The part of a document that is read.
#[derive(Deserialize)]
struct DocumentReport {
    report: Option<ReportOptions>,
}

#[derive(Deserialize)]
struct ReportOptions {
    #[serde(default)]
    options: Vec<ReportStep>,
}

#[derive(Deserialize)]
struct ReportStep {
    #[serde(default)]
    chosen: bool,
    error: Option<f64>,
}

/// Returns the newest versions, and whether there are more.
pub(super) async fn list_versions(
    archive: &Archive,
    ship: &str,
    aliases: &[Alias],
) -> Result<(Vec<VersionRow>, bool)> {
    let list =
        archive.store.versions().list(ship, &PageRequest::first_page(LISTED_VERSIONS)).await?;
    let own = list.items.iter().map(|head| (head.id.clone(), label_and_address(head)));
    let mut labels: BTreeMap<String, (String, String)> = own.collect();
    let mut rows = Vec::new();
    for head in &list.items {
        // A parent that is not among the listed versions is read once.
        if let Some(parent) = head.parent.as_ref().filter(|parent| !labels.contains_key(*parent)) {
            let found = archive.store.versions().by_id(parent).await?.head;
            labels.insert(parent.clone(), label_and_address(&found));
        }
        rows.push(version_row(&archive.store, head, aliases, &labels).await?);
    }
    Ok((rows, list.next.is_some()))
}

fn label_and_address(head: &VersionHead) -> (String, String) {
    let VersionHead { model, number, .. } = head;
    (format!("{model}/{number}"), format!("/ships/{model}/versions/{number}"))
}

async fn version_row(
    store: &Store,
    head: &VersionHead,
    aliases: &[Alias],
    labels: &BTreeMap<String, (String, String)>,
) -> Result<VersionRow> {
    let VersionHead { number, parent, law, method, created_us, author, .. } = head;
    let reports = store.reports().by_version(&head.id, &PageRequest::first_page(1)).await?;
    let own = aliases.iter().filter(|alias| alias.version_number == *number);
    Ok(VersionRow {
        number: *number,
        aliases: own.map(|alias| alias.alias.clone()).collect(),
        parent: parent.as_ref().and_then(|parent| labels.get(parent).cloned()),
        law: law.clone(),
        method: method.clone(),
        error: held_out_error(store, head)
            .await?
            .map_or_else(String::new, |error| format_significant(error, 2)),
        created: format_date(*created_us),
        author: author.clone(),
        report: reports.items.into_iter().next().map(|report| report.id),
    })
}

/// Returns the error on held-out manoeuvres of a refined version.
async fn held_out_error(store: &Store, head: &VersionHead) -> Result<Option<f64>, StoreError> {
    if head.method.starts_with("published") {
        return Ok(None);
    }
    let document = store.versions().get(&head.model, head.number).await?.document;
    let reported: Option<DocumentReport> = serde_json::from_str(&document).ok();
    let options = reported.and_then(|reported| reported.report).map(|report| report.options);
    let chosen = options.into_iter().flatten().find(|step| step.chosen);
    Ok(chosen.and_then(|step| step.error))
}
