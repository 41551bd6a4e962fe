//! Users, keys and sessions: the operations that endpoints and pages share.

use std::time::{Duration, Instant};

use http::StatusCode;
use sistership_auth::{
    Grant, KeyText, SignInAttempt, check_name, check_password, hash_password, hash_text,
    random_secret, to_hex, verify_password, verify_unknown,
};
use sistership_store::{KeyRow, NewKey, User};
use sistership_web_support::problem::{Problem, Result};

use crate::accounts::credentials::Accounts;
use crate::accounts::grants::grant_rows;

/// Duration of a session in a browser.
pub const SESSION_LIFETIME: Duration = Duration::from_secs(12 * 3600);

impl Accounts<'_> {
    /// Creates a user.
    pub async fn create_user(
        &self,
        name: &str,
        title: &str,
        password: Option<&str>,
        roles: &[Grant],
    ) -> Result<User> {
        check_name(name).map_err(|message| Problem::invalid("name", message))?;
        let hash = match password {
            Some(password) => Some(self.hash_new_password(password).await?),
            None => None,
        };
        Ok(self.store.users().create(name, title, hash.as_deref(), &grant_rows(roles)).await?)
    }

    /// Sets a password, which ends all sessions of the user.
    pub async fn set_password(&self, name: &str, password: &str) -> Result<User> {
        let hash = self.hash_new_password(password).await?;
        let user = self.store.users().set_password(name, &hash).await?;
        self.clear_cache();
        Ok(user)
    }

    /// Replaces all roles of a user or a key by these.
    pub async fn set_roles(&self, principal: &str, roles: &[Grant]) -> Result<()> {
        self.store.grants().replace_roles(principal, &grant_rows(roles)).await?;
        self.clear_cache();
        Ok(())
    }

    /// Disables a user, who then has no rights, or enables them again.
    pub async fn set_enabled(&self, name: &str, on: bool) -> Result<User> {
        let users = self.store.users();
        // The name stays taken, so that the audit stays unambiguous.
        let user = if on { users.enable(name).await? } else { users.disable(name).await? };
        self.clear_cache();
        Ok(user)
    }

    /// Creates a service key; its text is not kept and cannot be read later.
    pub async fn make_key(
        &self,
        title: &str,
        user: Option<String>,
        expires_us: Option<i64>,
        roles: &[Grant],
    ) -> Result<(KeyText, KeyRow)> {
        let text = KeyText::new().map_err(Problem::internal)?;
        let kept = text.to_stored();
        let title = title.to_owned();
        let new = NewKey { prefix: kept.prefix, title, user, sha256: kept.sha256, expires_us };
        Ok((text, self.store.service_keys().create(&new, &grant_rows(roles)).await?))
    }

    /// Revokes a key.
    pub async fn revoke(&self, prefix: &str) -> Result<KeyRow> {
        let key = self.store.service_keys().revoke(prefix).await?;
        self.clear_cache();
        Ok(key)
    }

    async fn hash_new_password(&self, password: &str) -> Result<String> {
        check_password(password).map_err(|message| Problem::invalid("password", message))?;
        let password = password.to_owned();
        self.credentials
            .hash_password(move || hash_password(&password))
            .await?
            .map_err(Problem::internal)
    }

    /// Begins a session of a user who knows the password; returns the secret of its cookie.
    pub async fn sign_in(&self, name: &str, password: &str, from: &str) -> Result<String> {
        self.verify_password_of(name, password, from).await?;
        let secret = random_secret().map_err(Problem::internal)?;
        let ends = i64::try_from(SESSION_LIFETIME.as_micros()).unwrap_or(i64::MAX);
        let until = self.store.now_us().saturating_add(ends);
        self.store.sessions().begin_session(&to_hex(&hash_text(&secret)), name, until).await?;
        Ok(secret)
    }

    /// Checks the password of an enabled user.
    ///
    /// # Errors
    /// Returns 401 if it is wrong or there is no such user, which cannot be distinguished, and 429
    /// after too many wrong ones.
    pub async fn verify_password_of(&self, name: &str, password: &str, from: &str) -> Result<()> {
        let (attempts, attempt) = (&self.credentials.attempts, SignInAttempt { name, from });
        attempts.begin_attempt(attempt, Instant::now()).map_err(|wait| {
            let wait = wait.as_secs().max(1);
            let why = format!("too many wrong passwords; try again in {wait} s");
            Problem::new(StatusCode::TOO_MANY_REQUESTS, why)
        })?;
        match self.is_password_correct(attempt, password).await {
            Ok(true) => attempts.record_success(attempt, Instant::now()),
            Ok(false) => {
                tracing::warn!(name, from, "wrong password");
                return Err(Problem::new(StatusCode::UNAUTHORIZED, "name or password is wrong"));
            }
            Err(problem) => {
                // An error of the server is no failed attempt.
                attempts.withdraw_attempt(attempt, Instant::now());
                return Err(problem);
            }
        }
        Ok(())
    }

    async fn is_password_correct(
        &self,
        attempt: SignInAttempt<'_>,
        password: &str,
    ) -> Result<bool> {
        let user = self.store.users().find(attempt.name).await?.filter(User::is_enabled);
        let hash = user.and_then(|user| user.password_hash);
        let password = password.to_owned();
        // A user that does not exist takes as long as a wrong password, so that names cannot be
        // found out.
        let compare = move || match hash {
            Some(hash) => verify_password(&password, &hash),
            None => {
                verify_unknown(&password);
                false
            }
        };
        self.credentials.compare_password(attempt, compare).await
    }
}
