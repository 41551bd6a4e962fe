//! Seals of rows: the audit entry of a change states the SHA-256 of the protected columns of its
//! subject after the change. As the entries form a hash chain, a row that is changed without an
//! entry, in the database, no longer has its seal.
//!
//! Protected are users with their passwords, roles and identities, service keys with their roles,
//! ships, trials, laws, families, webhooks and settings. Versions and objects have hashes of their
//! own, aliases a history.

use serde_json::json;

use crate::arguments::args;
use crate::connections::DatabaseTransaction;
use crate::error::Result;
use crate::objects::sha256_hex;
use crate::record::record;
use crate::statements::{Statement, same, statements};

/// One kind of subject.
pub(crate) struct SealedKind {
    /// Beginning of the subjects of its audit entries; the rest is the name of the row.
    pub(crate) prefix: &'static str,
    /// Protected columns of the rows of a name, as [`ProtectedRow`].
    pub(crate) rows: Statement,
    /// Names after another one, in order.
    pub(crate) names: Statement,
}

/// Selects protected columns as text under the names that [`ProtectedRow`] has.
macro_rules! protected {
    ($part:literal, $($column:literal),*; $rest:literal) => {
        protected!(@ $part, [$($column),*, "NULL", "NULL", "NULL", "NULL", "NULL", "NULL"], $rest)
    };
    (@ $part:literal, [$a:literal, $b:literal, $c:literal, $d:literal, $e:literal, $f:literal
        $(, $more:literal)*], $rest:literal) => {
        concat!("SELECT '", $part, "' AS part, CAST(", $a, " AS TEXT) AS a, CAST(", $b,
            " AS TEXT) AS b, CAST(", $c, " AS TEXT) AS c, CAST(", $d, " AS TEXT) AS d, CAST(", $e,
            " AS TEXT) AS e, CAST(", $f, " AS TEXT) AS f ", $rest)
    };
}

statements! {
    USER = same(concat!(
        protected!("user", "title", "password_hash", "created_us", "disabled_us";
            "FROM users WHERE name = $1 UNION ALL "),
        protected!("role", "scope_kind", "scope_name", "role";
            "FROM grants WHERE principal = 'user:' || CAST($1 AS TEXT) UNION ALL "),
        protected!("identity", "issuer", "subject"; "FROM identities WHERE user_name = $1")));
    KEY = same(concat!(
        protected!("key", "title", "user_name", "sha256", "created_us", "expires_us", "revoked_us";
            "FROM service_keys WHERE prefix = $1 UNION ALL "),
        protected!("role", "scope_kind", "scope_name", "role";
            "FROM grants WHERE principal = 'key:' || CAST($1 AS TEXT)")));
    SHIP = same(protected!("ship", "title", "category", "document", "revision", "deleted_us";
        "FROM ships WHERE name = $1"));
    TRIAL = same(concat!(
        protected!("trial", "ship", "sha256", "name", "object_key", "manoeuvre", "deleted_us";
            "FROM trials WHERE id = $1 UNION ALL "),
        protected!("texts", "manifest", "conventions", "warnings", "sample_rows", "duration_s";
            "FROM trials WHERE id = $1")));
    LAW = same(protected!("law", "document", "sha256"; "FROM laws WHERE name = $1"));
    FAMILY = same(protected!("family", "title", "foundation"; "FROM families WHERE name = $1"));
    WEBHOOK = same(concat!(
        protected!("webhook", "title", "url", "secret", "ship", "drift_above", "ended_us";
            "FROM webhooks WHERE id = $1 UNION ALL "),
        protected!("event", "event"; "FROM webhook_events WHERE webhook = $1")));
    SETTINGS = same(protected!("setting", "name", "value";
        "FROM settings WHERE CAST($1 AS TEXT) = ''"));
    USERS = same("SELECT name FROM users WHERE name > $1 ORDER BY name LIMIT 500");
    KEYS = same("SELECT prefix AS name FROM service_keys WHERE prefix > $1 ORDER BY prefix LIMIT 500");
    SHIPS = same("SELECT name FROM ships WHERE name > $1 ORDER BY name LIMIT 500");
    TRIALS = same("SELECT id AS name FROM trials WHERE id > $1 ORDER BY id LIMIT 500");
    LAWS = same("SELECT name FROM laws WHERE name > $1 ORDER BY name LIMIT 500");
    FAMILIES = same("SELECT name FROM families WHERE name > $1 ORDER BY name LIMIT 500");
    WEBHOOKS = same("SELECT id AS name FROM webhooks WHERE id > $1 ORDER BY id LIMIT 500");
    // The settings are one subject without a name of its own.
    NO_NAMES = same("SELECT '' AS name WHERE CAST($1 AS TEXT) IS NULL");
}

pub(crate) const KINDS: [SealedKind; 8] = [
    SealedKind { prefix: "user:", rows: USER, names: USERS },
    SealedKind { prefix: "key:", rows: KEY, names: KEYS },
    SealedKind { prefix: "ship:", rows: SHIP, names: SHIPS },
    SealedKind { prefix: "trial:", rows: TRIAL, names: TRIALS },
    SealedKind { prefix: "law:", rows: LAW, names: LAWS },
    SealedKind { prefix: "family:", rows: FAMILY, names: FAMILIES },
    SealedKind { prefix: "webhook:", rows: WEBHOOK, names: WEBHOOKS },
    SealedKind { prefix: "settings", rows: SETTINGS, names: NO_NAMES },
];

record! {
    /// Protected columns of a row, as text.
    pub struct ProtectedRow {
        /// Part of the subject that the row is.
        pub part: String,
        /// First column.
        pub a: Option<String>,
        /// Second column.
        pub b: Option<String>,
        /// Third column.
        pub c: Option<String>,
        /// Fourth column.
        pub d: Option<String>,
        /// Fifth column.
        pub e: Option<String>,
        /// Sixth column.
        pub f: Option<String>,
    }
}

/// Returns the kind of a subject, and the name of its row.
pub(crate) fn sealed_kind(subject: &str) -> Option<(&'static SealedKind, &str)> {
    KINDS.iter().find_map(|kind| subject.strip_prefix(kind.prefix).map(|name| (kind, name)))
}

/// Returns the seal of these rows; none without a row.
pub(crate) fn seal_rows(rows: Vec<ProtectedRow>) -> Option<String> {
    let columns = |row: ProtectedRow| json!([row.part, row.a, row.b, row.c, row.d, row.e, row.f]);
    let mut rows: Vec<String> = rows.into_iter().map(|row| columns(row).to_string()).collect();
    // The database returns them in any order.
    rows.sort_unstable();
    (!rows.is_empty()).then(|| sha256_hex(rows.join("\n").as_bytes()))
}

/// Returns the seal of a subject as the transaction sees it; none for subjects without protected
/// rows.
pub(crate) async fn seal_subject(
    tx: &mut DatabaseTransaction,
    subject: &str,
) -> Result<Option<String>> {
    let Some((kind, name)) = sealed_kind(subject) else { return Ok(None) };
    Ok(seal_rows(tx.fetch_all(kind.rows, args![name: name]).await?))
}
