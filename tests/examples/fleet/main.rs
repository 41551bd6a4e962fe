//! A whole fleet in one bulk refinement: ships with trials are loaded, listed, searched, learned from and refined.
//!
//! `cargo run --release -p sistership-tests --example fleet -- 10000` (four trials a ship; SQLite in a temporary folder, or
//! `SISTERSHIP_DATABASE_URL`). Prints ships a second for each step, so that the cost a ship can be compared between sizes, and the
//! times of searches.

mod search;

use std::time::{Duration, Instant};

use sistership_server::fleet::{Asked, PriorChoice, Rule, Standing, learn, order_refinement};
use sistership_server::{Archive, Config, Workers};
use sistership_store::{Bulk, MAX_LIMIT, Page, Store};
use sistership_tests::fleet::{FOUNDATION, Yard, name};

const TRIALS: usize = 4;
const WORKERS: usize = 2;
const POLL: Duration = Duration::from_millis(10);

#[tokio::main]
async fn main() {
    let ships: usize = std::env::args().nth(1).map_or(100, |count| count.parse().expect("a number of ships"));
    let folder = tempfile::tempdir().expect("a folder");
    let mut config = Config::new(folder.path());
    if let Ok(url) = std::env::var("SISTERSHIP_DATABASE_URL") {
        config.database_url = url;
    }
    config.workers = WORKERS;
    // A worker with nothing to do looks for work twice a second, which is most of what a small fleet takes; not measured here.
    config.leases.poll = POLL;
    let begun = Workers::start(Config { workers: 0, ..config.clone() }).await.expect("the zoo");
    let (archive, store) = (begun.archive().clone(), begun.archive().store.clone());
    timed("loaded", ships, load(&archive, ships)).await;
    timed("listed", ships, list(&store)).await;
    search::tag(&archive, ships).await;
    timed("indexed", ships, search::index(&archive)).await;
    search::search(&config, ships).await;
    timed("statistics made, and learned from (at most 1000)", ships.min(1000), teach(&archive)).await;
    let workers = Workers::start(config.clone()).await.expect("workers");
    for (what, prior) in [
        ("refined, statistics made on the way where there were none", PriorChoice::Family),
        ("refined from stored statistics", PriorChoice::Family),
        ("refined about the foundation", PriorChoice::Foundation),
    ] {
        timed(what, ships, refine(&store, prior)).await;
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

async fn load(archive: &Archive, ships: usize) -> String {
    Yard::new().launch(&archive.store, &archive.objects, 0..ships, TRIALS).await;
    let foundation = archive.store.versions().get(FOUNDATION, 1).await.expect("the foundation").head;
    archive.store.families().create("sisters", "Sisters", &foundation.id).await.expect("a family");
    let members: Vec<String> = (0..ships).map(name).collect();
    archive.store.families().add("sisters", &members).await.expect("members");
    format!(" ({} trials)", ships * TRIALS)
}

async fn list(store: &Store) -> String {
    let (mut page, mut pages) = (Page::first(MAX_LIMIT), 0);
    loop {
        let list = store.families().members("sisters", &page).await.expect("members");
        pages += 1;
        let Some(next) = list.next else { return format!(" ({pages} pages)") };
        page = Page::after(next, MAX_LIMIT);
    }
}

async fn teach(archive: &Archive) -> String {
    let prior = learn(archive, "sisters", &|_, _| true).await.expect("a prior");
    let document = serde_json::to_string(&prior).expect("a document");
    archive.store.families().teach("sisters", &document).await.expect("a kept prior");
    format!(" ({} steps, design effect {:.1})", prior.steps, prior.design_effect)
}

async fn refine(store: &Store, prior: PriorChoice) -> String {
    let asked = Asked { prior, rule: Rule { no_worse_than: Some(0.02) }, ..Asked::default() };
    let bulk = order_refinement(store, "sisters", &asked).await.expect("a refinement");
    let standing = until_done(store, &bulk).await;
    assert_eq!((standing.state, standing.done), ("succeeded", bulk.ships), "{standing:?}");
    format!(" {:?}", standing.outcomes)
}

async fn until_done(store: &Store, bulk: &Bulk) -> Standing {
    loop {
        let standing = Standing::of(store, bulk).await.expect("its standing");
        if !matches!(standing.state, "queued" | "running") {
            return standing;
        }
        tokio::time::sleep(POLL).await;
    }
}
