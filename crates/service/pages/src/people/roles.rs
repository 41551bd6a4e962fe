//! Roles in words.

use sistership_store::GrantRow;

use crate::language::{say, say_word};

/// A role in a list.
pub(super) struct RoleRow {
    /// In the notation of the form, `role` or `role@kind:name`.
    pub grant: String,
    /// In words.
    pub words: String,
}

impl RoleRow {
    /// Returns the roles of a principal.
    pub fn from_grants(grants: &[GrantRow]) -> Vec<Self> {
        let notation = |grant: &GrantRow| match grant.scope_kind.as_str() {
            "server" => grant.role.clone(),
            kind => format!("{}@{kind}:{}", grant.role, grant.scope_name),
        };
        let row = |grant: String| Self { words: role_words(&grant), grant };
        grants.iter().map(notation).map(row).collect()
    }
}

/// Returns a role in words, from the notation of the form.
pub(super) fn role_words(notation: &str) -> String {
    let Some((role, scope)) = notation.split_once('@') else { return say_word("role", notation) };
    let (kind, name) = scope.split_once(':').unwrap_or((scope, ""));
    let of = if kind == "family" { say("role-of-family") } else { say("role-of-ship") };
    of.with("role", say_word("role", role)).with("name", name).into()
}
