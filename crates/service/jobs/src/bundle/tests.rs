//! A ship from one archive into another, of another kind of database.
#![allow(clippy::unwrap_used)]

use std::io::{Cursor, Read as _, Write as _};

use sistership_model::version::sha256_hex;
use sistership_store::testing::TestDatabase;
use sistership_store::{ExpectedRevision, NewReport, NewShip, NewTrial, NewVersion};

use super::{Bundle, BundleError, SigningKey, check_signer, collect_bundle, import_bundle};
use crate::aliases::{CHAMPION, server_move};
use crate::archive::Archive;
use crate::testing::{DEMO_SHIP, demo_rows};
use crate::verify::verify_version;

const SHIP: &str = DEMO_SHIP;

async fn opened(database: &TestDatabase) -> Archive {
    Archive::open(&database.url, database.folder.path()).await.unwrap()
}

/// An archive with three versions of a ship and what they were derived from, a parent, a trial, a
/// report and a champion among them.
async fn filled(database: &TestDatabase) -> Archive {
    let rows = demo_rows().await;
    let archive = rows.open_archive(database).await;
    for samples in &rows.samples {
        archive.store.trials().insert(&trial(&sha256_hex(samples))).await.unwrap();
    }
    let mut parent = None;
    for version in &rows.versions {
        let own = version.model == SHIP;
        let new = NewVersion { parent: parent.clone().filter(|_| own), ..version.clone() };
        let made = archive.store.versions().create(&new, &[]).await.unwrap();
        if own {
            let report = NewReport {
                version_id: Some(made.id.clone()),
                ship: SHIP.to_owned(),
                kind: "refinement".to_owned(),
                document: "{}".to_owned(),
                html: format!("<p>{}</p>", made.number),
            };
            archive.store.reports().insert(&report).await.unwrap();
            parent = Some(made.id);
        }
    }
    let champion = server_move(CHAMPION, ExpectedRevision::Absent, "test");
    archive.store.aliases().move_to(SHIP, 2, &champion).await.unwrap();
    archive
}

fn trial(key: &str) -> NewTrial {
    let text = |text: &str| text.to_owned();
    NewTrial {
        ship: text(SHIP),
        sha256: text(key),
        name: format!("{}.csv", &key[..6]),
        manifest: text("{}"),
        conventions: text("{}"),
        manoeuvre: Some(text("zigzag 20/20")),
        sample_rows: 10,
        duration_s: 1.0,
        warnings: text("[]"),
        object_key: text(key),
    }
}

/// SQLite into PostgreSQL, or into another SQLite where that is not installed.
async fn target() -> TestDatabase {
    TestDatabase::new_postgres().await.unwrap_or_else(TestDatabase::new_sqlite)
}

#[tokio::test(flavor = "multi_thread")]
async fn hashes_lineage_and_verification_are_kept() {
    let (from, to) = (TestDatabase::new_sqlite(), target().await);
    let (source, other) = (filled(&from).await, opened(&to).await);
    let bundle = collect_bundle(&source, SHIP).await.unwrap();
    let file = bundle.to_bytes(None).unwrap();
    assert_eq!(file, bundle.to_bytes(None).unwrap(), "the same bytes");
    let (read, signer) = Bundle::from_bytes(&file).unwrap();
    assert_eq!((&read, signer), (&bundle, None));
    let taken = import_bundle(&other, &read).await.unwrap();
    assert!(taken.ships.contains(&SHIP.to_owned()) && taken.versions.len() >= 3, "{taken:?}");
    assert!(taken.trials > 0 && taken.known == 0);
    for number in 1..=3 {
        let [here, there] = [&source, &other].map(|archive| archive.store.versions());
        let (here, there) =
            (here.get(SHIP, number).await.unwrap(), there.get(SHIP, number).await.unwrap());
        assert_eq!((&here.head.sha256, &here.document), (&there.head.sha256, &there.document));
        assert_eq!(
            parent(&source, here.head.parent).await,
            parent(&other, there.head.parent).await,
            "the parent of {number}"
        );
        let here = verify_version(&source, SHIP, number).await.unwrap().derived_sha256;
        let there = verify_version(&other, SHIP, number).await.unwrap().derived_sha256;
        assert_eq!(here, there, "the recipe of {number} gives the same in both");
    }
    let champion = other.store.versions().current_version(SHIP, CHAMPION).await.unwrap().unwrap();
    assert!(champion.report.is_some(), "the champion has its report");
    assert_eq!(collect_bundle(&other, SHIP).await.unwrap().content.lines, bundle.content.lines);
    let again = import_bundle(&other, &read).await.unwrap();
    assert_eq!((again.versions.len(), again.trials), (0, 0), "a second time nothing is new");
    source.store.close().await;
    other.store.close().await;
}

async fn parent(archive: &Archive, id: Option<String>) -> Option<(String, i64)> {
    let parent = archive.store.versions().by_id(&id?).await.unwrap().head;
    Some((parent.model, parent.number))
}

#[tokio::test(flavor = "multi_thread")]
async fn what_contradicts_is_named_and_nothing_is_taken() {
    let (from, to) = (TestDatabase::new_sqlite(), TestDatabase::new_sqlite());
    let (source, other) = (filled(&from).await, opened(&to).await);
    let bundle = collect_bundle(&source, SHIP).await.unwrap();
    let another = NewShip {
        name: SHIP.to_owned(),
        title: "Another".to_owned(),
        category: "tanker".to_owned(),
        document: "{}".to_owned(),
    };
    other.store.ships().create(&another).await.unwrap();
    let law = bundle.content.laws.keys().next().unwrap();
    other.store.laws().insert(law, "another law").await.unwrap();
    let refused = import_bundle(&other, &bundle).await.unwrap_err().to_string();
    assert!(refused.contains(&format!("`{SHIP}` has a different history")), "{refused}");
    assert!(refused.contains(&format!("the law `{law}` differs")), "{refused}");
    assert!(other.store.versions().latest(SHIP).await.is_err(), "nothing was written");
}

