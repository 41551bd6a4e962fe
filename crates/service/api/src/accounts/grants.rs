//! Roles in the form of the store and in the form of access decisions.

use sistership_auth::{Grant, Rights, Scope};
use sistership_store::{GrantRow, Store};
use sistership_web_support::problem::Result;

/// Returns roles in the form of the store.
pub(crate) fn grant_rows(roles: &[Grant]) -> Vec<GrantRow> {
    let row = |grant: &Grant| {
        let (kind, name) = grant.scope.to_parts();
        let (scope_kind, scope_name) = (kind.to_owned(), name.to_owned());
        GrantRow { scope_kind, scope_name, role: grant.role.as_str().to_owned() }
    };
    roles.iter().map(row).collect()
}

/// Returns the rights of a user or a key.
pub(crate) async fn principal_rights(store: &Store, principal: &str) -> Result<Rights> {
    let rows = store.grants().list_by_principal(principal).await?;
    Ok(Rights::new(rows.iter().filter_map(parse_grant).collect()))
}

/// Parses a stored role; a role or scope that this program does not know gives no right.
fn parse_grant(row: &GrantRow) -> Option<Grant> {
    let scope = Scope::from_parts(&row.scope_kind, &row.scope_name)?;
    Some(Grant { scope, role: row.role.parse().ok()? })
}
