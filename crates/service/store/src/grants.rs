//! Roles of users and of service keys, each for the server, a ship or a family.

use serde_json::{Value, json};

use crate::arguments::args;
use crate::checks;
use crate::database::AuditedTransaction;
use crate::error::{Result, StoreError};
use crate::record::{RowCount, record};
use crate::statements::{same, statements};
use crate::store::Store;

statements! {
    OF = same("SELECT scope_kind, scope_name, role FROM grants WHERE principal = $1 ORDER BY \
        scope_kind, scope_name");
    CLEAR = same("DELETE FROM grants WHERE principal = $1");
    PUT = same("INSERT INTO grants (principal, scope_kind, scope_name, role) VALUES ($1, $2, $3, \
        $4) ON CONFLICT (principal, scope_kind, scope_name) DO UPDATE SET role = excluded.role");
    SHIP = same("SELECT COUNT(*) AS rows FROM ships WHERE name = $1");
    FAMILY = same("SELECT COUNT(*) AS rows FROM families WHERE name = $1");
    // The principal is `user:NAME` or `key:PREFIX`: the prefix decides, the rest is the name.
    HOLDERS = same("SELECT (SELECT COUNT(*) FROM users WHERE name = SUBSTR(CAST($1 AS TEXT), 6) \
        AND SUBSTR(CAST($1 AS TEXT), 1, 5) = 'user:' AND disabled_us IS NULL) \
        + (SELECT COUNT(*) FROM service_keys WHERE prefix = SUBSTR(CAST($1 AS TEXT), 5) \
        AND SUBSTR(CAST($1 AS TEXT), 1, 4) = 'key:' AND revoked_us IS NULL) AS rows");
}

record! {
    /// A role for something.
    pub struct GrantRow {
        /// `server`, `ship` or `family`.
        pub scope_kind: String,
        /// The name of the ship or family; empty for the server.
        pub scope_name: String,
        /// `reader`, `engineer`, `approver` or `admin`.
        pub role: String,
    }
}

/// Repository of granted roles.
#[derive(Debug, Clone, Copy)]
pub struct GrantRepository<'a>(pub(crate) &'a Store);

impl Store {
    /// Returns the repository of granted roles.
    pub fn grants(&self) -> GrantRepository<'_> {
        GrantRepository(self)
    }
}

impl GrantRepository<'_> {
    /// The roles of a user (`user:NAME`) or a service key (`key:PREFIX`).
    pub async fn list_by_principal(&self, principal: &str) -> Result<Vec<GrantRow>> {
        self.0.database().fetch_all(OF, args![principal: principal]).await
    }

    /// Replaces all roles of a user or service key.
    pub async fn replace_roles(&self, principal: &str, roles: &[GrantRow]) -> Result<()> {
        let mut tx = self.0.begin().await?;
        let holders: RowCount = tx.fetch_one(HOLDERS, args![principal: principal]).await?;
        if holders.rows == 0 {
            return Err(StoreError::not_found("user or key", principal));
        }
        let before: Vec<GrantRow> = tx.fetch_all(OF, args![principal: principal]).await?;
        // Replaced as a whole, in one transaction: no request sees a part of the roles.
        tx.execute(CLEAR, args![principal: principal]).await?;
        insert_roles(&mut tx, principal, roles).await?;
        let (before, after) =
            (json!({ "roles": role_names(&before) }), json!({ "roles": role_names(roles) }));
        tx.record_audit_event(
            self.0.now_us(),
            "roles.set",
            principal.to_owned(),
            Some(before),
            Some(after),
        );
        tx.commit().await
    }
}

/// Grants roles within a transaction; the ships and families must exist.
pub(crate) async fn insert_roles(
    tx: &mut AuditedTransaction,
    principal: &str,
    roles: &[GrantRow],
) -> Result<()> {
    for GrantRow { scope_kind, scope_name, role } in roles {
        check_scope(tx, scope_kind, scope_name).await?;
        let values =
            args![principal: principal, scope_kind: scope_kind, scope_name: scope_name, role: role];
        tx.execute(PUT, values).await?;
    }
    Ok(())
}

async fn check_scope(tx: &mut AuditedTransaction, kind: &str, name: &str) -> Result<()> {
    let statement = match kind {
        "ship" => SHIP,
        "family" => FAMILY,
        // The scope of the whole server has no name.
        _ => return Ok(()),
    };
    checks::check_name("roles", name)?;
    let found: RowCount = tx.fetch_one(statement, args![name: name]).await?;
    match found.rows {
        0 => Err(StoreError::invalid("roles", format!("there is no {kind} `{name}`"))),
        _ => Ok(()),
    }
}

/// Returns roles in the form of the audit: `role` or `role@ship:NAME`.
pub(crate) fn role_names(roles: &[GrantRow]) -> Value {
    let word = |row: &GrantRow| match row.scope_kind.as_str() {
        "server" => row.role.clone(),
        kind => format!("{}@{kind}:{}", row.role, row.scope_name),
    };
    roles.iter().map(word).collect()
}
