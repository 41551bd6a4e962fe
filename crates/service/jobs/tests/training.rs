//! A version with a learned branch: kept whole, and derived again.
#![allow(clippy::unwrap_used)]

mod archive;

use std::sync::Arc;
use std::time::Duration;

use sistership_learned::{BranchKind, BranchSettings};
use sistership_model::Zoo;
use sistership_model::version::RecipeTrial;
use sistership_simulation::Ship;
use sistership_simulation::manoeuvre::{ManoeuvreSettings, simulate_zigzag};
use sistership_store::testing::TestDatabase;
use sistership_store::{ExpectedRevision, NewVersion, VersionHead};

use archive::archive;
use sistership_jobs::aliases::server_move;
use sistership_jobs::archive::Archive;
use sistership_jobs::derive::{DerivedVersion, derive};
use sistership_jobs::recipe::DerivationRecipe;
use sistership_jobs::training::{choose_kind, foundation_number, training_recipe};
use sistership_jobs::upkeep::{Findings, check_archive, collect_garbage};
use sistership_jobs::verify::verify_version;

async fn trained(archive: &Archive, trials: Vec<RecipeTrial>) -> DerivedVersion {
    let version = archive.store.versions().get("mariner", 1).await.unwrap();
    let settings = BranchSettings::default().with_kind(BranchKind::Kernels);
    let recipe = training_recipe(archive, &version, trials, &settings).await.unwrap();
    derive(archive, "mariner", &DerivationRecipe::Training(recipe), Arc::new(|_, _| true))
        .await
        .unwrap()
}

/// Keeps what was derived, as a job does.
async fn kept(
    archive: &Archive,
    derived: &DerivedVersion,
) -> sistership_store::Result<VersionHead> {
    let new = NewVersion {
        model: "mariner".into(),
        parent: None,
        law: derived.document.model.law.clone(),
        method: "branch-kernel-ridge-parallel".into(),
        document: derived.document.to_canonical_json().unwrap(),
        weights: derived.document.model.branch.as_ref().map(|b| b.weights_sha256.clone()),
    };
    let moves = [server_move("latest", ExpectedRevision::Any, "a test")];
    archive.store.versions().create_with_weights(&archive.objects, &new, &moves).await
}

async fn faults(archive: &Archive) -> Vec<String> {
    let Findings { faults, .. } = check_archive(archive).await.unwrap();
    faults.into_iter().map(|fault| format!("{} {}", fault.check, fault.message)).collect()
}

#[tokio::test(flavor = "multi_thread")]
async fn a_version_with_a_branch_is_kept_whole_and_derived_again() {
    let databases = [Some(TestDatabase::new_sqlite()), TestDatabase::new_postgres().await];
    for database in databases.into_iter().flatten() {
        let (archive, trials) = archive(&database).await;
        let derived = trained(&archive, trials).await;
        assert!(kept(&archive, &derived).await.is_err(), "a version whose weights are not there");
        let key = archive.objects.put(derived.weights.clone().unwrap()).await.unwrap();
        let head = kept(&archive, &derived).await.unwrap();
        let verification = verify_version(&archive, "mariner", head.number).await.unwrap();
        assert!(verification.identical, "{:?}", verification.remarks);
        tokio::time::sleep(Duration::from_millis(20)).await;
        assert!(collect_garbage(&archive, Duration::ZERO, false).await.unwrap().removed.is_empty());
        assert_eq!(faults(&archive).await, Vec::<String>::new());
        sails(&archive, &head).await;
        assert_eq!(foundation_number(&archive, "mariner", head.number).await.unwrap(), Some(1));
        backed_up(&archive, &database, &key).await;
        database.execute_unchecked("UPDATE versions SET weights_key = NULL").await;
        assert!(faults(&archive).await[0].contains("does not refer to the weights"));
        assert_eq!(
            collect_garbage(&archive, Duration::ZERO, false).await.unwrap().removed,
            [] as [&str; 0]
        );
        let place = format!("objects/{}/{}", &key[..2], &key[2..]);
        std::fs::remove_file(database.folder.path().join(place)).unwrap();
        assert!(faults(&archive).await[0].starts_with("version-weights the weights"));
        assert!(
            verify_version(&archive, "mariner", head.number).await.is_err(),
            "weights are gone"
        );
    }
}

/// It sails by both halves, and its report says that it is better on trials left out.
async fn sails(archive: &Archive, head: &VersionHead) {
    let version = archive.store.versions().by_id(&head.id).await.unwrap();
    let document = sistership_jobs::archive::version_document(&version).unwrap();
    assert!(document.report["branch"].as_f64() < document.report["foundation"].as_f64());
    let zoo = Zoo::load_embedded().unwrap();
    let law = zoo.law("abkowitz").unwrap();
    assert!(Ship::new(&document.model, law).is_err(), "half of it is missing");
    let ship = Ship::new(&archive.model_with_weights(&version).await.unwrap(), law).unwrap();
    let track = simulate_zigzag(&ship, 10.0, 10.0, &ManoeuvreSettings::default()).unwrap().track;
    assert!(ship.mean_correction_share(&track).unwrap() > 0.9);
}

/// Its weights go into a backup.
async fn backed_up(archive: &Archive, database: &TestDatabase, key: &str) {
    let folder = database.folder.path().join("backup");
    let manifest = archive.store.backup(&archive.objects, &folder).await.unwrap();
    assert_eq!(manifest.objects, 5, "four trials, and weights");
    assert!(folder.join(format!("objects/{}/{}", &key[..2], &key[2..])).exists());
}

#[tokio::test(flavor = "multi_thread")]
async fn every_kind_is_tried_and_the_best_taken_where_it_wins() {
    let database = TestDatabase::new_sqlite();
    let (archive, trials) = archive(&database).await;
    let version = archive.store.versions().get("mariner", 1).await.unwrap();
    let open = BranchSettings::default();
    let go_on = Arc::new(|_: f64, _: &str| true);
    let choice =
        choose_kind(&archive, &version, &trials, open.clone(), go_on.clone()).await.unwrap();
    assert_eq!(choice.tried.len(), BranchKind::ALL.len());
    let taken = choice.taken.unwrap();
    let best = choice.tried.iter().find(|tried| tried.kind == taken).unwrap();
    assert!(choice.tried.iter().all(|tried| best.branch <= tried.branch));
    let one = choose_kind(&archive, &version, &trials[..1], open, go_on).await.unwrap();
    assert!(one.taken.is_none() && one.reason.contains("only one trial"), "{one:?}");
}
