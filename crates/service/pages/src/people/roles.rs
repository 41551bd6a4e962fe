//! Roles in words.

use sistership_store::GrantRow;

/// Formats roles in the notation of the form, `role` or `role@kind:name`.
pub(super) fn format_roles(roles: &[GrantRow]) -> String {
    let word = |row: &GrantRow| match row.scope_kind.as_str() {
        "server" => row.role.clone(),
        kind => format!("{}@{kind}:{}", row.role, row.scope_name),
    };
    roles.iter().map(word).collect::<Vec<_>>().join(" ")
}
