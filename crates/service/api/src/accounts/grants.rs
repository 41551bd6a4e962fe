//! Roles in the form of the store and in the form of access decisions.

use sistership_auth::{Grant, Rights, Scope};
use sistership_store::{GrantRow, Store};
use sistership_web_support::problem::Result;

/// Returns roles in the form of the store.
pub(crate) fn rows(roles: &[Grant]) -> Vec<GrantRow> {
    let row = |grant: &Grant| {
        let (kind, name) = grant.scope.parts();
        let (scope_kind, scope_name) = (kind.to_owned(), name.to_owned());
        GrantRow { scope_kind, scope_name, role: grant.role.as_str().to_owned() }
    };
    roles.iter().map(row).collect()
}

/// Returns the rights of a user or a key.
pub(crate) async fn rights(store: &Store, principal: &str) -> Result<Rights> {
    let rows = store.grants().of(principal).await?;
    Ok(Rights::new(rows.iter().filter_map(grant).collect()))
}

/// Parses a stored role; a role or scope that this program does not know gives no right.
fn grant(row: &GrantRow) -> Option<Grant> {
    let scope = Scope::of_parts(&row.scope_kind, &row.scope_name)?;
    Some(Grant { scope, role: row.role.parse().ok()? })
}
