//! Users and service keys with their roles.

use askama::Template;
use sistership_jobs::Archive;
use sistership_store::{Identity, KeyRow, Page, User};

use super::roles::words;
use crate::cursor::{cursor, key};
use crate::date::date;
use crate::error::Result;
use crate::form::Fields;
use crate::shell::Shell;

/// Number of users, and of keys, on one page.
const ROWS: i64 = 50;

#[derive(Template)]
#[template(path = "users.html")]
struct UsersPage {
    shell: Shell,
    users: Vec<UserRow>,
    next: Option<String>,
    keys: Vec<KeyLine>,
    next_keys: Option<String>,
    second_person: bool,
}

struct UserRow {
    name: String,
    title: String,
    roles: String,
    /// Identities of the user at OpenID providers.
    identities: Vec<Identity>,
    enabled: bool,
    created: String,
}

struct KeyLine {
    prefix: String,
    title: String,
    user: String,
    roles: String,
    created: String,
    ends: String,
    used: String,
    valid: bool,
}

/// Returns the page of users by name, and of keys.
///
/// # Errors
/// Returns an error if a field is wrong or the store fails.
pub async fn users(archive: &Archive, shell: Shell, query: &Fields) -> Result<String> {
    let store = &archive.store;
    let page = Page { after: key(query.text("after"))?, limit: ROWS };
    let list = store.users().list(&page).await?;
    let next = cursor(list.next.as_ref());
    let mut users = Vec::new();
    for user in list.items {
        let roles = store.grants().of(&User::principal(&user.name)).await?;
        let identities = store.identities().of(&user.name).await?;
        let (enabled, created) = (user.is_enabled(), date(user.created_us));
        let (User { name, title, .. }, roles) = (user, words(&roles));
        users.push(UserRow { name, title, roles, identities, enabled, created });
    }
    // Users and keys have separate cursors on one page.
    let mut keys = Vec::new();
    let page = Page { after: key(query.text("keys_after"))?, limit: ROWS };
    let list = store.service_keys().list(&page).await?;
    let next_keys = cursor(list.next.as_ref());
    for row in list.items {
        let roles = store.grants().of(&KeyRow::principal(&row.prefix)).await?;
        keys.push(KeyLine::of(row, words(&roles), store.now_us()));
    }
    let second_person = store.settings().second_person().await?;
    let shell = shell.at("/users");
    Ok(UsersPage { shell, users, next, keys, next_keys, second_person }.render()?)
}

impl KeyLine {
    fn of(row: KeyRow, roles: String, now_us: i64) -> Self {
        let valid = row.is_valid(now_us);
        let KeyRow {
            prefix,
            title,
            user_name,
            created_us,
            expires_us,
            revoked_us,
            last_used_us,
            ..
        } = row;
        // A revoked key has ended, whatever its date.
        let ends = match (revoked_us, expires_us) {
            (Some(revoked), _) => format!("revoked {}", date(revoked)),
            (None, Some(ends)) => date(ends),
            (None, None) => "when it is revoked".to_owned(),
        };
        let used = last_used_us.map_or_else(|| "never".to_owned(), date);
        let (user, created) = (user_name.unwrap_or_default(), date(created_us));
        Self { prefix, title, user, roles, created, ends, used, valid }
    }
}

#[derive(Template)]
#[template(path = "new_key.html")]
struct NewKeyPage<'a> {
    shell: Shell,
    title: &'a str,
    key: &'a str,
}

/// Returns the page with a new key, the only page that ever shows it.
///
/// # Errors
/// Returns an error if the page cannot be rendered.
pub fn new_key(shell: Shell, title: &str, key: &str) -> Result<String> {
    Ok(NewKeyPage { shell: shell.at("/users"), title, key }.render()?)
}
