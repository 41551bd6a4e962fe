//! Identities at OpenID providers and the users that they belong to. A sign-in at a provider can be
//! used once: its use is recorded with the session, or with the identity, that results from it.

use serde_json::{Value, json};

use crate::arguments::args;
use crate::checks;
use crate::database::AuditedTransaction;
use crate::error::{Result, StoreError};
use crate::grants::{self, GrantRow};
use crate::record::record;
use crate::sessions;
use crate::statements::{same, statements};
use crate::store::Store;
use crate::users::{self, User};

statements! {
    GET = same("SELECT issuer, subject, user_name, created_us FROM identities WHERE issuer = $1 \
        AND subject = $2");
    OF = same("SELECT issuer, subject, user_name, created_us FROM identities WHERE user_name = $1 \
        ORDER BY issuer, subject");
    // An identity belongs to one user: a conflict returns no row.
    PUT = same("INSERT INTO identities (issuer, subject, user_name, created_us) VALUES ($1, $2, \
        $3, $4) ON CONFLICT (issuer, subject) DO NOTHING RETURNING issuer, subject, user_name, \
        created_us");
    CLEAR = same("DELETE FROM identities WHERE user_name = $1");
    // The second insertion of the same hash changes no row.
    SPEND = same("INSERT INTO spent_sign_ins (sha256, expires_us) VALUES ($1, $2) ON CONFLICT \
        (sha256) DO NOTHING");
    PURGE = same("DELETE FROM spent_sign_ins WHERE expires_us < $1");
}

record! {
    /// An identity at a provider, and the user that it belongs to.
    pub struct IdentityRow {
        /// Issuer URL of the provider.
        pub issuer: String,
        /// Subject, unique within the issuer.
        pub subject: String,
        /// Name of the user.
        pub user_name: String,
        /// Time of linking, microseconds since 1970.
        pub created_us: i64,
    }
}

/// A completed sign-in at a provider.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SignIn<'a> {
    /// Issuer URL of the provider.
    pub issuer: &'a str,
    /// Subject, unique within the issuer.
    pub subject: &'a str,
    /// Hash that identifies the sign-in, so that a second use is recognised.
    pub sha256: &'a str,
    /// Time of expiry, microseconds since 1970.
    pub expires_us: i64,
}

/// Repository of identities.
#[derive(Debug, Clone, Copy)]
pub struct IdentityRepository<'a>(pub(crate) &'a Store);

impl Store {
    /// Returns the repository of identities at OpenID providers.
    pub fn identities(&self) -> IdentityRepository<'_> {
        IdentityRepository(self)
    }
}

impl SignIn<'_> {
    /// Returns the sign-in in the form of the audit.
    fn audit_state(&self) -> Value {
        json!({ "issuer": self.issuer, "subject": self.subject })
    }
}

