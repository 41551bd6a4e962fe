use sistership_store::{
    Actor, ExpectedRevision, FactRange, FoundShip, ListPage, NewShip, PageRequest, ShipFacts,
    ShipKey, ShipSearch,
};

use crate::support::*;

/// Ships `s-00`, `s-01`, ... as long as their number in tens of metres, every third one a tanker
/// and every fourth tagged.
async fn fleet(on: &TestStore, count: usize) {
    for number in 0..count {
        let name = format!("s-{number:02}");
        let category = if number % 3 == 0 { "tanker" } else { "ferry" };
        on.store
            .ships()
            .create(&NewShip { category: category.into(), ..ship(&name) })
            .await
            .unwrap();
        if number % 4 == 0 {
            on.store.ships().add_tag(&name, "own-fleet").await.unwrap();
        }
    }
    index(on).await;
}

/// Does for every ship that waits what the server does: its length is ten times its number.
async fn index(on: &TestStore) -> usize {
    let waiting = on.store.search_index().list_stale("", 1000).await.unwrap();
    let facts = |waiting: &sistership_store::StaleShip| {
        let number: f64 = waiting.ship.trim_start_matches("s-").parse().unwrap();
        let facts = vec![("lpp_m".to_owned(), 10.0 * number), ("beam_m".to_owned(), 20.0 - number)];
        ShipFacts {
            waiting: waiting.clone(),
            category: "tanker".into(),
            facts,
            vectors: format!("[{number}]"),
        }
    };
    on.store
        .search_index()
        .write_facts(&waiting.iter().map(facts).collect::<Vec<_>>())
        .await
        .unwrap();
    waiting.len()
}

fn range(fact: &str, min: f64, max: f64) -> FactRange {
    FactRange { fact: fact.into(), min, max }
}

fn names(list: &ListPage<FoundShip, ShipKey>) -> Vec<&str> {
    list.items.iter().map(|ship| ship.name.as_str()).collect()
}

async fn every(on: &TestStore, search: &ShipSearch, limit: i64) -> Vec<String> {
    let (mut all, mut page) = (Vec::new(), PageRequest::first_page(limit));
    loop {
        let list = on.store.ships().search_ships(search, &page).await.unwrap();
        assert!(list.items.len() <= usize::try_from(limit).unwrap());
        all.extend(names(&list).into_iter().map(str::to_owned));
        let Some(next) = list.next else { return all };
        page = PageRequest { after: Some(next), limit };
    }
}

async fn ships_are_found_by_each_condition_and_all_together(on: &TestStore) {
    fleet(on, 13).await;
    let own = || Some("own-fleet".to_owned());
    let tanker = || Some("tanker".to_owned());
    let find = async |search: ShipSearch| {
        let all = every(on, &search, 100).await;
        assert_eq!(every(on, &search, 2).await, all, "{search:?}");
        all.join(" ")
    };
    assert_eq!(
        find(ShipSearch { category: tanker(), ..ShipSearch::default() }).await,
        "s-00 s-03 s-06 s-09 s-12"
    );
    assert_eq!(
        find(ShipSearch { tag: own(), ..ShipSearch::default() }).await,
        "s-00 s-04 s-08 s-12"
    );
    assert_eq!(
        find(ShipSearch { category: tanker(), tag: own(), ..ShipSearch::default() }).await,
        "s-00 s-12"
    );
    let long = vec![range("lpp_m", 40.0, 90.0)];
    assert_eq!(
        find(ShipSearch { ranges: long.clone(), ..ShipSearch::default() }).await,
        "s-04 s-05 s-06 s-07 s-08 s-09"
    );
    assert_eq!(find(ShipSearch { ranges: long.clone(), tag: own(), category: tanker() }).await, "");
    assert_eq!(find(ShipSearch { ranges: long, tag: own(), category: None }).await, "s-04 s-08");
    let narrow = vec![range("beam_m", 0.0, 15.0), range("lpp_m", 0.0, 80.0)];
    assert_eq!(
        find(ShipSearch { ranges: narrow, ..ShipSearch::default() }).await,
        "s-08 s-07 s-06 s-05"
    );
    assert_eq!(
        find(ShipSearch { ranges: vec![range("draught_m", 0.0, 9.0)], ..ShipSearch::default() })
            .await,
        ""
    );
    assert_eq!(find(ShipSearch::default()).await.split(' ').count(), 13);
    let vectors = on
        .store
        .ships()
        .similarity_vectors(&ShipSearch { category: tanker(), tag: own(), ..ShipSearch::default() })
        .await
        .unwrap();
    let vectors: Vec<_> =
        vectors.iter().map(|ship| (ship.head.name.as_str(), ship.vectors.as_str())).collect();
    assert_eq!(vectors, [("s-00", "[0]"), ("s-12", "[12]")]);
    let names = ["s-12", "nobody", "s-00"].map(str::to_owned);
    let mut named: Vec<_> = on
        .store
        .ships()
        .find_by_names(&names)
        .await
        .unwrap()
        .into_iter()
        .map(|ship| ship.name)
        .collect();
    named.sort_unstable();
    assert_eq!(named, ["s-00", "s-12"]);
    assert_eq!(on.store.ships().vectors_state("nothing").await.unwrap().ships, 0);
}

