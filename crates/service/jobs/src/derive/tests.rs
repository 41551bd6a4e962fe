//! Versions of each kind of recipe: each verifies, each reads what its recipe names and nothing
//! else, and what is lost or damaged is named.

#![allow(clippy::unwrap_used)]

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::Arc;

use sistership_model::version::sha256_hex;
use sistership_store::NewVersion;
use sistership_store::testing::TestDatabase;

use super::derive;
use crate::archive::{Archive, version_document};
use crate::input::InputKind;
use crate::library::{EffectLibrary, embedded_library};
use crate::recipe::DerivationRecipe;
use crate::testing::{DEMO_SHIP as SHIP, demo_rows};
use crate::upkeep::{check_archive, collect_garbage};
use crate::verify::{memory_demand, verify_version};
use crate::version::VersionDocument;

/// Versions of the demonstration ship, with the kind of their recipe.
const KINDS: [(i64, &str); 3] = [(1, "refinement"), (2, "diagnosis"), (3, "statistics")];

/// Returns the hash of the program's library of effects.
fn library_sha256() -> &'static str {
    &embedded_library().unwrap().sha256
}

/// An archive with the versions and their inputs.
async fn archive(database: &TestDatabase) -> Archive {
    let rows = demo_rows().await;
    let archive = rows.open_archive(database).await;
    for version in &rows.versions {
        archive.store.versions().create(version, &[]).await.unwrap();
    }
    archive
}

async fn stored(archive: &Archive, number: i64) -> VersionDocument {
    version_document(&archive.store.versions().get(SHIP, number).await.unwrap()).unwrap()
}

async fn derived(archive: &Archive, recipe: &DerivationRecipe) -> String {
    let derived = derive(archive, SHIP, recipe, Arc::new(|_, _| true)).await.unwrap();
    derived.document.to_canonical_json().unwrap()
}

/// Every derivation that reads samples takes memory for them; that of a family for one trial at a
/// time.
#[tokio::test(flavor = "multi_thread")]
async fn a_verification_has_the_memory_of_the_samples_that_it_reads() {
    let database = TestDatabase::new_sqlite();
    let archive = archive(&database).await;
    for (number, kind) in KINDS {
        let bytes = memory_demand(&archive, SHIP, number).await.unwrap();
        let mut sizes = Vec::new();
        for trial in stored(&archive, number).await.recipe.trials() {
            sizes.push(archive.objects.object_size(&trial.sha256).await.unwrap());
        }
        let read = match kind {
            "statistics" => *sizes.iter().max().unwrap(),
            _ => sizes.iter().sum(),
        };
        // At least hundred times the compressed size.
        assert!(bytes > 100 * read && read > 0, "{kind}: {bytes} bytes for {read}");
    }
}

/// The library of the recipe is taken, and not the program's.
#[tokio::test(flavor = "multi_thread")]
async fn another_library_gives_another_calibration_by_its_own_hash() {
    let database = TestDatabase::new_sqlite();
    let archive = archive(&database).await;
    let whole = archive.effect_library(library_sha256()).await.unwrap();
    let small = whole
        .document
        .split("kind: effect\n")
        .filter(|file| file.starts_with("name: rudder-"))
        .fold(String::new(), |all, file| all + "kind: effect\n" + file);
    let hash = archive.store.effect_libraries().insert_absent(&small).await.unwrap();
    assert_eq!(EffectLibrary::parse(&small).unwrap().effects.len(), 3);
    let mut changed = stored(&archive, 1).await;
    let before = changed.clone();
    if let DerivationRecipe::Plain(sistership_model::version::VersionRecipe::Refinement {
        effects_sha256,
        ..
    }) = &mut changed.recipe
    {
        effects_sha256.clone_from(&hash);
    }
    assert_eq!(changed.recipe.effects_sha256(), Some(hash.as_str()));
    let now = derived(&archive, &changed.recipe).await;
    let now: VersionDocument = serde_json::from_str(&now).unwrap();
    assert_ne!(now.model.uncertainty, before.model.uncertainty);
    assert_eq!(now.model.coefficients, before.model.coefficients);
    let row = NewVersion {
        document: now.to_canonical_json().unwrap(),
        ..demo_rows().await.versions[1].clone()
    };
    let number = archive.store.versions().create(&row, &[]).await.unwrap().number;
    assert!(verify_version(&archive, SHIP, number).await.unwrap().identical);
    collect_garbage(&archive, std::time::Duration::ZERO, false).await.unwrap();
    assert!(
        verify_version(&archive, SHIP, number).await.unwrap().identical,
        "nothing collects a library"
    );
    database
        .execute_unchecked(&format!("DELETE FROM effect_libraries WHERE sha256 = '{hash}'"))
        .await;
    let lost = verify_version(&archive, SHIP, number).await.unwrap_err().to_string();
    assert!(lost.contains(&format!("the store has no library of effects {hash}")), "{lost}");
    let findings = check_archive(&archive).await.unwrap();
    assert!(findings.faults.iter().any(|fault| fault.check == "version-effects"), "{findings:?}");
}

