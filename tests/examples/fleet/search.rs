//! Searches of a fleet as its users make them: over HTTP, page by page, and how long each answer
//! takes.

use std::time::{Duration, Instant};

use reqwest::Client;
use serde_json::Value;
use sistership_api::{Config, Server};
use sistership_jobs::{Archive, search};
use sistership_tests::fleet::name;

/// How often each kind of search is made, each time with other words.
const TIMES: usize = 50;
/// One ship in so many has the tag.
const TAGGED: usize = 100;
const TAG: &str = "own";

/// Puts the tag on some ships.
pub async fn tag(archive: &Archive, ships: usize) {
    for ship in (0..ships).step_by(TAGGED) {
        archive.store.ships().add_tag(&name(ship), TAG).await.expect("a tag");
    }
}

/// Writes down what ships are found by, as a server does behind each change.
pub async fn index(archive: &Archive) -> String {
    search::update_index(archive).await.expect("facts");
    String::new()
}

/// Times each kind of search on a server of its own, and prints the times.
pub async fn search(config: &Config, ships: usize) {
    let mut config = Config { workers: 0, ..config.clone() };
    config.listen.set_port(0);
    let server = Server::start(config).await.expect("a server");
    let (client, url) = (Client::new(), server.url());
    println!(
        "| search of {ships} ships, {TIMES} of each kind | p50, ms | slowest, ms | ships on the \
         page, mean |"
    );
    println!("| --- | --- | --- | --- |");
    for (what, query) in kinds() {
        let ask = async |turn: usize, next: Option<String>| {
            let after = next.map_or_else(String::new, |next| format!("&after={next}"));
            ask(&client, &format!("{url}/v1/ships?limit=100&{}{after}", query(turn, ships))).await
        };
        print(what, ask).await;
    }
    server.stop().await;
}

/// Asks again and again, and prints how long it took. A search whose words are always the same
/// turns the page.
async fn print(what: &str, ask: impl AsyncFn(usize, Option<String>) -> (usize, Option<String>)) {
    let (mut times, mut found, mut next) = (Vec::new(), 0, None);
    for turn in 0..TIMES {
        let begun = Instant::now();
        let (count, behind) = ask(turn, next.take()).await;
        times.push(begun.elapsed());
        found += count;
        next = behind.filter(|_| what.contains(PAGED));
    }
    times.sort_unstable();
    let ms = |time: Duration| 1e3 * time.as_secs_f64();
    println!(
        "| {what} | {:.2} | {:.2} | {} |",
        ms(times[TIMES / 2]),
        ms(times[TIMES - 1]),
        found / TIMES
    );
}

const PAGED: &str = "page after page";

type Query = fn(usize, usize) -> String;

/// What users ask; the turn chooses the words.
fn kinds() -> [(&'static str, Query); 9] {
    [
        ("by name, page after page", |_, _| String::new()),
        ("category, page after page", |_, _| "category=dry-cargo".to_owned()),
        ("category and tag", |_, _| format!("category=dry-cargo&tag={TAG}")),
        ("range of a particular", |turn, _| {
            format!("particular=lpp_m:{:.1}..{:.1}", length(turn), length(turn) + 5.0)
        }),
        ("ranges of two particulars", |turn, _| {
            format!(
                "particular=lpp_m:{:.1}..&particular=draught_m:..{:.2}",
                length(turn),
                8.0 + 0.01 * turn as f64
            )
        }),
        ("range and tag", |turn, _| format!("particular=lpp_m:{:.1}..&tag={TAG}", length(turn))),
        ("range of a metric of the champion", |turn, _| {
            format!("metric=turn_35.tactical_diameter_m:{}..", 400 + 10 * turn)
        }),
        ("most similar to a ship", |turn, ships| {
            format!("similar_to={}", name(turn * ships / TIMES))
        }),
        ("most similar to a ship, of a tag and above a length", |turn, ships| {
            format!(
                "similar_to={}&tag={TAG}&particular=lpp_m:{:.1}..",
                name(turn * ships / TIMES),
                length(turn)
            )
        }),
    ]
}

/// Lengths from those of the shortest ships to those of the longest.
fn length(turn: usize) -> f64 {
    128.0 + 60.0 * turn as f64 / TIMES as f64
}

/// How many ships an answer has, and what the next page goes on behind.
async fn ask(client: &Client, url: &str) -> (usize, Option<String>) {
    let answer = client.get(url).send().await.expect("an answer");
    let status = answer.status();
    let page: Value = answer.json().await.expect("a page");
    assert!(status.is_success(), "{url}: {page}");
    (page["items"].as_array().map_or(0, Vec::len), page["next"].as_str().map(str::to_owned))
}
