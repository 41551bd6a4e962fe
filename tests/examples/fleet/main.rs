//! A whole fleet in one bulk refinement: ships with trials are loaded, listed, searched, learned
//! from and refined.
//!
//! `cargo run --release -p sistership-tests --example fleet -- 10000 10` (in ten families, one by
//! default, each refined by one bulk job; four trials a ship; SQLite in a temporary folder, or
//! `SISTERSHIP_DATABASE_URL`). Prints ships a second for each step, so that the cost a ship can be
//! compared between sizes, and the times of searches. Of several families the last is told about.

mod search;

use std::time::{Duration, Instant};

use sistership_api::{Config, Workers};
use sistership_jobs::Archive;
use sistership_jobs::fleet::{
    BulkProgress, BulkRefinementRequest, PriorChoice, Rule, learn_family_prior, order_refinement,
};
use sistership_store::{FamilyRefinement, MAX_LIMIT, PageRequest, Store};
use sistership_tests::fleet::{FOUNDATION, Yard, name};

const TRIALS: usize = 4;
const WORKERS: usize = 2;
const POLL: Duration = Duration::from_millis(10);

#[tokio::main]
async fn main() {
    let number = |place: usize, usual: usize| {
        std::env::args().nth(place).map_or(usual, |count| count.parse().expect("a number"))
    };
    let (ships, families) = (number(1, 100), number(2, 1));
    let folder = tempfile::tempdir().expect("a folder");
    let mut config = Config::new(folder.path());
    if let Ok(url) = std::env::var("SISTERSHIP_DATABASE_URL") {
        config.database_url = url;
    }
    config.workers = WORKERS;
    // A worker with nothing to do looks for work twice a second, which is most of what a small
    // fleet takes; not measured here.
    config.leases.poll = POLL;
    let begun = Workers::start(Config { workers: 0, ..config.clone() }).await.expect("the zoo");
    let (archive, store) = (begun.archive().clone(), begun.archive().store.clone());
    timed("loaded", ships, load(&archive, ships, families)).await;
    timed("listed", ships, list(&store, families)).await;
    search::tag(&archive, ships).await;
    timed("indexed", ships, search::index(&archive)).await;
    search::search(&config, ships).await;
    let learned_from = ships.min(1000 * families);
    timed(
        "statistics made, and learned from (at most 1000 a family)",
        learned_from,
        teach(&archive, families),
    )
    .await;
    let workers = Workers::start(config.clone()).await.expect("workers");
    for (what, prior) in [
        ("refined, statistics made on the way where there were none", PriorChoice::Family),
        ("refined from stored statistics", PriorChoice::Family),
        ("refined about the foundation", PriorChoice::Foundation),
    ] {
        timed(what, ships, refine(&store, families, prior)).await;
    }
    workers.stop().await;
    timed("indexed with the metrics of their champions", ships, search::index(&archive)).await;
    search::search(&config, ships).await;
    begun.stop().await;
}

async fn timed(what: &str, ships: usize, work: impl Future<Output = String>) {
    let begun = Instant::now();
    let said = work.await;
    let seconds = begun.elapsed().as_secs_f64();
    println!(
        "{ships} ships {what}: {seconds:.1} s, {:.0} ships/s, {:.2} ms a ship{said}",
        ships as f64 / seconds,
        1e3 * seconds / ships as f64
    );
}

/// The name of a family.
fn family(number: usize) -> String {
    format!("sisters-{number}")
}

async fn load(archive: &Archive, ships: usize, families: usize) -> String {
    Yard::new().launch(&archive.store, &archive.objects, 0..ships, TRIALS).await;
    let foundation =
        archive.store.versions().get(FOUNDATION, 1).await.expect("the foundation").head;
    for number in 0..families {
        let (own, members): (String, Vec<String>) =
            (family(number), (number..ships).step_by(families).map(name).collect());
        archive.store.families().create(&own, "Sisters", &foundation.id).await.expect("a family");
        archive.store.families().add_members(&own, &members).await.expect("members");
    }
    format!(" ({} trials, {families} families)", ships * TRIALS)
}

async fn list(store: &Store, families: usize) -> String {
    let mut pages = 0;
    for number in 0..families {
        pages += pages_of(store, &family(number)).await;
    }
    format!(" ({pages} pages)")
}

async fn pages_of(store: &Store, family: &str) -> usize {
    let (mut page, mut pages) = (PageRequest::first_page(MAX_LIMIT), 0);
    loop {
        let list = store.families().list_members(family, &page).await.expect("members");
        pages += 1;
        let Some(next) = list.next else { return pages };
        page = PageRequest::after_key(next, MAX_LIMIT);
    }
}

async fn teach(archive: &Archive, families: usize) -> String {
    let mut said = String::new();
    for number in 0..families {
        let prior =
            learn_family_prior(archive, &family(number), &|_, _| true).await.expect("a prior");
        let document = serde_json::to_string(&prior).expect("a document");
        archive
            .store
            .families()
            .insert_prior(&family(number), &document)
            .await
            .expect("a kept prior");
        said = format!(" ({} steps, design effect {:.1})", prior.steps, prior.design_effect);
    }
    said
}

/// All families at once, one bulk job each.
async fn refine(store: &Store, families: usize, prior: PriorChoice) -> String {
    let asked = BulkRefinementRequest {
        prior,
        rule: Rule { no_worse_than: Some(0.02) },
        ..BulkRefinementRequest::default()
    };
    let mut bulks = Vec::new();
    for number in 0..families {
        bulks.push(order_refinement(store, &family(number), &asked).await.expect("a refinement"));
    }
    let mut last = String::new();
    for bulk in &bulks {
        let standing = until_done(store, bulk).await;
        assert_eq!((standing.state, standing.done), ("succeeded", bulk.ships), "{standing:?}");
        last = format!(" {:?}", standing.outcomes);
    }
    last
}

async fn until_done(store: &Store, bulk: &FamilyRefinement) -> BulkProgress {
    loop {
        let standing = BulkProgress::read_current(store, bulk).await.expect("its standing");
        if !matches!(standing.state, "queued" | "running") {
            return standing;
        }
        tokio::time::sleep(POLL).await;
    }
}
