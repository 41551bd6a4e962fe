//! A hundred thousand ships and a million versions feel like ten.
//!
//! `cargo test --release -p sistership-store --test store -- --ignored --nocapture scale` prints
//! the times of each list and look-up with few rows and with many. `SCALE_SHIPS=10000` is a smaller
//! one. Documents are as long as real ones, and do not compress: a look-up that came across them
//! would read gigabytes.

use std::time::{Duration, Instant};

use futures::future::join_all;
use sistership_store::{FactRange, JobFilter, JobState, PageRequest, ShipSearch};

use crate::support::*;

/// How often each is asked; the median counts.
const TIMES: usize = 21;
/// What a page may take with many rows.
const MOST: Duration = Duration::from_millis(50);

fn numbers(count: usize) -> String {
    format!("WITH RECURSIVE n (i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < {count})")
}

/// A document of so many bytes.
fn document(on: &TestStore, bytes: usize) -> String {
    match on.database.url.starts_with("sqlite") {
        true => format!("'\"' || hex(randomblob({})) || '\"'", bytes / 2),
        false => format!("'\"' || repeat(md5(name || created_us), {}) || '\"'", bytes / 32),
    }
}

/// On PostgreSQL what is repeated would otherwise be packed into nothing.
async fn unpacked(on: &TestStore) {
    if !on.database.url.starts_with("sqlite") {
        for table in ["ships", "versions"] {
            on.database
                .execute_unchecked(&format!(
                    "ALTER TABLE {table} ALTER document SET STORAGE EXTERNAL"
                ))
                .await;
        }
    }
}

/// Fills the tables as a large fleet would: ten categories, four facts, ten versions and two jobs a
/// ship, each hundredth tagged.
async fn fill(on: &TestStore, ships: usize) {
    let n = numbers(ships);
    let ten = numbers(10);
    let (of_ship, of_version) = (document(on, 2000), document(on, 4000));
    unpacked(on).await;
    for sql in [
        format!("INSERT INTO ships SELECT name, 'Ship ' || name, 'category-' || (created_us % 10), \
            {of_ship}, 1, created_us, created_us, NULL FROM ({n} SELECT i AS created_us, 'ship-' \
            || (1000000 + i) AS name FROM n) AS k"),
        "INSERT INTO ship_facts SELECT name, 'lpp_m', 1.0 * ((created_us * 7919) % 100003) FROM \
         ships".into(),
        "INSERT INTO ship_facts SELECT name, 'beam_m', 1.0 * ((created_us * 104729) % 100003) FROM \
         ships".into(),
        "INSERT INTO ship_facts SELECT name, 'diameter_m', 1.0 * ((created_us * 1299709) % 100003) \
         FROM ships".into(),
        "INSERT INTO ship_facts SELECT name, 'overshoot_deg', 1.0 * ((created_us * 15485863) % \
         100003) FROM ships".into(),
        "INSERT INTO ship_vectors SELECT name, category, \
            '{\"mei-2019\":{\"C_b\":0.8,\"L/B\":5.5,\"B/T\":2.8,\"L/V0\":40.1}}' FROM ships".into(),
        "INSERT INTO ship_tags SELECT name, 'own' FROM ships WHERE created_us % 100 = 0".into(),
        "INSERT INTO models SELECT name, 11 FROM ships".into(),
        format!("INSERT INTO versions SELECT name || '-' || (10 + i), name, i, NULL, 'law', \
            'published', {of_version}, 'x', created_us, NULL, 'ann' FROM ships, ({ten} SELECT i FROM n) AS k"),
        "INSERT INTO aliases SELECT name, 'champion', 10, 1 FROM ships".into(),
        "INSERT INTO jobs SELECT name || '-a', 'refinement', name, '{}', 'succeeded', 1, '', '{}', \
            NULL, 1, 1, NULL, NULL, 0, 0, 0, 0, 0, 'ann', 1, NULL FROM ships".into(),
        "INSERT INTO jobs SELECT name || '-b', 'diagnosis', name, '{}', 'failed', 1, '', NULL, \
            'x', 1, 1, NULL, NULL, 0, 0, 0, 0, 0, 'ann', 1, NULL FROM ships".into(),
        "ANALYZE".into(),
    ] {
        on.database.execute_unchecked(&sql).await;
    }
}

async fn median<T>(work: impl AsyncFn() -> T) -> Duration {
    let mut times = Vec::new();
    for _ in 0..TIMES {
        let start = Instant::now();
        work().await;
        times.push(start.elapsed());
    }
    times.sort_unstable();
    times[TIMES / 2]
}

