//! What is damaged is named: rows, objects, sources.

use serde_json::json;
use sistership_identification::refine::RefinementSettings;
use sistership_store::testing::TestDatabase;
use sistership_store::{AuditHead, ExpectedRevision, sha256_hex};

use super::{Place, archive, databases, found, places};
use crate::aliases::server_move;
use crate::upkeep::check_against_head;

#[tokio::test(flavor = "multi_thread")]
async fn a_healthy_archive_is_clean() {
    for Place { archive, .. } in &places().await {
        let findings = found(archive).await;
        assert!(findings.clean && findings.faults.is_empty(), "{findings:#?}");
        assert_eq!(
            (findings.checked.trials, findings.checked.objects, findings.unreferred.objects),
            (1, 1, 0)
        );
        assert!(
            findings.checked.laws > 3
                && findings.checked.audit > 20
                && findings.checked.effects > 0
                && findings.checked.versions > 5,
            "{:?}",
            findings.checked
        );
    }
}

/// Each kind of damage to rows: what is done, and the check and the place that must tell of it.
const DAMAGES: &[(&str, &str, &str)] = &[
    ("DELETE FROM ships WHERE name = 'mariner'", "trial-ship", "trial "),
    ("DELETE FROM ships WHERE name = 'mariner'", "revision-ship", "ship mariner revision 1"),
    ("UPDATE ships SET title = 'Another' WHERE name = 'mariner'", "revision-last", "ship mariner"),
    ("UPDATE ships SET revision = 2 WHERE name = 'mariner'", "revision-last", "ship mariner"),
    (
        "UPDATE ship_revisions SET revision = 2 WHERE ship = 'mariner'",
        "revision-gap",
        "ship mariner",
    ),
    (
        "UPDATE ship_revisions SET document = '{}' WHERE ship = 'mariner'",
        "version-ship",
        "version mariner/1",
    ),
    ("UPDATE trials SET sha256 = 'x'", "trial-key", "trial "),
    ("UPDATE trials SET object_key = '00'", "trial-key", "trial "),
    (
        "UPDATE laws SET document = document || ' ' WHERE name = 'abkowitz'",
        "law-hash",
        "law abkowitz",
    ),
    ("UPDATE laws SET sha256 = 'x' WHERE name = 'abkowitz'", "law-hash", "law abkowitz"),
    (
        "UPDATE effect_libraries SET document = document || ' '",
        "effects-hash",
        "library of effects ",
    ),
    ("DELETE FROM laws WHERE name = 'abkowitz'", "version-law", "version "),
    (
        "UPDATE versions SET document = document || ' ' WHERE model = 'mariner'",
        "version-hash",
        "version mariner/1",
    ),
    (
        "UPDATE versions SET document = '{}' WHERE model = 'mariner'",
        "version-document",
        "version mariner/1",
    ),
    (
        "UPDATE versions SET parent = 'none' WHERE model = 'mariner'",
        "version-parent",
        "version mariner/1",
    ),
    ("DELETE FROM models WHERE name = 'mariner'", "version-model", "version mariner/1"),
    ("UPDATE models SET next_number = 9 WHERE name = 'mariner'", "version-gap", "model mariner"),
    ("DELETE FROM versions WHERE model = 'mariner'", "version-gap", "model mariner"),
    ("DELETE FROM versions WHERE model = 'mariner'", "alias-version", "alias mariner/champion"),
    (
        "DELETE FROM versions WHERE model = 'mariner'",
        "move-version",
        "alias mariner/champion revision 1",
    ),
    (
        "UPDATE aliases SET revision = 7 WHERE model = 'mariner'",
        "alias-last",
        "alias mariner/champion",
    ),
    (
        "UPDATE alias_moves SET from_number = 4 WHERE model = 'mariner'",
        "move-chain",
        "alias mariner/champion revision 1",
    ),
    ("DELETE FROM aliases WHERE model = 'mariner'", "move-alias", "alias mariner/champion"),
    (REPORT, "report-ship", "report r"),
    (REPORT, "report-version", "report r"),
    (DIAGNOSIS, "diagnosis-version", "diagnosis d"),
    (DIAGNOSIS, "diagnosis-made", "diagnosis d"),
    (DIAGNOSIS, "diagnosis-report", "diagnosis d"),
    (DIAGNOSIS, "diagnosis-trials", "diagnosis d"),
    (FAMILY, "family-foundation", "family f"),
    (MEMBER, "member-ship", "family f"),
    (PRIOR, "prior-gap", "family f"),
    (BULK, "outcome-count", "bulk refinement b"),
    (CHUNK, "chunk-job", "bulk refinement b"),
    (OUTCOME, "outcome-version", "bulk refinement b"),
    (TAG, "tag-ship", "tag nobody/own"),
    (TEMPLATE, "template-ship", "template nobody/yard"),
    ("DELETE FROM ship_vectors; DELETE FROM search_queue", "search-ship", "ship mariner"),
    (FACT, "search-fact", "ship nobody"),
    (GRANT, "grant-principal", "roles of user:nobody"),
    (GRANT, "grant-scope", "roles of user:nobody"),
    (KEY, "key-user", "key 0123456789ab"),
    (SESSION, "session-user", "sessions of nobody"),
    (IDENTITY, "identity-user", "identity 7-of-9"),
    (WEBHOOK, "webhook-ship", "webhook w"),
    (LISTENER, "webhook-event", "webhook nowhere"),
    (DELIVERY, "delivery-webhook", "delivery d"),
    ("UPDATE audit SET actor = 'bob' WHERE number = 2", "audit-chain", "audit entry 2"),
    ("DELETE FROM audit WHERE number = 2", "audit-chain", "audit entry 3"),
    (CUT, "audit-chain", "audit entry "),
    ("UPDATE grants SET role = 'admin' WHERE principal = 'user:ann'", "audit-row", "user:ann"),
    ("UPDATE grants SET scope_kind = 'server', scope_name = ''", "audit-row", "user:ann"),
    ("DELETE FROM grants", "audit-row", "user:ann"),
    ("UPDATE users SET password_hash = 'other' WHERE name = 'ann'", "audit-row", "user:ann"),
    ("INSERT INTO users VALUES ('eve', 'Eve', NULL, 0, NULL)", "audit-row", "user:eve"),
    ("DELETE FROM users WHERE name = 'ann'", "audit-row", "user:ann"),
    (KEY, "audit-row", "key:0123456789ab"),
    ("UPDATE trials SET name = 'another.csv'", "audit-row", "trial:"),
    ("UPDATE trials SET deleted_us = 1", "audit-row", "trial:"),
    ("INSERT INTO settings VALUES ('second_person', 'off', 0)", "audit-row", "settings"),
    (JOB, "job-ship", "job j"),
    (JOB, "job-state", "job j"),
    (JOB, "job-result", "job j"),
];
const REPORT: &str =
    "INSERT INTO reports VALUES ('r', 'none', 'nobody', 'refinement', '{}', '', 0)";
