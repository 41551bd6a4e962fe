//! A version whose prior is a population: its recipe names every ship, and it is derived again from
//! them.
#![allow(clippy::unwrap_used)]

mod archive;

use std::sync::Arc;

use archive::archive;
use sistership_identification::refine::{EstimationMethod, Prior, RefinementSettings, TermFamily};
use sistership_jobs::aliases::server_move;
use sistership_jobs::archive::{Archive, parse_vessel};
use sistership_jobs::derive::{DerivedVersion, derive};
use sistership_jobs::error::DeriveError;
use sistership_jobs::recipe::DerivationRecipe;
use sistership_jobs::start::RefinementStart;
use sistership_jobs::upkeep::check_archive;
use sistership_jobs::verify::verify_version;
use sistership_model::Zoo;
use sistership_model::version::{RecipeTrial, VersionRecipe as Plain};
use sistership_store::testing::TestDatabase;
use sistership_store::{ExpectedRevision, NewVersion};

const SHIP: &str = "mariner";

/// Of a source of another law, held by a population.
async fn recipe(archive: &Archive, trials: Vec<RecipeTrial>) -> DerivationRecipe {
    let settings = RefinementSettings {
        method: EstimationMethod::Weak,
        prior: Prior::Population,
        families: vec![TermFamily::Symmetric],
        strengths: vec![0.1, 0.001],
        ..RefinementSettings::default()
    };
    let ship = archive.store.ships().get(SHIP).await.unwrap();
    let target = parse_vessel(&ship.name, &ship.document).unwrap();
    let source = archive.store.versions().get("kvlcc2", 1).await.unwrap();
    let start = RefinementStart::from_version(source, Some("low-speed".to_owned()), settings);
    let zoo = Zoo::load_embedded().unwrap();
    let start = start.with_population(archive, &zoo, &target).await.unwrap();
    DerivationRecipe::Plain(start.refinement_recipe(archive, &ship, trials).await.unwrap())
}

async fn derived(
    archive: &Archive,
    recipe: &DerivationRecipe,
) -> Result<DerivedVersion, DeriveError> {
    derive(archive, SHIP, recipe, Arc::new(|_, _| true)).await
}

#[tokio::test(flavor = "multi_thread")]
async fn a_version_held_by_a_population_names_its_ships_and_is_derived_again() {
    let databases = [Some(TestDatabase::new_sqlite()), TestDatabase::new_postgres().await];
    for database in databases.into_iter().flatten() {
        let (archive, trials) = archive(&database).await;
        let recipe = recipe(&archive, trials).await;
        let ships: Vec<&str> =
            recipe.population_members().iter().map(|m| &*m.version.ship).collect();
        assert!(ships.len() > 10 && !ships.contains(&SHIP), "{ships:?}");
        assert!(!ships.contains(&"seiun-maru"), "an estimate from particulars: {ships:?}");
        let made = derived(&archive, &recipe).await.unwrap();
        let model = &made.document.model;
        assert_eq!(model.note.as_deref(), Some("prior from a population of ships"));
        let remarks = made.document.report["remarks"].to_string();
        assert!(remarks.contains("kvlcc2/mmg") && !remarks.contains("mariner/"), "{remarks}");
        let new = NewVersion {
            model: SHIP.into(),
            parent: None,
            law: model.law.clone(),
            method: "weak".into(),
            document: made.document.to_canonical_json().unwrap(),
            weights: None,
        };
        let moves = [server_move("latest", ExpectedRevision::Any, "a test")];
        let head =
            archive.store.versions().create_with_weights(&archive.objects, &new, &moves).await;
        let number = head.unwrap().number;
        let verification = verify_version(&archive, SHIP, number).await.unwrap();
        assert!(verification.identical, "{:?}", verification.remarks);
        assert!(check_archive(&archive).await.unwrap().clean);
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn a_population_that_is_missing_or_another_is_no_prior() {
    let database = TestDatabase::new_sqlite();
    let (archive, trials) = archive(&database).await;
    let whole = recipe(&archive, trials).await;
    let with = |change: &dyn Fn(&mut Vec<sistership_model::version::PopulationMember>)| {
        let mut changed = whole.clone();
        let DerivationRecipe::Plain(Plain::Refinement { population, .. }) = &mut changed else {
            panic!("a refinement")
        };
        change(population);
        changed
    };
    let said = |made: Result<DerivedVersion, DeriveError>| made.unwrap_err().to_string();
    let none = said(derived(&archive, &with(&|all| all.clear())).await);
    assert!(none.contains("0 ships") && none.contains("at least 5"), "{none}");
    let few = said(derived(&archive, &with(&|all| all.truncate(3))).await);
    assert!(few.contains("at least 5"), "{few}");
    let other = with(&|all| all[0].version.sha256 = "0".repeat(64));
    assert!(said(derived(&archive, &other).await).contains("version"), "another hash");
}