/// The times of everything that lists or looks up.
async fn times(on: &TestStore, ships: usize) -> Vec<(&'static str, Duration)> {
    let (store, middle) = (&on.store, format!("ship-{}", 1_000_000 + ships / 2));
    let range = |fact: &str, min: f64| FactRange { fact: fact.into(), min, max: 1e9 };
    let by = |ranges| ShipSearch { ranges, ..ShipSearch::default() };
    let category = ShipSearch { category: Some("category-7".into()), ..ShipSearch::default() };
    let page = |name: &str| PageRequest { after: Some((None, name.to_owned())), limit: 100 };
    let find = async |search: &ShipSearch, page: PageRequest<_>| {
        store.ships().search_ships(search, &page).await.unwrap()
    };
    let failed = JobFilter { state: Some(JobState::Failed), ..JobFilter::default() };
    let of_one = JobFilter { ship: Some(middle.clone()), ..JobFilter::default() };
    let (both, long) = (
        by(vec![range("lpp_m", 0.0), range("diameter_m", 50_000.0)]),
        by(vec![range("lpp_m", 0.0)]),
    );
    let few = by(vec![range("lpp_m", 0.0), range("diameter_m", 99_000.0)]);
    let tag = ShipSearch { tag: Some("own".into()), ..ShipSearch::default() };
    let tagged = ShipSearch { tag: Some("own".into()), ..long };
    // Tagged ones are of category 0, so that this finds nothing however far it looks.
    let none = ShipSearch {
        tag: Some("own".into()),
        category: Some("category-7".into()),
        ..ShipSearch::default()
    };
    let last = store.versions().get(&middle, 10).await.unwrap().head.id;
    let many = async || {
        let names = (1..=64).map(|i| format!("ship-{}", 1_000_000 + i * ships / 64));
        join_all(names.map(|name| async move {
            store.versions().current_version(&name, "champion").await.unwrap()
        }))
        .await
    };
    vec![
        (
            "ships by name, from the middle",
            median(async || find(&ShipSearch::default(), page(&middle)).await).await,
        ),
        (
            "ships of a category, from the middle",
            median(async || find(&category, page(&middle)).await).await,
        ),
        ("ships with a tag", median(async || find(&tag, page("")).await).await),
        (
            "ships by a range",
            median(async || find(&by(vec![range("lpp_m", 50_000.0)]), page("")).await).await,
        ),
        ("ships by two ranges", median(async || find(&both, page("")).await).await),
        (
            "ships by a range and a second of which one in a hundred is",
            median(async || find(&few, page("")).await).await,
        ),
        (
            "ships by a range, with a tag that one in a hundred has",
            median(async || find(&tagged, page("")).await).await,
        ),
        (
            "ships with a tag and of a category, none",
            median(async || find(&none, page("")).await).await,
        ),
        (
            "vectors of a category",
            median(async || store.ships().similarity_vectors(&category).await.unwrap()).await,
        ),
        (
            "champion",
            median(async || {
                store.versions().current_version(&middle, "champion").await.unwrap().unwrap()
            })
            .await,
        ),
        ("64 champions at once", median(many).await),
        ("a version by id", median(async || store.versions().by_id(&last).await.unwrap()).await),
        (
            "versions made from a version",
            median(async || {
                store.versions().list_children(&last, &PageRequest::first_page(100)).await.unwrap()
            })
            .await,
        ),
        (
            "versions of a model",
            median(async || {
                store.versions().list(&middle, &PageRequest::first_page(100)).await.unwrap()
            })
            .await,
        ),
        (
            "jobs",
            median(async || {
                store
                    .jobs()
                    .list(&JobFilter::default(), &PageRequest::first_page(100))
                    .await
                    .unwrap()
            })
            .await,
        ),
        (
            "jobs in a state",
            median(async || {
                store.jobs().list(&failed, &PageRequest::first_page(100)).await.unwrap()
            })
            .await,
        ),
        (
            "jobs of a ship",
            median(async || {
                store.jobs().list(&of_one, &PageRequest::first_page(100)).await.unwrap()
            })
            .await,
        ),
        ("counts of jobs", median(async || store.jobs().count_by_state().await.unwrap()).await),
    ]
}

/// What cannot but look at all of something.
const LINEAR: [&str; 2] = ["vectors of a category", "counts of jobs"];

async fn scale(few: &TestStore, many: &TestStore) {
    let ships = std::env::var("SCALE_SHIPS").map_or(100_000, |ships| ships.parse().unwrap());
    let start = Instant::now();
    fill(few, 10).await;
    fill(many, ships).await;
    println!(
        "{ships} ships, {} versions filled in {:.0} s",
        10 * ships,
        start.elapsed().as_secs_f64()
    );
    println!("| | 10 ships, ms | {ships} ships, ms |\n| --- | --- | --- |");
    let mut slow = Vec::new();
    for ((what, few), (_, many)) in times(few, 10).await.into_iter().zip(times(many, ships).await) {
        println!("| {what} | {:.2} | {:.2} |", 1e3 * few.as_secs_f64(), 1e3 * many.as_secs_f64());
        slow.extend((many >= MOST && !LINEAR.contains(&what)).then_some(what));
    }
    assert!(slow.is_empty(), "longer than {MOST:?}: {slow:?}");
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
#[ignore = "takes minutes and gigabytes; see the head of the file"]
async fn scale_on_sqlite() {
    scale(&TestDatabase::new_sqlite().open().await, &TestDatabase::new_sqlite().open().await).await;
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
#[ignore = "takes minutes and gigabytes; see the head of the file"]
async fn scale_on_postgres() {
    let (Some(few), Some(many)) =
        (TestDatabase::new_postgres().await, TestDatabase::new_postgres().await)
    else {
        return;
    };
    scale(&few.open().await, &many.open().await).await;
}