const DIAGNOSIS: &str = "INSERT INTO diagnoses VALUES ('d', 'none', 'none', 'none', 'effects', '[]', '[\"none\"]', 0, \
     '[]', NULL)";
const FAMILY: &str = "INSERT INTO families VALUES ('f', 'F', 'none', 0)";
const MEMBER: &str = "INSERT INTO family_members VALUES ('f', 'nobody', 0)";
const PRIOR: &str = "INSERT INTO family_priors VALUES ('f', 2, '{}', 'x', 0)";
const BULK: &str = "INSERT INTO bulk_refinements VALUES ('b', 'f', '{}', 1, 0)";
const CHUNK: &str = "INSERT INTO bulk_chunks VALUES ('b', 1, 'none')";
const OUTCOME: &str =
    "INSERT INTO bulk_outcomes VALUES ('b', 'mariner', 'champion', NULL, NULL, '{}', 0)";
const TAG: &str = "INSERT INTO ship_tags VALUES ('nobody', 'own')";
const TEMPLATE: &str = "INSERT INTO import_templates VALUES ('nobody', 'yard', '{}', 0)";
const GRANT: &str = "INSERT INTO grants VALUES ('user:nobody', 'ship', 'none', 'reader')";
const KEY: &str =
    "INSERT INTO service_keys VALUES ('0123456789ab', 'K', 'nobody', 'x', 0, NULL, NULL, NULL)";