/// What each kind of version reads is what its recipe names: the loader refuses it otherwise, which
/// is shown here by recipes from which, and to which, an input was taken and added.
#[tokio::test(flavor = "multi_thread")]
async fn every_kind_of_version_reads_what_its_recipe_names() {
    let database = TestDatabase::new_sqlite();
    let archive = archive(&database).await;
    let kinds = |recipe: &DerivationRecipe| {
        recipe.all_inputs().into_iter().map(|input| input.kind).collect::<BTreeSet<InputKind>>()
    };
    use InputKind::{Effects, Law, Samples, Ship, Version};
    for (number, named) in [
        (1, vec![Ship, Law, Version, Samples, Effects]),
        (2, vec![Law, Version, Samples, Effects]),
        (3, vec![Ship, Law, Version, Samples]),
    ] {
        let recipe = stored(&archive, number).await.recipe;
        assert_eq!(kinds(&recipe), BTreeSet::from_iter(named), "version {number}");
        let inputs = super::DerivationInputs::new(&archive);
        let unread = inputs.check_recipe(&recipe).unwrap_err().to_string();
        let every = recipe.all_inputs().iter().all(|input| {
            unread.contains(&format!("{input} is listed in the recipe, but was not read"))
        });
        assert!(every, "{unread}");
        inputs.read_effects(library_sha256()).await.unwrap();
        let unnamed = inputs.check_recipe(&recipe).unwrap_err().to_string();
        assert_eq!(
            unnamed.contains("was read, but is not listed in the recipe"),
            number == 3,
            "{unnamed}"
        );
        // Deriving ends in the same check, with success.
        let verified = verify_version(&archive, SHIP, number).await.unwrap();
        assert!(verified.identical, "{:?}", verified.remarks);
    }
}

