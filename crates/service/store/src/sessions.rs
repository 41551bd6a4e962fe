//! Sessions of browsers. A browser holds a secret; only its hash is stored.

use crate::arguments::args;
use crate::checks;
use crate::database::AuditedTransaction;
use crate::error::Result;
use crate::record::record;
use crate::statements::{same, statements};
use crate::store::Store;
use crate::users::User;

statements! {
    INSERT = same("INSERT INTO sessions (sha256, user_name, created_us, expires_us) VALUES ($1, \
        $2, $3, $4) RETURNING sha256, user_name, created_us, expires_us");
    GET = same("SELECT sha256, user_name, created_us, expires_us FROM sessions WHERE sha256 = $1");
    END = same("DELETE FROM sessions WHERE sha256 = $1 RETURNING sha256, user_name, created_us, \
        expires_us");
    PURGE = same("DELETE FROM sessions WHERE expires_us < $1");
}

record! {
    /// A session of a signed-in browser.
    pub struct Session {
        /// Hash of the secret of the session.
        pub sha256: String,
        /// Name of the user.
        pub user_name: String,
        /// Start, microseconds since 1970.
        pub created_us: i64,
        /// Expiry, microseconds since 1970.
        pub expires_us: i64,
    }
}

/// Repository of sessions.
#[derive(Debug, Clone, Copy)]
pub struct SessionRepository<'a>(pub(crate) &'a Store);

impl Store {
    /// Returns the repository of sessions.
    pub fn sessions(&self) -> SessionRepository<'_> {
        SessionRepository(self)
    }
}

impl SessionRepository<'_> {
    /// Begins a session of a user, and removes expired ones.
    pub async fn begin_session(
        &self,
        sha256: &str,
        user: &str,
        expires_us: i64,
    ) -> Result<Session> {
        let now = self.0.now_us();
        let mut tx = self.0.begin().await?;
        let session = insert_session(&mut tx, sha256, user, now, expires_us).await?;
        tx.record_audit_event(now, "session.begin", User::principal_name(user), None, None);
        tx.commit().await?;
        Ok(session)
    }

    /// Finds a session that has not expired, by the hash of its secret.
    pub async fn find(&self, sha256: &str) -> Result<Option<Session>> {
        let found: Option<Session> =
            self.0.database().fetch_optional(GET, args![sha256: sha256]).await?;
        // Expired sessions stay until the next one begins; they must not be found.
        Ok(found.filter(|session| self.0.now_us() < session.expires_us))
    }

    /// Ends a session; does nothing if it has ended.
    pub async fn end_session(&self, sha256: &str) -> Result<()> {
        let mut tx = self.0.begin().await?;
        let ended: Option<Session> = tx.fetch_optional(END, args![sha256: sha256]).await?;
        if let Some(session) = ended {
            tx.record_audit_event(
                self.0.now_us(),
                "session.end",
                User::principal_name(&session.user_name),
                None,
                None,
            );
        }
        tx.commit().await
    }
}

/// Begins a session within a transaction, and removes expired ones.
pub(crate) async fn insert_session(
    tx: &mut AuditedTransaction,
    sha256: &str,
    user: &str,
    now_us: i64,
    expires_us: i64,
) -> Result<Session> {
    checks::check_sha256("sha256", sha256)?;
    tx.execute(PURGE, args![expires_us: now_us]).await?;
    let values = args![sha256: sha256, user_name: user, created_us: now_us, expires_us: expires_us];
    tx.fetch_one(INSERT, values).await
}