const SESSION: &str = "INSERT INTO sessions VALUES ('x', 'nobody', 0, 0)";
const IDENTITY: &str =
    "INSERT INTO identities VALUES ('https://id.example', '7-of-9', 'nobody', 0)";
const WEBHOOK: &str =
    "INSERT INTO webhooks VALUES ('w', 'W', 'https://example.com', 'x', 'nobody', 2, 0, NULL)";
const LISTENER: &str = "INSERT INTO webhook_events VALUES ('drift', 'nowhere')";
const DELIVERY: &str =
    "INSERT INTO deliveries VALUES ('d', 'nowhere', 'drift', '{}', 0, 0, NULL, NULL, NULL)";
const CUT: &str = "DELETE FROM audit WHERE number = (SELECT MAX(number) FROM audit)";
const FACT: &str = "INSERT INTO ship_facts VALUES ('nobody', 'particular lpp_m', 1)";
const JOB: &str = "INSERT INTO jobs VALUES ('j', 'refinement', 'nobody', '{}', 'succeeded', 1, '', \
    '{\"model\": \"mariner\", \"version\": 1, \"sha256\": \"x\", \"report\": \"none\"}', NULL, 1, \
    1, 5, NULL, 0, 0, NULL, 0, 0, 'ann', 0, NULL)";