impl IdentityRepository<'_> {
    /// Finds an identity, if it belongs to a user here.
    pub async fn find(&self, issuer: &str, subject: &str) -> Result<Option<IdentityRow>> {
        self.0.database().fetch_optional(GET, args![issuer: issuer, subject: subject]).await
    }

    /// Returns the identities of a user.
    pub async fn list_by_user(&self, user: &str) -> Result<Vec<IdentityRow>> {
        self.0.database().fetch_all(OF, args![user_name: user]).await
    }

    /// Replaces the identities of a user, pairs of issuer and subject; ends the user's sessions if
    /// one is removed.
    pub async fn replace_identities(&self, user: &str, those: &[(String, String)]) -> Result<()> {
        let mut tx = self.0.begin().await?;
        users::require_user(&mut tx, user).await?;
        // Read within the transaction, for the audit and for the comparison below.
        let before: Vec<IdentityRow> = tx.fetch_all(OF, args![user_name: user]).await?;
        tx.execute(CLEAR, args![user_name: user]).await?;
        for (issuer, subject) in those {
            self.insert_identity(&mut tx, user, issuer, subject).await?;
        }
        let pair = |one: &IdentityRow| (one.issuer.clone(), one.subject.clone());
        let before: Vec<(String, String)> = before.iter().map(pair).collect();
        // A session may have begun by the identity that goes.
        if before.iter().any(|one| !those.contains(one)) {
            users::sign_out(&mut tx, user).await?;
        }
        let (before, after) = (json!({ "identities": before }), json!({ "identities": those }));
        let subject = User::principal_name(user);
        tx.record_audit_event(
            self.0.now_us(),
            "user.identities",
            subject,
            Some(before),
            Some(after),
        );
        tx.commit().await
    }

    /// Links the identity of a sign-in to a user, in addition to existing ones.
    pub async fn link_identity(&self, user: &str, sign_in: SignIn<'_>) -> Result<()> {
        let mut tx = self.0.begin().await?;
        self.mark_used(&mut tx, sign_in).await?;
        users::require_user(&mut tx, user).await?;
        self.insert_identity(&mut tx, user, sign_in.issuer, sign_in.subject).await?;
        let (now, subject) = (self.0.now_us(), User::principal_name(user));
        tx.record_audit_event(now, "user.identity", subject, None, Some(sign_in.audit_state()));
        tx.commit().await
    }

    /// Creates a user with the identity of a sign-in and without a password.
    pub async fn create_user(
        &self,
        name: &str,
        title: &str,
        roles: &[GrantRow],
        sign_in: SignIn<'_>,
    ) -> Result<()> {
        let mut tx = self.0.begin().await?;
        users::insert_user(&mut tx, name, title, None, self.0.now_us()).await?;
        let principal = User::principal_name(name);
        grants::insert_roles(&mut tx, &principal, roles).await?;
        // User, roles and identity in one transaction: no user without a way to sign in remains.
        self.insert_identity(&mut tx, name, sign_in.issuer, sign_in.subject).await?;
        let identity = sign_in.audit_state();
        let after =
            json!({ "title": title, "roles": grants::role_names(roles), "identity": identity });
        tx.record_audit_event(self.0.now_us(), "user.create", principal, None, Some(after));
        tx.commit().await
    }

    /// Begins a session of a user who has signed in at a provider.
    pub async fn begin_session(
        &self,
        sha256: &str,
        user: &str,
        expires_us: i64,
        sign_in: SignIn<'_>,
    ) -> Result<()> {
        let mut tx = self.0.begin().await?;
        self.mark_used(&mut tx, sign_in).await?;
        let now = self.0.now_us();
        sessions::insert_session(&mut tx, sha256, user, now, expires_us).await?;
        tx.record_audit_event(
            now,
            "session.begin",
            User::principal_name(user),
            None,
            Some(sign_in.audit_state()),
        );
        tx.commit().await
    }

    /// Records in the audit that a sign-in was refused, and why.
    pub async fn record_refusal(&self, sign_in: SignIn<'_>, why: &str) -> Result<()> {
        let mut tx = self.0.begin().await?;
        self.mark_used(&mut tx, sign_in).await?;
        let after = json!({ "issuer": sign_in.issuer, "subject": sign_in.subject, "why": why });
        let subject = format!("identity:{}", sign_in.subject);
        tx.record_audit_event(self.0.now_us(), "session.refuse", subject, None, Some(after));
        tx.commit().await
    }

    async fn insert_identity(
        &self,
        tx: &mut AuditedTransaction,
        user: &str,
        issuer: &str,
        subject: &str,
    ) -> Result<()> {
        checks::check_line("issuer", issuer)?;
        checks::check_line("subject", subject)?;
        let values =
            args![issuer: issuer, subject: subject, user_name: user, created_us: self.0.now_us()];
        let put: Option<IdentityRow> = tx.fetch_optional(PUT, values).await?;
        match put {
            Some(_) => Ok(()),
            None => Err(StoreError::conflict(
                "identity",
                subject,
                "is linked with another user already",
            )),
        }
    }

    /// Marks a sign-in as used; a second use is refused.
    async fn mark_used(&self, tx: &mut AuditedTransaction, sign_in: SignIn<'_>) -> Result<()> {
        checks::check_sha256("sha256", sign_in.sha256)?;
        // Expired sign-ins are refused by their age; their marks are no longer needed.
        tx.execute(PURGE, args![expires_us: self.0.now_us()]).await?;
        let values = args![sha256: sign_in.sha256, expires_us: sign_in.expires_us];
        match tx.execute(SPEND, values).await? {
            0 => Err(StoreError::conflict("sign-in", sign_in.subject, "has ended already")),
            _ => Ok(()),
        }
    }
}
