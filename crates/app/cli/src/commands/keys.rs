//! `sistership keys`: service keys of programs, directly in the store.

use clap::{Args, Subcommand};
use serde_json::{Value, json};
use sistership_auth::{Grant, KeyText};
use sistership_jobs::Archive;
use sistership_store::{KeyRow, MAX_LIMIT, NewKey, PageRequest, StoreError};

use super::store::{StoreArguments, with_archive};
use super::users::{grant_rows, grant_texts};
use crate::failure::Failure;
use crate::output;
use crate::table::TextTable;

const EXAMPLES: &str = "\
Examples:
  sistership keys add 'uploads of the bridge' --role engineer@ship:kvlcc2 --days 365
  sistership keys list
  sistership keys revoke 3f9a0c11d2e4

A key is printed only once; the store keeps its hash. A program sends it as
`Authorization: Bearer KEY`.";

/// One day, µs.
const DAY_US: i64 = 86_400_000_000;

/// Manage the service keys of programs: add, list, revoke.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct KeysArguments {
    #[command(subcommand)]
    what: KeysAction,
    #[command(flatten)]
    store: StoreArguments,
    /// Print one JSON document.
    #[arg(long, global = true)]
    json: bool,
}

#[derive(Debug, Subcommand)]
enum KeysAction {
    /// Create and print a key.
    Add {
        /// Purpose of the key.
        title: String,
        /// A role; repeatable.
        #[arg(long = "role", value_name = "ROLE[@ship:NAME|@family:NAME]")]
        roles: Vec<Grant>,
        /// User on whose behalf it acts.
        #[arg(long, value_name = "NAME")]
        user: Option<String>,
        /// Days until it expires; by default it is valid until revoked.
        #[arg(long, value_name = "DAYS", value_parser = clap::value_parser!(i64).range(1..=36500))]
        days: Option<i64>,
    },
    /// List all keys, expired ones included.
    List,
    /// Revoke a key permanently.
    Revoke {
        /// Prefix of the key, after `sis_`.
        prefix: String,
    },
}

/// Runs the command.
///
/// # Errors
/// Returns an error if the store does not exist, or if it refuses the command.
pub fn run(keys: &KeysArguments) -> Result<(), Failure> {
    // Drawn before the store is opened.
    let text = KeyText::new().map_err(|error| Failure::Refused(error.to_string()))?;
    let work = async |archive: &Archive| run_action(&keys.what, &text, archive).await;
    let (document, text) = with_archive(&keys.store, work)?;
    output::print_result(keys.json, &document, || text)
}

async fn run_action(
    what: &KeysAction,
    text: &KeyText,
    archive: &Archive,
) -> Result<(Value, String), StoreError> {
    let keys = archive.store.service_keys();
    match what {
        KeysAction::Add { title, roles, user, days } => {
            let kept = text.to_stored();
            // The clock of the store, which also decides whether a key is valid.
            let ends = days.map(|days| archive.store.now_us().saturating_add(days * DAY_US));
            let (title, user) = (title.clone(), user.clone());
            let new =
                NewKey { prefix: kept.prefix, title, user, sha256: kept.sha256, expires_us: ends };
            let row = keys.create(&new, &grant_rows(roles)).await?;
            let key = text.as_str();
            Ok((json!({ "key": key, "prefix": row.prefix, "expires_us": ends }), key.to_owned()))
        }
        KeysAction::List => list_keys(archive).await,
        KeysAction::Revoke { prefix } => {
            let row = keys.revoke(prefix).await?;
            let text = format!("{}: revoked", row.prefix);
            Ok((json!({ "prefix": row.prefix, "revoked_us": row.revoked_us }), text))
        }
    }
}

async fn list_keys(archive: &Archive) -> Result<(Value, String), StoreError> {
    let now = archive.store.now_us();
    let mut table = TextTable::new(["prefix", "for", "user", "roles", "state"]);
    let (mut all, mut page) = (Vec::new(), PageRequest::first_page(MAX_LIMIT));
    loop {
        let keys = archive.store.service_keys().list(&page).await?;
        for key in keys.items {
            let roles = grant_texts(
                &archive
                    .store
                    .grants()
                    .list_by_principal(&KeyRow::principal_name(&key.prefix))
                    .await?,
            );
            let state = if key.is_valid(now) { "valid" } else { "ended" };
            let user = key.user_name.clone().unwrap_or_default();
            let line = [key.prefix.clone(), key.title.clone(), user, roles.join(" "), state.into()];
            table.add_row(line);
            all.push(json!({
                "prefix": key.prefix, "title": key.title, "user": key.user_name, "roles": roles,
                "valid": key.is_valid(now), "expires_us": key.expires_us,
                "revoked_us": key.revoked_us, "last_used_us": key.last_used_us,
            }));
        }
        let Some(next) = keys.next else { break };
        page = PageRequest::after_key(next, MAX_LIMIT);
    }
    Ok((json!({ "keys": all }), table.to_string()))
}