/// The last entry and the head are cut, so that the chain itself is whole.
#[tokio::test(flavor = "multi_thread")]
async fn a_tail_cut_with_its_head_is_found_by_a_head_kept_elsewhere() {
    for database in databases().await {
        let archive = archive(&database).await;
        let kept = archive.store.audit().chain_head().await.unwrap();
        let against = async |kept| check_against_head(&archive, Some(kept)).await.unwrap();
        assert!(against(&kept).await.clean);
        archive.store.users().disable("ann").await.unwrap();
        assert!(against(&kept).await.clean, "entries were added");
        let other = AuditHead { sha256: "x".into(), ..kept.clone() };
        assert_eq!(against(&other).await.faults[0].check, "audit-head");
        for _ in 0..2 {
            database.execute_unchecked(CUT).await;
        }
        let cut = "UPDATE audit_head SET number = (SELECT MAX(number) FROM audit), sha256 = \
            (SELECT sha256 FROM audit ORDER BY number DESC LIMIT 1)";
        database.execute_unchecked(cut).await;
        let faults = against(&kept).await.faults;
        assert!(faults.iter().any(|fault| fault.check == "audit-head"), "{faults:#?}");
        assert!(faults.iter().all(|fault| fault.check != "audit-chain"), "{faults:#?}");
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn each_damage_to_rows_is_named_on_sqlite() {
    damaged(TestDatabase::new_sqlite()).await;
}

#[tokio::test(flavor = "multi_thread")]
async fn each_damage_to_rows_is_named_on_postgres() {
    if let Some(database) = TestDatabase::new_postgres().await {
        damaged(database).await;
    }
}

/// One healthy archive, restored row by row after each damage by a copy of every table.
async fn damaged(database: TestDatabase) {
    let archive = archive(&database).await;
    for table in TABLES {
        database
            .execute_unchecked(&format!("CREATE TABLE healthy_{table} AS SELECT * FROM {table}"))
            .await;
    }
    for (sql, check, place) in DAMAGES {
        database.execute_unchecked(sql).await;
        let findings = found(&archive).await;
        let hit = findings
            .faults
            .iter()
            .any(|fault| fault.check == *check && fault.place.starts_with(place));
        assert!(
            hit && !findings.clean,
            "`{sql}` must be told by `{check}` at `{place}`: {findings:#?}"
        );
        for table in TABLES {
            database.execute_unchecked(&format!("DELETE FROM {table}")).await;
            database
                .execute_unchecked(&format!("INSERT INTO {table} SELECT * FROM healthy_{table}"))
                .await;
        }
    }
    assert!(found(&archive).await.clean, "healed again");
}

const TABLES: [&str; 34] = [
    "settings",
    "laws",
    "effect_libraries",
    "ships",
    "ship_revisions",
    "trials",
    "models",
    "versions",
    "aliases",
    "alias_moves",
    "jobs",
    "reports",
    "diagnoses",
    "families",
    "family_members",
    "family_priors",
    "bulk_refinements",
    "bulk_chunks",
    "bulk_outcomes",
    "ship_facts",
    "ship_vectors",
    "ship_tags",
    "import_templates",
    "search_queue",
    "users",
    "grants",
    "service_keys",
    "sessions",
    "identities",
    "webhooks",
    "webhook_events",
    "deliveries",
    "audit",
    "audit_head",
];

#[tokio::test(flavor = "multi_thread")]
async fn each_damage_to_objects_is_named() {
    let database = TestDatabase::new_sqlite();
    let archive = archive(&database).await;
    let key = sha256_hex(b"samples");
    let file = database.folder.path().join("objects").join(&key[..2]).join(&key[2..]);
    std::fs::write(&file, b"sample5").unwrap();
    let findings = found(&archive).await;
    assert_eq!(
        (findings.faults[0].check, &findings.faults[0].place),
        ("object-hash", &format!("object {key}"))
    );
    std::fs::remove_file(&file).unwrap();
    let findings = found(&archive).await;
    assert!(
        findings.faults.len() == 1 && findings.faults[0].check == "trial-object",
        "{findings:#?}"
    );
    std::fs::write(database.folder.path().join("objects/notes.txt"), b"?").unwrap();
    assert!(found(&archive).await.faults.iter().any(|fault| fault.check == "object-name"));
}

#[tokio::test(flavor = "multi_thread")]
async fn a_source_that_has_changed_is_named() {
    let database = TestDatabase::new_sqlite();
    let archive = archive(&database).await;
    let mariner = archive.store.versions().get("mariner", 1).await.unwrap();
    let mut document: serde_json::Value = serde_json::from_str(&mariner.document).unwrap();
    let recipe = &document["recipe"];
    document["recipe"] = json!({ "kind": "refinement",
        "source": { "ship": "mariner", "number": 1, "sha256": "00" },
        "ship_sha256": recipe["ship_sha256"], "law_sha256": recipe["law_sha256"],
        "trials": [{ "name": "gone.csv", "sha256": sha256_hex(b"gone") }],
        "settings": RefinementSettings::default(),
        "effects_sha256": crate::library::embedded_library().unwrap().sha256,
        "code_revision": "1" });
    let new = sistership_store::NewVersion {
        model: "mariner".into(),
        parent: None,
        law: mariner.head.law,
        method: "published".into(),
        document: document.to_string(),
        weights: None,
    };
    archive
        .store
        .versions()
        .create(&new, &[server_move("candidate", ExpectedRevision::Any, "a test")])
        .await
        .unwrap();
    let checks: Vec<_> =
        found(&archive).await.faults.into_iter().map(|fault| (fault.check, fault.place)).collect();
    assert_eq!(
        checks,
        [
            ("version-source", "version mariner/2".into()),
            ("version-trial", "version mariner/2".into())
        ]
    );
}