#[tokio::test(flavor = "multi_thread")]
async fn a_damaged_file_is_refused() {
    let database = TestDatabase::new_sqlite();
    let bundle = collect_bundle(&filled(&database).await, SHIP).await.unwrap();
    let refused = |bytes: &[u8]| match Bundle::from_bytes(bytes) {
        Err(BundleError::File(message)) => message,
        other => panic!("{other:?}"),
    };
    assert!(refused(b"no archive").contains("is not a bundle"));
    let mut changed = bundle.clone();
    changed.content.lines.get_mut(SHIP).unwrap()[0].document.push(' ');
    assert!(
        refused(&changed.to_bytes(None).unwrap()).contains("demo-ship/1 does not have its hash")
    );
    let mut lacking = bundle.clone();
    lacking.objects.clear();
    assert!(refused(&lacking.to_bytes(None).unwrap()).contains("lacks the samples"));
}

/// Any 32 bytes are a key: the first of RFC 8032, section 7.1, test 2, the other of zeros.
pub(super) const KEYS: [&str; 2] = [
    "-----BEGIN PRIVATE KEY-----\n\
    MC4CAQAwBQYDK2VwBCIEIEzNCJso/5banbbDRuwRTg9bijGfNaumJNqM9u1PuKb7\n\
    -----END PRIVATE KEY-----\n",
    "-----BEGIN PRIVATE KEY-----\n\
    MC4CAQAwBQYDK2VwBCIEIAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA\n\
    -----END PRIVATE KEY-----\n",
];

/// The archive with other bytes in place of a file.
fn replaced(archive: &[u8], name: &str, bytes: &[u8]) -> Vec<u8> {
    let mut from = zip::ZipArchive::new(Cursor::new(archive)).unwrap();
    let mut to = zip::ZipWriter::new(Cursor::new(Vec::new()));
    for place in 0..from.len() {
        let mut file = from.by_index(place).unwrap();
        let (own, mut kept) = (file.name().unwrap().into_owned(), Vec::new());
        file.read_to_end(&mut kept).unwrap();
        to.start_file(own.as_str(), zip::write::SimpleFileOptions::default()).unwrap();
        to.write_all(if own == name { bytes } else { &kept }).unwrap();
    }
    to.finish().unwrap().into_inner()
}

#[tokio::test(flavor = "multi_thread")]
async fn a_signed_file_is_its_signers() {
    let database = TestDatabase::new_sqlite();
    let bundle = collect_bundle(&filled(&database).await, SHIP).await.unwrap();
    let [key, other] = KEYS.map(|pem| SigningKey::from_pem(pem.as_bytes()).unwrap());
    let file = bundle.to_bytes(Some(&key)).unwrap();
    let (read, signer) = Bundle::from_bytes(&file).unwrap();
    assert_eq!((read, signer.as_ref()), (bundle.clone(), Some(&key.verifying_key())));
    check_signer(signer.as_ref(), &[other.verifying_key(), key.verifying_key()]).unwrap();
    let refused = |signer| check_signer(signer, &[other.verifying_key()]).unwrap_err().to_string();
    assert!(refused(signer.as_ref()).contains("which is not one of the given keys"));
    assert!(refused(None).contains("is not signed"));
    let not_signed = "manifest.sig does not match manifest.json";
    for (name, bytes, says) in [
        ("manifest.json", &b"{}"[..], not_signed),
        ("manifest.sig", &[0; 64], not_signed),
        ("signer.der", other.verifying_key().as_der(), not_signed),
        ("signer.der", &[0; 44], "signer.der is not an Ed25519 key"),
    ] {
        let error = Bundle::from_bytes(&replaced(&file, name, bytes)).unwrap_err().to_string();
        assert!(error.contains(says), "{error}");
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn aliases_and_reports_beyond_one_page_are_collected() {
    let database = TestDatabase::new_sqlite();
    let archive = filled(&database).await;
    let version = archive.store.versions().get(SHIP, 1).await.unwrap().head.id;
    // In one transaction, which is faster.
    let unit = archive.store.begin_unit();
    for number in 0..1100 {
        let report = NewReport {
            version_id: Some(version.clone()),
            ship: SHIP.to_owned(),
            kind: "refinement".to_owned(),
            document: format!("{{\"number\":{number}}}"),
            html: "<p></p>".to_owned(),
        };
        unit.store().reports().insert(&report).await.unwrap();
        let alias = server_move(&format!("alias-{number}"), ExpectedRevision::Absent, "test");
        unit.store().aliases().move_to(SHIP, 1, &alias).await.unwrap();
    }
    unit.commit(None).await.unwrap();
    let content = collect_bundle(&archive, SHIP).await.unwrap().content;
    assert_eq!(content.aliases.len(), 1100 + 1, "and the champion");
    let reports = &content.lines[SHIP][0].reports;
    assert_eq!(reports.len(), 1100 + 1, "and that of the derivation");
    assert_eq!(reports.last().unwrap().document, r#"{"number":1099}"#, "oldest first");
}