/// Each input of each kind of version, damaged and lost.
#[tokio::test(flavor = "multi_thread")]
async fn an_input_that_is_not_what_it_was_is_named() {
    let (law, ship, source) =
        ("the law `son-nomoto`", "ship `demo-ship` has the hash", "version sr108/1");
    let library = "library of effects";
    for (number, damage, named) in [
        (1, "UPDATE laws SET document = document || ' '", law),
        (1, "UPDATE laws SET document = document || ' ', sha256 = 'x'", law),
        (1, "DELETE FROM laws", "son-nomoto"),
        (1, "UPDATE ship_revisions SET document = document || ' '", ship),
        (1, "UPDATE versions SET document = document || ' ' WHERE model = 'sr108'", source),
        (1, "UPDATE effect_libraries SET document = document || ' '", library),
        (1, "DELETE FROM effect_libraries", library_sha256()),
        (2, "UPDATE effect_libraries SET document = document || ' '", library),
        (2, "DELETE FROM effect_libraries", library_sha256()),
        (
            2,
            "UPDATE versions SET document = replace(document, '0', '1') WHERE number = 1",
            "version demo-ship/1",
        ),
        (3, "UPDATE laws SET document = document || ' '", law),
        (3, "UPDATE ship_revisions SET document = document || ' '", ship),
        (
            3,
            "UPDATE versions SET document = document || ' ' WHERE number = 1",
            "version demo-ship/1",
        ),
    ] {
        let database = TestDatabase::new_sqlite();
        let archive = archive(&database).await;
        database.execute_unchecked(damage).await;
        let error = verify_version(&archive, SHIP, number).await.expect_err(damage).to_string();
        assert!(error.contains(named), "`{damage}`: {error}");
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn samples_that_are_lost_are_named() {
    let database = TestDatabase::new_sqlite();
    let archive = archive(&database).await;
    for number in 1..=3 {
        let key = stored(&archive, number).await.recipe.trials()[0].sha256.clone();
        let file = database.folder.path().join("objects").join(&key[..2]).join(&key[2..]);
        let bytes = std::fs::read(&file).unwrap();
        std::fs::write(&file, b"other").unwrap();
        let damaged = verify_version(&archive, SHIP, number).await.unwrap_err().to_string();
        assert!(damaged.contains(&key) && damaged.contains(&sha256_hex(b"other")), "{damaged}");
        std::fs::remove_file(&file).unwrap();
        let lost = verify_version(&archive, SHIP, number).await.unwrap_err().to_string();
        assert!(lost.contains(&key), "{lost}");
        std::fs::write(&file, bytes).unwrap();
    }
}

/// A later release adds its library beside the older ones, on both databases; a backup has all of
/// them.
#[tokio::test(flavor = "multi_thread")]
async fn libraries_stay_beside_each_other_and_are_backed_up() {
    for database in
        [Some(TestDatabase::new_sqlite()), TestDatabase::new_postgres().await].into_iter().flatten()
    {
        let archive = Archive::open(&database.url, database.folder.path()).await.unwrap();
        let later = archive
            .store
            .effect_libraries()
            .insert_absent("kind: effect\nname: later\n")
            .await
            .unwrap();
        crate::library::store_library(&archive.store).await.unwrap();
        let page = sistership_store::PageRequest::first_page(10);
        let all: Vec<String> = archive
            .store
            .effect_libraries()
            .list(&page)
            .await
            .unwrap()
            .items
            .into_iter()
            .map(|library| library.sha256)
            .collect();
        let expected = BTreeSet::from([later, library_sha256().to_owned()]);
        assert_eq!(all, Vec::from_iter(expected));
    }
    let (database, other) = (TestDatabase::new_sqlite(), TestDatabase::new_sqlite());
    let archive = archive(&database).await;
    let folder = database.folder.path().join("backup");
    crate::upkeep::back_up_archive(&archive, &folder).await.unwrap();
    let place = sistership_store::ObjectsPlace::Folder(other.folder.path().join("samples"));
    crate::upkeep::restore_archive(&folder, &other.url, &place).await.unwrap();
    let store =
        sistership_store::Store::connect(&other.url, Arc::new(sistership_store::SystemClock))
            .await
            .unwrap();
    let library = store.effect_libraries().get(library_sha256()).await.unwrap();
    assert_eq!(sha256_hex(library.document.as_bytes()), library_sha256());
}

/// Every setting that was used is in the recipe of a new version, and the spelled out recipe gives
/// the same model.
#[tokio::test(flavor = "multi_thread")]
async fn new_recipes_spell_out_every_setting() {
    let database = TestDatabase::new_sqlite();
    let archive = archive(&database).await;
    for method in ["published", "weak", "trajectory", "cma-es"] {
        let mut recipe = stored(&archive, 1).await.recipe;
        if let DerivationRecipe::Plain(sistership_model::version::VersionRecipe::Refinement {
            settings,
            ..
        }) = &mut recipe
        {
            settings["method"] = method.into();
            settings["cma_es"] = serde_json::json!({ "evaluations": 300 });
        }
        let made = derive(&archive, SHIP, &recipe, Arc::new(|_, _| true))
            .await
            .unwrap()
            .with_explicit_settings()
            .unwrap();
        let DerivationRecipe::Plain(sistership_model::version::VersionRecipe::Refinement {
            settings,
            ..
        }) = &made.document.recipe
        else {
            panic!("a refinement")
        };
        let mut used = made.document.report["settings"].clone();
        if method == "cma-es" {
            used["cma_es"]["evaluations"] = 300.into();
        }
        assert_eq!(*settings, used, "{method}");
        let again = derived(&archive, &made.document.recipe).await;
        assert!(again == made.document.to_canonical_json().unwrap(), "{method}");
    }
}

/// What numerics are not given as arguments they do not know: no zoo of the program's, no file, no
/// environment, no calendar, no count of cores. The clock of a search's budget is refused where
/// versions are made.
#[test]
fn numerics_read_nothing_but_their_arguments() {
    let crates = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."));
    let rooms = [
        "core/simulation",
        "analysis/numerics",
        "analysis/identification",
        "analysis/diagnosis",
        "analysis/fleet",
    ];
    let mut folders: Vec<PathBuf> = rooms.map(|room| crates.join(room).join("src")).into();
    let mut files = Vec::new();
    while let Some(folder) = folders.pop() {
        for path in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
            if path.is_dir() { folders.push(path) } else { files.push(path) }
        }
    }
    assert!(files.len() > 100);
    for file in files.iter().filter(|file| !file.to_string_lossy().contains("test")) {
        let text = std::fs::read_to_string(file).unwrap();
        let product = text.split("#[cfg(test)]").next().unwrap();
        for word in [
            "Zoo::embedded",
            "std::fs",
            "std::env",
            "SystemTime",
            "available_parallelism",
            "current_num_threads",
        ] {
            assert!(!product.contains(word), "{} reads {word}", file.display());
        }
    }
}
