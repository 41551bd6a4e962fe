//! Roles in words.

use sistership_store::GrantRow;

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
        let row = |grant: &GrantRow| match grant.scope_kind.as_str() {
            "server" => Self { grant: grant.role.clone(), words: grant.role.clone() },
            kind => Self {
                grant: format!("{}@{kind}:{}", grant.role, grant.scope_name),
                words: format!("{} of the {kind} {}", grant.role, grant.scope_name),
            },
        };
        grants.iter().map(row).collect()
    }
}
