//! Integrity checks of the rows of a store, run by the database. Each check is one statement, so
//! that its result refers to one moment, also while others write.

use serde::Serialize;

use crate::error::Result;
use crate::record::record;
use crate::statements::{Statement, pair, same, statements};
use crate::store::Store;

statements! {
    // PostgreSQL verifies its pages by itself where the cluster has checksums; it has no statement
    // for it.
    DATABASE = pair(
        "SELECT 'database' AS place, integrity_check AS message FROM pragma_integrity_check WHERE \
         integrity_check <> 'ok'",
        "SELECT 'database' AS place, '' AS message WHERE FALSE",
    );
    REVISION_SHIP = same("SELECT 'ship ' || ship || ' revision ' || revision AS place, 'there is \
        no such ship' AS message FROM ship_revisions WHERE ship NOT IN (SELECT name FROM ships) \
        ORDER BY ship, revision");
    REVISION_LAST = same("SELECT 'ship ' || s.name AS place, 'is not what its history has at \
        revision ' || s.revision AS message FROM ships s WHERE NOT EXISTS (SELECT 1 FROM \
        ship_revisions r WHERE r.ship = s.name AND r.revision = s.revision AND r.title = s.title \
        AND r.category = s.category AND r.document = s.document) ORDER BY s.name");
    // Numbers that start at 1 have no gap if and only if the count equals the maximum.
    REVISION_GAP = same("SELECT 'ship ' || ship AS place, \
        'has ' || COUNT(*) || ' revisions up to number ' || MAX(revision) AS message \
        FROM ship_revisions GROUP BY ship HAVING COUNT(*) <> MAX(revision) ORDER BY ship");
    TRIAL_SHIP = same("SELECT 'trial ' || id AS place, 'there is no ship ' || ship AS message FROM \
        trials WHERE ship NOT IN (SELECT name FROM ships) ORDER BY id");
    TRIAL_KEY = same("SELECT 'trial ' || id AS place, \
        'its samples have the hash ' || sha256 || ', but it refers to the object ' || object_key \
        AS message FROM trials WHERE sha256 <> object_key ORDER BY id");
    VERSION_MODEL = same("SELECT 'version ' || model || '/' || number AS place, 'there is no such \
        model' AS message FROM versions WHERE model NOT IN (SELECT name FROM models) ORDER BY \
        model, number");
    VERSION_PARENT = same("SELECT 'version ' || model || '/' || number AS place, 'its parent ' || \
        parent || ' is missing' AS message FROM versions WHERE parent IS NOT NULL AND parent NOT \
        IN (SELECT id FROM versions) ORDER BY model, number");
    VERSION_GAP = same("SELECT 'model ' || m.name AS place, 'its next version is number ' || \
        m.next_number || ', but it has ' || COUNT(v.number) || ' versions up to number ' || \
        COALESCE(MAX(v.number), 0) AS message FROM models m LEFT JOIN versions v ON v.model = \
        m.name GROUP BY m.name, m.next_number HAVING COUNT(v.number) <> m.next_number - 1 OR \
        COALESCE(MAX(v.number), 0) <> m.next_number - 1 ORDER BY m.name");
    ALIAS_VERSION = same("SELECT 'alias ' || a.model || '/' || a.alias AS place, \
        'there is no version ' || a.version_number AS message FROM aliases a WHERE NOT EXISTS \
        (SELECT 1 FROM versions v WHERE v.model = a.model AND v.number = a.version_number) ORDER \
        BY a.model, a.alias");
    ALIAS_LAST = same("SELECT 'alias ' || a.model || '/' || a.alias AS place, \
        'is not where its history has it at revision ' || a.revision AS message FROM aliases a \
        WHERE NOT EXISTS (SELECT 1 FROM alias_moves m WHERE m.model = a.model AND m.alias = \
        a.alias AND m.revision = a.revision AND m.to_number = a.version_number) ORDER BY a.model, \
        a.alias");
    MOVE_VERSION = same("SELECT 'alias ' || m.model || '/' || m.alias || ' revision ' || \
        m.revision AS place, 'there is no version ' || m.to_number AS message FROM alias_moves m \
        WHERE NOT EXISTS (SELECT 1 FROM versions v WHERE v.model = m.model AND v.number = \
        m.to_number) ORDER BY m.model, m.alias, m.revision");
    // LAG gives the target of the previous move: each move must start where the one before ended.
    MOVE_CHAIN = same("SELECT 'alias ' || model || '/' || alias || ' revision ' || revision AS \
        place, 'its history does not join on to the move before it' AS message FROM (SELECT model, \
        alias, revision, from_number, LAG(to_number) OVER (PARTITION BY model, alias ORDER BY \
        revision) AS came_from, ROW_NUMBER() OVER (PARTITION BY model, alias ORDER BY revision) AS \
        expected FROM alias_moves) AS moves WHERE COALESCE(from_number, 0) <> COALESCE(came_from, \
        0) OR revision <> expected ORDER BY model, alias, revision");
    MOVE_ALIAS = same("SELECT DISTINCT 'alias ' || m.model || '/' || m.alias AS place, \
        'has a history but stands nowhere' AS message FROM alias_moves m WHERE NOT EXISTS \
        (SELECT 1 FROM aliases a WHERE a.model = m.model AND a.alias = m.alias) ORDER BY 1");
    REPORT_SHIP = same("SELECT 'report ' || id AS place, 'there is no ship ' || ship AS message \
        FROM reports WHERE ship NOT IN (SELECT name FROM ships) ORDER BY id");
    REPORT_VERSION = same("SELECT 'report ' || id AS place, 'its version ' || version_id || ' is \
        missing' AS message FROM reports WHERE version_id IS NOT NULL AND version_id NOT IN \
        (SELECT id FROM versions) ORDER BY id");
    DIAGNOSIS_VERSION = same("SELECT 'diagnosis ' || id AS place, 'the version ' || version_id || \
        ' diagnosed is missing' AS message FROM diagnoses WHERE version_id NOT IN (SELECT id FROM \
        versions) ORDER BY id");
    DIAGNOSIS_MADE = same("SELECT 'diagnosis ' || id AS place, 'the version ' || made_id || ' that \
        came of it is missing' AS message FROM diagnoses WHERE made_id IS NOT NULL AND made_id NOT \
        IN (SELECT id FROM versions) ORDER BY id");
    DIAGNOSIS_REPORT = same("SELECT 'diagnosis ' || id AS place, 'its report ' || report_id || ' \
        is missing' AS message FROM diagnoses WHERE report_id NOT IN (SELECT id FROM reports) \
        ORDER BY id");
    FAMILY_FOUNDATION = same("SELECT 'family ' || name AS place, 'its foundation ' || foundation \
        || ' is missing' AS message FROM families WHERE foundation NOT IN (SELECT id FROM \
        versions) ORDER BY name");
    MEMBER_SHIP = same("SELECT 'family ' || family AS place, 'there is no ship ' || ship AS \
        message FROM family_members WHERE ship NOT IN (SELECT name FROM ships) ORDER BY family, \
        ship");
    PRIOR_GAP = same("SELECT 'family ' || family AS place, \
        'has ' || COUNT(*) || ' priors up to revision ' || MAX(revision) AS message \
        FROM family_priors GROUP BY family HAVING COUNT(*) <> MAX(revision) ORDER BY family");
    CHUNK_JOB = same("SELECT 'bulk refinement ' || bulk AS place, 'the job of its chunk ' || \
        number || ' is missing' AS message FROM bulk_chunks WHERE job NOT IN (SELECT id FROM jobs) \
        ORDER BY bulk, number");
    // A version exists for the outcomes `champion` and `candidate`, and for no other.
    OUTCOME_VERSION = same("SELECT 'bulk refinement ' || bulk AS place, \
        'its outcome of ' || ship || ', ' || outcome || ', has not the version that it should \
        have' AS message FROM bulk_outcomes WHERE (outcome IN ('champion', 'candidate')) <> \
        (version_id IS NOT NULL) OR (version_id IS NOT NULL AND version_id NOT IN (SELECT id FROM \
        versions)) ORDER BY bulk, ship");
    OUTCOME_COUNT = same("SELECT 'bulk refinement ' || b.id AS place, \
        'all chunks are done, but ' || COUNT(o.ship) || ' of ' || b.ships || ' ships have an \
        outcome' AS message FROM bulk_refinements b LEFT JOIN bulk_outcomes o ON o.bulk = b.id \
        WHERE NOT EXISTS (SELECT 1 FROM bulk_chunks c JOIN jobs j ON j.id = c.job WHERE c.bulk = \
        b.id AND j.state <> 'succeeded') GROUP BY b.id, b.ships HAVING COUNT(o.ship) <> b.ships \
        ORDER BY b.id");
    TAG_SHIP = same("SELECT 'tag ' || ship || '/' || tag AS place, 'there is no such ship' AS \
        message FROM ship_tags WHERE ship NOT IN (SELECT name FROM ships) ORDER BY ship, tag");
    TEMPLATE_SHIP = same("SELECT 'template ' || ship || '/' || name AS place, 'there is no such \
        ship' AS message FROM import_templates WHERE ship <> '' AND ship NOT IN (SELECT name FROM \
        ships) ORDER BY ship, name");
    // A ship is in the index, or in the queue of ships to be indexed.
    SEARCH_SHIP = same("SELECT 'ship ' || name AS place, 'is neither found by a search nor waits \
        to be' AS message FROM ships WHERE name NOT IN (SELECT ship FROM ship_vectors) AND name \
        NOT IN (SELECT ship FROM search_queue) ORDER BY name");
    SEARCH_FACT = same("SELECT DISTINCT 'ship ' || ship AS place, 'has facts, but is not there' AS \
        message FROM ship_facts WHERE ship NOT IN (SELECT name FROM ships) ORDER BY 1");
    GRANT_PRINCIPAL = same("SELECT DISTINCT 'roles of ' || principal AS place, 'there is no such \
        user or key' AS message FROM grants WHERE principal NOT IN (SELECT 'user:' || name FROM \
        users) AND principal NOT IN (SELECT 'key:' || prefix FROM service_keys) ORDER BY 1");
    GRANT_SCOPE = same("SELECT 'roles of ' || principal AS place, 'there is no ' || scope_kind || \
        ' ' || scope_name AS message FROM grants WHERE (scope_kind = 'ship' AND scope_name NOT IN \
        (SELECT name FROM ships)) OR (scope_kind = 'family' AND scope_name NOT IN (SELECT name \
        FROM families)) ORDER BY principal, scope_kind, scope_name");
    KEY_USER = same("SELECT 'key ' || prefix AS place, 'there is no user ' || user_name AS message \
        FROM service_keys WHERE user_name IS NOT NULL AND user_name NOT IN (SELECT name FROM \
        users) ORDER BY prefix");
    SESSION_USER = same("SELECT 'sessions of ' || user_name AS place, 'there is no such user' AS \
        message FROM sessions WHERE user_name NOT IN (SELECT name FROM users) ORDER BY user_name");
    IDENTITY_USER = same("SELECT 'identity ' || subject AS place, 'there is no user ' || user_name \
        AS message FROM identities WHERE user_name NOT IN (SELECT name FROM users) ORDER BY \
        issuer, subject");
    WEBHOOK_SHIP = same("SELECT 'webhook ' || id AS place, 'there is no ship ' || ship AS message \
        FROM webhooks WHERE ship IS NOT NULL AND ship NOT IN (SELECT name FROM ships) ORDER BY id");
    WEBHOOK_EVENT = same("SELECT 'webhook ' || webhook AS place, 'is told of ' || event || ', but \
        is not there' AS message FROM webhook_events WHERE webhook NOT IN (SELECT id FROM \
        webhooks) ORDER BY webhook, event");
    DELIVERY_WEBHOOK = same("SELECT 'delivery ' || id AS place, 'there is no webhook ' || webhook \
        AS message FROM deliveries WHERE webhook NOT IN (SELECT id FROM webhooks) ORDER BY id");
    JOB_SHIP = same("SELECT 'job ' || id AS place, 'there is no ship ' || ship AS message FROM \
        jobs WHERE ship IS NOT NULL AND ship NOT IN (SELECT name FROM ships) ORDER BY id");
    // The columns that each state requires or excludes.
    JOB_STATE = same("SELECT 'job ' || id AS place, 'is ' || state || ', which its lease, result, \
        error or end contradicts' AS message FROM jobs WHERE (state = 'running') <> \
        (lease_until_us IS NOT NULL) OR (state = 'succeeded') <> (result IS NOT NULL) OR (state = \
        'failed' AND error IS NULL) OR (state IN ('queued', 'running')) <> (finished_us IS NULL) \
        ORDER BY id");
}

