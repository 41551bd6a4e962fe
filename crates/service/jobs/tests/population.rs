//! A version whose prior is a population: its recipe names every ship, and it is derived again from
//! them.
#![allow(clippy::unwrap_used)]

mod archive;

use std::sync::Arc;

use archive::archive;
use sistership_identification::refine::{Family, Method, Prior, Settings};
use sistership_jobs::archive::{Archive, vessel};
use sistership_jobs::derive::{Derived, derive};
use sistership_jobs::error::DeriveError;
use sistership_jobs::line::step;
use sistership_jobs::recipe::Recipe;
use sistership_jobs::start::Start;
use sistership_jobs::upkeep::fsck;
use sistership_jobs::verify::verify;
use sistership_model::Zoo;
use sistership_model::version::{Recipe as Plain, RecipeTrial};
use sistership_store::testing::TestDatabase;
use sistership_store::{Expect, NewVersion};

const SHIP: &str = "mariner";

/// Of a source of another law, held by a population.
async fn recipe(archive: &Archive, trials: Vec<RecipeTrial>) -> Recipe {
    let settings = Settings {
        method: Method::Weak,
        prior: Prior::Population,
        families: vec![Family::Symmetric],
        strengths: vec![0.1, 0.001],
        ..Settings::default()
    };
    let ship = archive.store.ships().get(SHIP).await.unwrap();
    let target = vessel(&ship.name, &ship.document).unwrap();
    let source = archive.store.versions().get("kvlcc2", 1).await.unwrap();
    let start = Start::at(source, Some("low-speed".to_owned()), settings);
    let zoo = Zoo::embedded().unwrap();
    let start = start.with_population(archive, &zoo, &target).await.unwrap();
    Recipe::Plain(start.recipe(archive, &ship, trials).await.unwrap())
}

async fn derived(archive: &Archive, recipe: &Recipe) -> Result<Derived, DeriveError> {
    derive(archive, SHIP, recipe, Arc::new(|_, _| true)).await
}

#[tokio::test(flavor = "multi_thread")]
async fn a_version_held_by_a_population_names_its_ships_and_is_derived_again() {
    let databases = [Some(TestDatabase::sqlite()), TestDatabase::postgres().await];
    for database in databases.into_iter().flatten() {
        let (archive, trials) = archive(&database).await;
        let recipe = recipe(&archive, trials).await;
        let ships: Vec<&str> = recipe.population().iter().map(|m| &*m.version.ship).collect();
        assert!(ships.len() > 10 && !ships.contains(&SHIP), "{ships:?}");
        assert!(!ships.contains(&"seiun-maru"), "an estimate from particulars: {ships:?}");
        let made = derived(&archive, &recipe).await.unwrap();
        let model = &made.document.model;
        assert_eq!(model.note.as_deref(), Some("held by what a population of ships says"));
        let remarks = made.document.report["remarks"].to_string();
        assert!(remarks.contains("kvlcc2/mmg") && !remarks.contains("mariner/"), "{remarks}");
        let new = NewVersion {
            model: SHIP.into(),
            parent: None,
            law: model.law.clone(),
            method: "weak".into(),
            document: made.document.canonical().unwrap(),
            weights: None,
        };
        let moves = [step("latest", Expect::Any, "a test")];
        let head =
            archive.store.versions().create_with_weights(&archive.objects, &new, &moves).await;
        let number = head.unwrap().number;
        let verification = verify(&archive, SHIP, number).await.unwrap();
        assert!(verification.identical, "{:?}", verification.remarks);
        assert!(fsck(&archive).await.unwrap().clean);
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn a_population_that_is_missing_or_another_is_no_prior() {
    let database = TestDatabase::sqlite();
    let (archive, trials) = archive(&database).await;
    let whole = recipe(&archive, trials).await;
    let with = |change: &dyn Fn(&mut Vec<sistership_model::version::PopulationMember>)| {
        let mut changed = whole.clone();
        let Recipe::Plain(Plain::Refinement { population, .. }) = &mut changed else {
            panic!("a refinement")
        };
        change(population);
        changed
    };
    let said = |made: Result<Derived, DeriveError>| made.unwrap_err().to_string();
    let none = said(derived(&archive, &with(&|all| all.clear())).await);
    assert!(none.contains("0 ships") && none.contains("at least 5"), "{none}");
    let few = said(derived(&archive, &with(&|all| all.truncate(3))).await);
    assert!(few.contains("at least 5"), "{few}");
    let other = with(&|all| all[0].version.sha256 = "0".repeat(64));
    assert!(said(derived(&archive, &other).await).contains("version"), "another hash");
}