/// Ships as long as their number, as broad as what is missing to 3000, each hundredth tagged.
async fn many(on: &TestStore) {
    let n = "WITH RECURSIVE n (i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < 3000)";
    for sql in [
        format!(
            "INSERT INTO ships SELECT 'm-' || (10000 + i), '', 'barge', '{{}}', 1, i, i, NULL FROM \
             ({n} SELECT i FROM n) AS k"
        ),
        "INSERT INTO ship_facts SELECT name, 'lpp_m', 1.0 * created_us FROM ships".into(),
        "INSERT INTO ship_facts SELECT name, 'beam_m', 3000.0 - created_us FROM ships".into(),
        "INSERT INTO ship_tags SELECT name, 'own-fleet' FROM ships WHERE created_us % 100 = 0"
            .into(),
    ] {
        on.database.execute_unchecked(&sql).await;
    }
}

/// Whether few or many ships meet a condition, the same are found.
async fn few_are_found_among_many(on: &TestStore) {
    many(on).await;
    let ships = |numbers: Vec<usize>| {
        numbers.iter().map(|number| format!("m-{}", 10_000 + number)).collect::<Vec<_>>()
    };
    let long = || range("lpp_m", 100.0, 2950.0);
    let with = |ranges| ShipSearch { ranges, ..ShipSearch::default() };
    let broad = with(vec![long(), range("beam_m", 10.0, 2800.0)]);
    assert_eq!(every(on, &broad, 1000).await, ships((200..=2950).collect()));
    let narrow = with(vec![long(), range("beam_m", 40.0, 60.0)]);
    assert_eq!(every(on, &narrow, 4).await, ships((2940..=2950).collect()));
    let barge = ShipSearch { category: Some("barge".into()), ..broad.clone() };
    assert_eq!(every(on, &barge, 1000).await.len(), 2751);
    let own = ShipSearch { tag: Some("own-fleet".into()), ..barge };
    assert_eq!(every(on, &own, 10).await, ships((2..=29).map(|number| 100 * number).collect()));
    assert!(
        every(on, &ShipSearch { category: Some("tanker".into()), ..broad }, 10).await.is_empty()
    );
}

async fn a_page_goes_on_where_the_last_one_ended_whatever_is_added(on: &TestStore) {
    fleet(on, 6).await;
    let all = ShipSearch { ranges: vec![range("lpp_m", 0.0, 1000.0)], ..ShipSearch::default() };
    // Each time one ship comes in before the page's end and one behind it.
    for (search, ends, new, expected) in [
        (ShipSearch::default(), "s-00 s-01 s-02", ["s-0.1", "s-3.1"], "s-03 s-04 s-05 s-3.1"),
        (all, "s-00 s-0.1 s-01", ["s-0.2", "s-3.2"], "s-02 s-03 s-3.1 s-3.2 s-04 s-05"),
    ] {
        let first =
            on.store.ships().search_ships(&search, &PageRequest::first_page(3)).await.unwrap();
        assert_eq!(names(&first).join(" "), ends);
        for name in new {
            on.store.ships().create(&ship(name)).await.unwrap();
        }
        index(on).await;
        let second = on
            .store
            .ships()
            .search_ships(&search, &PageRequest { after: first.next, limit: 9 })
            .await
            .unwrap();
        assert_eq!(names(&second).join(" "), expected);
    }
}

async fn what_changes_is_written_anew(on: &TestStore) {
    fleet(on, 2).await;
    assert_eq!(index(on).await, 0);
    on.store.ships().update(&ship("s-00"), 1).await.unwrap();
    on.store.versions().create(&version("s-01"), &[champion(ExpectedRevision::Any)]).await.unwrap();
    on.store
        .versions()
        .create(&version("no-ship"), &[champion(ExpectedRevision::Any)])
        .await
        .unwrap();
    let waiting = on.store.search_index().list_stale("", 10).await.unwrap();
    assert_eq!(waiting.iter().map(|ship| ship.ship.as_str()).collect::<Vec<_>>(), ["s-00", "s-01"]);
    // Changed again before the facts of the first change are written: they are not, and it waits
    // on.
    on.store.ships().update(&ship("s-00"), 2).await.unwrap();
    let [old, same] = &waiting[..] else { panic!() };
    let facts = |waiting: &sistership_store::StaleShip, value| {
        let facts = vec![("lpp_m".to_owned(), value)];
        ShipFacts {
            waiting: waiting.clone(),
            category: "tanker".into(),
            facts,
            vectors: "[]".into(),
        }
    };
    on.store.search_index().write_facts(&[facts(old, 7.0), facts(same, 8.0)]).await.unwrap();
    let search = ShipSearch { ranges: vec![range("lpp_m", 5.0, 9.0)], ..ShipSearch::default() };
    let found = on.store.ships().search_ships(&search, &PageRequest::first_page(9)).await.unwrap();
    assert_eq!((names(&found), found.items[0].value), (vec!["s-01"], Some(8.0)));
    assert_eq!(on.store.search_index().list_stale("", 10).await.unwrap().len(), 1);
}

