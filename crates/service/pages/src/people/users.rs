//! Users and service keys with their roles.

use askama::Template;
use sistership_jobs::Archive;
use sistership_store::{IdentityRow, KeyRow, PageRequest, User};

use super::roles::RoleRow;
use crate::cursor::{decode_cursor, encode_cursor};
use crate::date::format_date;
use crate::error::Result;
use crate::form::FormFields;
use crate::language::say;
use crate::shell::PageShell;

/// Number of users, and of keys, on one page.
const ROWS_PER_PAGE: i64 = 50;

#[derive(Template)]
#[template(path = "users.html")]
struct UsersPage {
    shell: PageShell,
    users: Vec<UserRow>,
    next: Option<String>,
    keys: Vec<KeyRowView>,
    next_keys: Option<String>,
    second_person: bool,
}

struct UserRow {
    name: String,
    title: String,
    roles: Vec<RoleRow>,
    /// Identities of the user at OpenID providers.
    identities: Vec<IdentityRow>,
    enabled: bool,
    created: String,
}

struct KeyRowView {
    prefix: String,
    title: String,
    user: String,
    roles: Vec<RoleRow>,
    created: String,
    ends: String,
    used: String,
    valid: bool,
}

/// Returns the page of users by name, and of keys.
///
/// # Errors
/// Returns an error if a field is wrong or the store fails.
pub async fn users_page(archive: &Archive, shell: PageShell, query: &FormFields) -> Result<String> {
    let store = &archive.store;
    let page = PageRequest { after: decode_cursor(query.get_text("after"))?, limit: ROWS_PER_PAGE };
    let list = store.users().list(&page).await?;
    let next = encode_cursor(list.next.as_ref());
    let mut users = Vec::new();
    for user in list.items {
        let roles = store.grants().list_by_principal(&User::principal_name(&user.name)).await?;
        let identities = store.identities().list_by_user(&user.name).await?;
        let (enabled, created) = (user.is_enabled(), format_date(user.created_us));
        let (User { name, title, .. }, roles) = (user, RoleRow::from_grants(&roles));
        users.push(UserRow { name, title, roles, identities, enabled, created });
    }
    // Users and keys have separate cursors on one page.
    let mut keys = Vec::new();
    let page =
        PageRequest { after: decode_cursor(query.get_text("keys_after"))?, limit: ROWS_PER_PAGE };
    let list = store.service_keys().list(&page).await?;
    let next_keys = encode_cursor(list.next.as_ref());
    for row in list.items {
        let roles = store.grants().list_by_principal(&KeyRow::principal_name(&row.prefix)).await?;
        keys.push(KeyRowView::from_key(row, RoleRow::from_grants(&roles), store.now_us()));
    }
    let second_person = store.settings().requires_second_person().await?;
    let shell = shell.at_place("/users");
    Ok(UsersPage { shell, users, next, keys, next_keys, second_person }.render()?)
}

impl KeyRowView {
    fn from_key(row: KeyRow, roles: Vec<RoleRow>, now_us: i64) -> Self {
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
            (Some(revoked), _) => say("keys-revoked").with("at", format_date(revoked)).into(),
            (None, Some(ends)) => format_date(ends),
            (None, None) => say("keys-until-revoked").into(),
        };
        let used = last_used_us.map_or_else(|| say("keys-never-used").into(), format_date);
        let (user, created) = (user_name.unwrap_or_default(), format_date(created_us));
        Self { prefix, title, user, roles, created, ends, used, valid }
    }
}

#[derive(Template)]
#[template(path = "new_key.html")]
struct NewKeyPage<'a> {
    shell: PageShell,
    title: &'a str,
    key: &'a str,
}

/// Returns the page with a new key, the only page that ever shows it.
///
/// # Errors
/// Returns an error if the page cannot be rendered.
pub fn new_key_page(shell: PageShell, title: &str, key: &str) -> Result<String> {
    Ok(NewKeyPage { shell: shell.at_place("/users"), title, key }.render()?)
}
