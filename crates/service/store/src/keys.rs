//! Service keys, the credentials of programs. Only the prefix and the hash are stored.

use serde_json::json;

use crate::arguments::args;
use crate::checks;
use crate::error::{Result, StoreError};
use crate::grants::{self, GrantRow};
use crate::page::{ListPage, PageRequest};
use crate::record::record;
use crate::statements::{same, statements};
use crate::store::Store;

/// The columns of a key.
macro_rules! key {
    ($before:literal, $after:literal) => {
        same(concat!(
            $before,
            " prefix, title, user_name, sha256, created_us, expires_us, revoked_us, last_used_us ",
            $after
        ))
    };
}

statements! {
    INSERT = key!("INSERT INTO service_keys (prefix, title, user_name, sha256, created_us, \
        expires_us) VALUES ($1, $2, $3, $4, $5, $6) RETURNING", "");
    GET = key!("SELECT", "FROM service_keys WHERE prefix = $1");
    LIST = key!("SELECT", "FROM service_keys WHERE prefix > COALESCE($1, '') ORDER BY prefix LIMIT \
        $2");
    REVOKE = key!("UPDATE service_keys SET revoked_us = $2 WHERE prefix = $1 AND revoked_us IS \
        NULL RETURNING", "");
    // Concurrent uses may arrive out of order; the time never moves back.
    USED = same("UPDATE service_keys SET last_used_us = $2 WHERE prefix = $1 AND \
        COALESCE(last_used_us, 0) < $2");
    USER = same("SELECT name, title, password_hash, created_us, disabled_us FROM users WHERE name \
        = $1 AND disabled_us IS NULL");
}

record! {
    /// A service key.
    pub struct KeyRow {
        /// Public first part, by which the key is found and shown.
        pub prefix: String,
        /// Purpose, in words.
        pub title: String,
        /// User in whose name it acts; none if it acts in its own.
        pub user_name: Option<String>,
        /// SHA-256 of the whole key, hexadecimal.
        pub sha256: String,
        /// When it was made.
        pub created_us: i64,
        /// Time of expiry, microseconds since 1970; none if it does not expire.
        pub expires_us: Option<i64>,
        /// Time of revocation, microseconds since 1970; none if it was not revoked.
        pub revoked_us: Option<i64>,
        /// Time of the last use, to a minute, microseconds since 1970.
        pub last_used_us: Option<i64>,
    }
}

/// A service key to be stored.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NewKey {
    /// Public first part, by which the key is found.
    pub prefix: String,
    /// Purpose, in words.
    pub title: String,
    /// User in whose name it acts.
    pub user: Option<String>,
    /// SHA-256 of the whole key, hexadecimal.
    pub sha256: String,
    /// Time of expiry, microseconds since 1970.
    pub expires_us: Option<i64>,
}

/// Repository of service keys.
#[derive(Debug, Clone, Copy)]
pub struct ServiceKeys<'a>(pub(crate) &'a Store);

impl Store {
    /// Returns the repository of service keys.
    pub fn service_keys(&self) -> ServiceKeys<'_> {
        ServiceKeys(self)
    }
}

impl KeyRow {
    /// Returns the principal of a key in [`crate::Grants`] and in the audit.
    pub fn principal_name(prefix: &str) -> String {
        format!("key:{prefix}")
    }

    /// Returns true if the key is neither revoked nor expired at `now_us`.
    pub fn is_valid(&self, now_us: i64) -> bool {
        self.revoked_us.is_none() && self.expires_us.is_none_or(|end| now_us < end)
    }
}

impl ServiceKeys<'_> {
    /// Stores a key with its roles.
    pub async fn create(&self, new: &NewKey, roles: &[GrantRow]) -> Result<KeyRow> {
        checks::check_sha256("sha256", &new.sha256)?;
        let NewKey { prefix, title, user, sha256, expires_us } = new;
        let mut tx = self.0.begin().await?;
        if let Some(name) = user {
            // A disabled user counts as absent here.
            let found: Option<crate::users::User> =
                tx.fetch_optional(USER, args![name: name]).await?;
            found
                .ok_or_else(|| StoreError::invalid("user", format!("there is no user `{name}`")))?;
        }
        let values = args![prefix: prefix, title: title, user_name: user, sha256: sha256,
            created_us: self.0.now_us(), expires_us: *expires_us];
        let key = tx.fetch_one(INSERT, values).await?;
        let principal = KeyRow::principal_name(prefix);
        grants::insert_roles(&mut tx, &principal, roles).await?;
        let after = json!({ "title": title, "user": user, "expires_us": expires_us,
            "roles": grants::role_names(roles) });
        tx.record_audit_event(self.0.now_us(), "key.create", principal, None, Some(after));
        tx.commit().await?;
        Ok(key)
    }

    /// Returns a key.
    pub async fn get(&self, prefix: &str) -> Result<KeyRow> {
        self.find(prefix).await?.ok_or_else(|| StoreError::not_found("key", prefix))
    }

    /// Finds a key by its prefix.
    pub async fn find(&self, prefix: &str) -> Result<Option<KeyRow>> {
        self.0.database().fetch_optional(GET, args![prefix: prefix]).await
    }

    /// Lists the keys by prefix, including revoked and expired ones.
    pub async fn list(&self, page: &PageRequest) -> Result<ListPage<KeyRow>> {
        let values = args![after: &page.after, limit: page.fetch_limit()?];
        let keys = self.0.database().fetch_all(LIST, values).await?;
        Ok(page.build_page(keys, |key: &KeyRow| key.prefix.clone()))
    }

    /// Revokes a key permanently.
    pub async fn revoke(&self, prefix: &str) -> Result<KeyRow> {
        let mut tx = self.0.begin().await?;
        let values = args![prefix: prefix, revoked_us: self.0.now_us()];
        let Some(key) = tx.fetch_optional(REVOKE, values).await? else {
            return Err(match tx.fetch_optional::<KeyRow>(GET, args![prefix: prefix]).await? {
                // The update matches active keys only; the read shows why it matched none.
                Some(_) => StoreError::conflict("key", prefix, "is revoked already"),
                None => StoreError::not_found("key", prefix),
            });
        };
        let after = json!({ "revoked": true });
        tx.record_audit_event(
            self.0.now_us(),
            "key.revoke",
            KeyRow::principal_name(prefix),
            None,
            Some(after),
        );
        tx.commit().await?;
        Ok(key)
    }

    /// Records that a key is being used.
    pub async fn record_use(&self, prefix: &str) -> Result<()> {
        let mut tx = self.0.begin().await?;
        tx.execute(USED, args![prefix: prefix, last_used_us: self.0.now_us()]).await?;
        tx.commit().await
    }
}