async fn trials_that_come_and_go_are_news_of_their_ship(on: &TestStore) {
    fleet(on, 2).await;
    let trial = on.store.trials().insert(&trial("s-01", "a")).await.unwrap().row;
    assert_eq!(index(on).await, 1);
    on.store.trials().delete(&trial.id).await.unwrap();
    assert_eq!(index(on).await, 1);
    on.store.trials().undelete(&trial.id).await.unwrap();
    assert_eq!(index(on).await, 1);
    assert!(on.store.trials().delete("none").await.is_err());
    assert_eq!(index(on).await, 0);
}

async fn notes_have_an_author_and_stay(on: &TestStore) {
    let ships = on.store.ships();
    ships.create(&ship("kcs")).await.unwrap();
    ships.add_tag("kcs", "own").await.unwrap();
    let ann = Actor::new("ann", "192.0.2.1");
    ann.run_scoped(async { ships.add_note("kcs", "hull cleaned in dock").await }).await.unwrap();
    ships.add_note("kcs", "second\nline").await.unwrap();
    let newest = ships.list_notes("kcs", &PageRequest::first_page(1)).await.unwrap();
    assert_eq!(newest.items[0].text, "second\nline");
    let older =
        ships.list_notes("kcs", &PageRequest::after_key(newest.next.unwrap(), 1)).await.unwrap();
    let note = &older.items[0];
    assert_eq!((note.actor.as_str(), note.text.as_str()), ("ann", "hull cleaned in dock"));
    assert_eq!(older.next, None);
    assert_invalid(ships.add_note("kcs", " \n").await, "text");
    assert_invalid(ships.add_note("kcs", "a\0b").await, "text");
    let long = "x".repeat(sistership_store::MAX_NOTE_CHARS + 1);
    assert_invalid(ships.add_note("kcs", &long).await, "text");
    assert_not_found(ships.add_note("pcc", "a").await, "ship");
}

async fn tags_are_put_on_and_taken_off(on: &TestStore) {
    let ships = on.store.ships();
    ships.create(&ship("kcs")).await.unwrap();
    for tag in ["b", "a", "b"] {
        ships.add_tag("kcs", tag).await.unwrap();
    }
    assert_eq!(ships.list_tags("kcs").await.unwrap(), ["a", "b"]);
    ships.remove_tag("kcs", "a").await.unwrap();
    assert_not_found(ships.remove_tag("kcs", "a").await, "tag");
    assert_not_found(ships.add_tag("pcc", "a").await, "ship");
    assert_invalid(ships.add_tag("kcs", "two words").await, "tag");
    for number in 1..sistership_store::MAX_TAGS {
        ships.add_tag("kcs", &format!("t-{number}")).await.unwrap();
    }
    assert_conflict(ships.add_tag("kcs", "one-more").await, "100 tags already");
    ships.add_tag("kcs", "b").await.unwrap();
}

async fn a_search_that_cannot_be_is_refused(on: &TestStore) {
    let ships = on.store.ships();
    let search = |ranges| ShipSearch { ranges, ..ShipSearch::default() };
    assert_invalid(
        ships
            .search_ships(&search(vec![range("lpp_m", f64::NAN, 1.0)]), &PageRequest::first_page(1))
            .await,
        "min",
    );
    assert_invalid(
        ships
            .search_ships(&search(vec![range("lpp_m", 0.0, 1.0); 5]), &PageRequest::first_page(1))
            .await,
        "ranges",
    );
    assert_invalid(
        ships.search_ships(&search(Vec::new()), &PageRequest::first_page(1001)).await,
        "limit",
    );
    assert_invalid(ships.similarity_vectors(&search(Vec::new())).await, "category");
}

on_both_databases!(
    ships_are_found_by_each_condition_and_all_together,
    few_are_found_among_many,
    a_page_goes_on_where_the_last_one_ended_whatever_is_added,
    what_changes_is_written_anew,
    trials_that_come_and_go_are_news_of_their_ship,
    tags_are_put_on_and_taken_off,
    notes_have_an_author_and_stay,
    a_search_that_cannot_be_is_refused
);
