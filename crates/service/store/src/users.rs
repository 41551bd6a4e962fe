//! Users, who sign in by name and password. A user who leaves is disabled, and the name stays
//! reserved, as the audit refers to it.

use serde_json::json;

use crate::arguments::args;
use crate::checks;
use crate::database::AuditedTransaction;
use crate::error::{Result, StoreError};
use crate::grants::{self, GrantRow};
use crate::page::{ListPage, PageRequest};
use crate::record::record;
use crate::statements::{same, statements};
use crate::store::Store;

statements! {
    // A conflict on the name returns no row.
    INSERT = same("INSERT INTO users (name, title, password_hash, created_us) VALUES ($1, $2, $3, \
        $4) ON CONFLICT (name) DO NOTHING RETURNING name, title, password_hash, created_us, \
        disabled_us");
    GET = same("SELECT name, title, password_hash, created_us, disabled_us FROM users WHERE name = \
        $1");
    LIST = same("SELECT name, title, password_hash, created_us, disabled_us FROM users \
        WHERE name > COALESCE($1, '') ORDER BY name LIMIT $2");
    PASSWORD = same("UPDATE users SET password_hash = $2 WHERE name = $1 \
        RETURNING name, title, password_hash, created_us, disabled_us");
    // Only an enabled user; a second call changes no row, and keeps the first time.
    DISABLE = same("UPDATE users SET disabled_us = $2 WHERE name = $1 AND disabled_us IS NULL \
        RETURNING name, title, password_hash, created_us, disabled_us");
    ENABLE = same("UPDATE users SET disabled_us = NULL WHERE name = $1 AND disabled_us IS NOT NULL \
        RETURNING name, title, password_hash, created_us, disabled_us");
    SIGN_OUT = same("DELETE FROM sessions WHERE user_name = $1");
}

record! {
    /// A user.
    pub struct User {
        /// Name, which never changes.
        pub name: String,
        /// Display name.
        pub title: String,
        /// Argon2id hash of the password as a PHC string; none if no password is set.
        pub password_hash: Option<String>,
        /// When it was created.
        pub created_us: i64,
        /// Time of disabling, microseconds since 1970; none for an enabled user.
        pub disabled_us: Option<i64>,
    }
}

/// Repository of users.
#[derive(Debug, Clone, Copy)]
pub struct UserRepository<'a>(pub(crate) &'a Store);

impl Store {
    /// Returns the repository of users.
    pub fn users(&self) -> UserRepository<'_> {
        UserRepository(self)
    }
}

impl User {
    /// Returns the principal of a user in [`crate::Grants`] and in the audit.
    pub fn principal_name(name: &str) -> String {
        format!("user:{name}")
    }

    /// Returns true if the user is not disabled.
    pub fn is_enabled(&self) -> bool {
        self.disabled_us.is_none()
    }
}

impl UserRepository<'_> {
    /// Creates a user with roles; a name that was ever used is a conflict.
    pub async fn create(
        &self,
        name: &str,
        title: &str,
        password_hash: Option<&str>,
        roles: &[GrantRow],
    ) -> Result<User> {
        let mut tx = self.0.begin().await?;
        let user = insert_user(&mut tx, name, title, password_hash, self.0.now_us()).await?;
        let principal = User::principal_name(name);
        grants::insert_roles(&mut tx, &principal, roles).await?;
        let after = json!({ "title": title, "roles": grants::role_names(roles) });
        tx.record_audit_event(self.0.now_us(), "user.create", principal, None, Some(after));
        tx.commit().await?;
        Ok(user)
    }

    /// Returns a user.
    pub async fn get(&self, name: &str) -> Result<User> {
        self.find(name).await?.ok_or_else(|| StoreError::not_found("user", name))
    }

    /// Finds a user by name.
    pub async fn find(&self, name: &str) -> Result<Option<User>> {
        self.0.database().fetch_optional(GET, args![name: name]).await
    }

    /// Lists the users by name.
    pub async fn list(&self, page: &PageRequest) -> Result<ListPage<User>> {
        let values = args![after: &page.after, limit: page.fetch_limit()?];
        let users = self.0.database().fetch_all(LIST, values).await?;
        Ok(page.build_page(users, |user: &User| user.name.clone()))
    }

    /// Sets a password and ends the sessions of the user.
    pub async fn set_password(&self, name: &str, password_hash: &str) -> Result<User> {
        let mut tx = self.0.begin().await?;
        let set =
            tx.fetch_optional(PASSWORD, args![name: name, password_hash: password_hash]).await?;
        let user = self.finish_change(&mut tx, name, set, "does not exist any more").await?;
        tx.record_audit_event(
            self.0.now_us(),
            "user.password",
            User::principal_name(name),
            None,
            None,
        );
        tx.commit().await?;
        Ok(user)
    }

    /// Disables a user and ends the user's sessions.
    pub async fn disable(&self, name: &str) -> Result<User> {
        let mut tx = self.0.begin().await?;
        let values = args![name: name, disabled_us: self.0.now_us()];
        let disabled = tx.fetch_optional(DISABLE, values).await?;
        let user = self.finish_change(&mut tx, name, disabled, "is disabled already").await?;
        let (before, after) = (json!({ "enabled": true }), json!({ "enabled": false }));
        tx.record_audit_event(
            self.0.now_us(),
            "user.disable",
            User::principal_name(name),
            Some(before),
            Some(after),
        );
        tx.commit().await?;
        Ok(user)
    }

    /// Enables a disabled user.
    pub async fn enable(&self, name: &str) -> Result<User> {
        let mut tx = self.0.begin().await?;
        let enabled = tx.fetch_optional(ENABLE, args![name: name]).await?;
        let user = self.finish_change(&mut tx, name, enabled, "is enabled already").await?;
        let (before, after) = (json!({ "enabled": false }), json!({ "enabled": true }));
        tx.record_audit_event(
            self.0.now_us(),
            "user.enable",
            User::principal_name(name),
            Some(before),
            Some(after),
        );
        tx.commit().await?;
        Ok(user)
    }

    /// Ends the sessions of a user and returns the changed row, or the reason why no row was
    /// changed.
    async fn finish_change(
        &self,
        tx: &mut AuditedTransaction,
        name: &str,
        changed: Option<User>,
        why: &str,
    ) -> Result<User> {
        // In every case: no session outlasts a change of the account.
        sign_out(tx, name).await?;
        if let Some(user) = changed {
            return Ok(user);
        }
        require_user(tx, name).await?;
        Err(StoreError::conflict("user", name, why))
    }
}

/// Creates a user within a transaction.
pub(crate) async fn insert_user(
    tx: &mut AuditedTransaction,
    name: &str,
    title: &str,
    password_hash: Option<&str>,
    now_us: i64,
) -> Result<User> {
    checks::check_name("name", name)?;
    let values = args![name: name, title: title, password_hash: password_hash, created_us: now_us];
    let taken = || StoreError::conflict("user", name, "this name exists already");
    tx.fetch_optional(INSERT, values).await?.ok_or_else(taken)
}

/// Returns a user, or an error if there is none.
pub(crate) async fn require_user(tx: &mut AuditedTransaction, name: &str) -> Result<User> {
    let found = tx.fetch_optional(GET, args![name: name]).await?;
    found.ok_or_else(|| StoreError::not_found("user", name))
}

/// Ends all sessions of a user.
pub(crate) async fn sign_out(tx: &mut AuditedTransaction, name: &str) -> Result<()> {
    tx.execute(SIGN_OUT, args![user_name: name]).await.map(drop)
}