/// All checks, by the name that their faults bear.
const CHECKS: &[(&str, Statement)] = &[
    ("database", DATABASE),
    ("revision-ship", REVISION_SHIP),
    ("revision-last", REVISION_LAST),
    ("revision-gap", REVISION_GAP),
    ("trial-ship", TRIAL_SHIP),
    ("trial-key", TRIAL_KEY),
    ("version-model", VERSION_MODEL),
    ("version-parent", VERSION_PARENT),
    ("version-gap", VERSION_GAP),
    ("alias-version", ALIAS_VERSION),
    ("alias-last", ALIAS_LAST),
    ("move-version", MOVE_VERSION),
    ("move-chain", MOVE_CHAIN),
    ("move-alias", MOVE_ALIAS),
    ("report-ship", REPORT_SHIP),
    ("report-version", REPORT_VERSION),
    ("diagnosis-version", DIAGNOSIS_VERSION),
    ("diagnosis-made", DIAGNOSIS_MADE),
    ("diagnosis-report", DIAGNOSIS_REPORT),
    ("family-foundation", FAMILY_FOUNDATION),
    ("member-ship", MEMBER_SHIP),
    ("prior-gap", PRIOR_GAP),
    ("chunk-job", CHUNK_JOB),
    ("outcome-version", OUTCOME_VERSION),
    ("outcome-count", OUTCOME_COUNT),
    ("tag-ship", TAG_SHIP),
    ("template-ship", TEMPLATE_SHIP),
    ("search-ship", SEARCH_SHIP),
    ("search-fact", SEARCH_FACT),
    ("grant-principal", GRANT_PRINCIPAL),
    ("grant-scope", GRANT_SCOPE),
    ("key-user", KEY_USER),
    ("webhook-ship", WEBHOOK_SHIP),
    ("webhook-event", WEBHOOK_EVENT),
    ("delivery-webhook", DELIVERY_WEBHOOK),
    ("session-user", SESSION_USER),
    ("identity-user", IDENTITY_USER),
    ("job-ship", JOB_SHIP),
    ("job-state", JOB_STATE),
];

record! {
    /// A fault as a check returns it.
    pub struct FaultRow {
        /// Kind and name of the row.
        pub place: String,
        /// Description of the fault.
        pub message: String,
    }
}

/// A violation of the integrity of a store.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct IntegrityFault {
    /// Name of the check that found it.
    pub check: &'static str,
    /// Place of the fault: the kind of row and its name or id.
    pub place: String,
    /// Description of the fault.
    pub message: String,
}

impl IntegrityFault {
    /// Creates a fault that `check` has found at `place`.
    pub fn new(check: &'static str, place: impl Into<String>, message: impl Into<String>) -> Self {
        Self { check, place: place.into(), message: message.into() }
    }
}

impl Store {
    /// Checks the database and every reference between its rows; returns all faults.
    pub async fn row_faults(&self) -> Result<Vec<IntegrityFault>> {
        let (mut faults, mut reader) = (Vec::new(), self.database().acquire_reader().await?);
        for (check, statement) in CHECKS {
            let found: Vec<FaultRow> = reader.fetch_table(*statement, &[]).await?;
            faults.extend(
                found
                    .into_iter()
                    .map(|found| IntegrityFault::new(check, found.place, found.message)),
            );
        }
        Ok(faults)
    }
}
