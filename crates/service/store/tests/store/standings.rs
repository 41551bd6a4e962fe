use sistership_store::{ExpectedRevision, PageRequest, ShipFacts, ShipOverview, StaleShip};

use crate::diagnoses;
use crate::support::*;

async fn ships_of_a_page_are_told_at_once(on: &TestStore) {
    on.store.ships().create(&ship("kcs")).await.unwrap();
    diagnoses::one(on).await;
    on.store.ships().create(&ship("alone")).await.unwrap();
    let newest = on.store.versions().latest("kcs").await.unwrap().head;
    for (family, members) in [("sisters", &["kcs"][..]), ("cousins", &["kcs", "alone"])] {
        on.store.families().create(family, family, &newest.id).await.unwrap();
        let members: Vec<String> = members.iter().map(|&name| name.to_owned()).collect();
        on.store.families().add_members(family, &members).await.unwrap();
    }
    let number = newest.number;
    on.store.aliases().move_to("kcs", number, &champion(ExpectedRevision::Any)).await.unwrap();
    let waiting = on.store.search_index().list_stale("", 10).await.unwrap();
    let facts = |waiting: &StaleShip| ShipFacts {
        category: "tanker".into(),
        facts: [("error", 0.0), ("left 00", 1.0), ("left 01", 2.0), ("leftover", 9.0)]
            .map(|(name, more)| (name.to_owned(), more + waiting.ship.len() as f64))
            .to_vec(),
        ..ShipFacts::without_facts(waiting.clone())
    };
    on.store
        .search_index()
        .write_facts(&waiting.iter().map(facts).collect::<Vec<_>>())
        .await
        .unwrap();
    let names = ["kcs", "alone", "lost's \"name\""].map(str::to_owned);
    let all = on.store.ship_overviews(&names, "error", "left ").await.unwrap();
    let head = on.store.versions().get_head("kcs", number).await.unwrap();
    let newest =
        on.store.diagnoses().by_version(&head.id, &PageRequest::first_page(9)).await.unwrap().items;
    let kcs = &all["kcs"];
    assert_eq!((kcs.champion.as_ref(), &kcs.diagnoses), (Some(&head), &newest));
    assert!(!kcs.diagnoses.is_empty());
    assert_eq!((kcs.fact, &kcs.families), (Some(3.0), &vec!["cousins".into(), "sisters".into()]));
    let alone = ShipOverview {
        fact: Some(5.0),
        series: vec![6.0, 7.0],
        families: vec!["cousins".into()],
        ..ShipOverview::default()
    };
    assert_eq!((&all["alone"], &all[&names[2]]), (&alone, &ShipOverview::default()));
    assert_eq!(all.len(), 3);
    assert!(on.store.ship_overviews(&[], "error", "left ").await.unwrap().is_empty());
}

on_both_databases!(ships_of_a_page_are_told_at_once);
