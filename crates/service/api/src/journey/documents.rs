//! Documents that are too deep or too large are refused with field and limit, and the server goes
//! on.

use std::sync::Arc;
use std::time::{Duration, Instant};

use serde_json::json;
use sistership_store::testing::TestDatabase;
use sistership_store::{Store, SystemClock};

use super::harness::{Harness, SHIP, read};

fn around(open: &str, count: usize, close: &str) -> String {
    format!("{}1{}", open.repeat(count), close.repeat(count))
}

fn law(rest: &str, terms: &str) -> String {
    format!(
        "kind: law\nname: tried\ntitle: tried\nsources: {{}}\nvalues: {{ U: '{rest}' }}\nfactors: \
         {{ u: u, v: v, r: r }}\naxes:\n  X: {{ terms: [{terms}] }}\n  Y: {{ terms: [Y_v] }}\n  N: \
         {{ terms: [N_r] }}\nmass: {{ X: {{ X: mass_kg }}, Y: {{ Y: mass_kg }}, N: {{ N: \
         mass_kg*lpp_m^2 }} }}\n"
    )
}

/// Route, body and text of its refusal.
fn hostile() -> Vec<(&'static str, String, &'static str)> {
    let values = [
        around("(", 1_609, ")"),
        around("-", 10_000, ""),
        around("sqrt(", 10_000, ")"),
        around("", 10_000, "^2"),
        around("", 3_355, "+1"),
    ];
    let mut all: Vec<_> =
        values.into_iter().map(|value| ("/v1/laws", law(&value, "X_u"), "values.U")).collect();
    all.push(("/v1/laws", law("1", &"X_u, ".repeat(3_320)), "the limit is 1500"));
    all.push(("/v1/laws", "{a: ".repeat(50_000), "64 deep"));
    all.push(("/v1/laws", format!("[{}", "1,".repeat(450_000)), "the limit is"));
    let deep = format!("lpp_m: \"{}\"", around("(", 10_000, ")"));
    all.push(("/v1/ships", SHIP.replace("lpp_m: 175.0", &deep), "lpp_m"));
    all.push(("/v1/ships", format!("{SHIP}note: {}", "[".repeat(50_000)), "64 deep"));
    all.push(("/v1/ships", format!("{SHIP}note: &x a\nother: *x\n"), "alias"));
    all
}

#[tokio::test]
async fn hostile_documents_are_refused_at_once() {
    let harness = Harness::on(TestDatabase::new_sqlite()).await;
    for (path, body, words) in hostile() {
        let began = Instant::now();
        let post = harness
            .client
            .post(harness.url(path))
            .header("content-type", "application/yaml")
            .body(body);
        let (status, problem) = read(post.send().await.unwrap()).await;
        assert_eq!(status, 422, "{words}: {problem}");
        let said = problem.to_string();
        assert!(said.contains(words) && said.len() < 4000, "{words}: {said}");
        assert!(began.elapsed() < Duration::from_secs(4), "{words}: {:?}", began.elapsed());
    }
    for path in ["/v1/refinements", "/v1/predictions", "/v1/families", "/v1/ships"] {
        let body = "[".repeat(100_000);
        let post = harness
            .client
            .post(harness.url(path))
            .header("content-type", "application/json")
            .body(body);
        let (status, problem) = read(post.send().await.unwrap()).await;
        assert!(status.is_client_error(), "{path}: {problem}");
    }
    assert_eq!(harness.get("/v1/ships?limit=1").await["items"].as_array().unwrap().len(), 1);
    harness.server.stop().await;
}

/// Returns a law whose values nest as deeply as the limit allows, with this number of terms.
fn deep(terms: usize) -> String {
    let values: String = (0..240).map(|n| format!(", a{}: a{n} + 0", n + 1)).collect();
    let symbols: Vec<String> = (0..56_u8)
        .map(|n| format!("F{}{}", char::from(b'A' + n / 8), char::from(b'a' + n % 8)))
        .collect();
    let factors: String = symbols
        .iter()
        .enumerate()
        .map(|(n, symbol)| format!(", {symbol}: '(1 + 0.01*{n})*u'"))
        .collect();
    let pairs = symbols
        .iter()
        .enumerate()
        .flat_map(|(n, a)| symbols[n..].iter().map(move |b| format!("X_{a}{b}")));
    let terms: Vec<String> = pairs.take(terms).collect();
    format!(
        "kind: law\nname: deep\ntitle: deep\nsources: {{}}\nvalues: {{ a0: '1'{values} \
         }}\nfactors: {{ u: u, v: v, r: r{factors} }}\naxes:\n  X: {{ terms: [{}], rest: \
         'a240*0.0*mass_kg*g' }}\n  Y: {{ terms: [Y_v, Y_r] }}\n  N: {{ terms: [N_v, N_r] \
         }}\nmass: {{ X: {{ X: mass_kg }}, Y: {{ Y: mass_kg }}, N: {{ N: 0.06*mass_kg*lpp_m^2 }} \
         }}\n",
        terms.join(", ")
    )
}

#[tokio::test(flavor = "multi_thread")]
async fn jobs_on_a_law_as_deep_as_may_be_end_and_the_server_goes_on() {
    jobs_on_a_law_of(200).await;
}

/// `cargo test --workspace --lib as_large_as_may_be -- --ignored --nocapture`
#[tokio::test(flavor = "multi_thread")]
#[ignore = "nine minutes in a build for tests"]
async fn jobs_on_a_law_as_large_as_may_be_end_and_the_server_goes_on() {
    jobs_on_a_law_of(1490).await;
}

async fn jobs_on_a_law_of(terms: usize) {
    let harness = Harness::on(TestDatabase::new_sqlite()).await;
    harness.create_ship().await;
    harness.upload_trials().await;
    let post = harness
        .client
        .post(harness.url("/v1/laws"))
        .header("content-type", "application/yaml")
        .body(deep(terms));
    let (status, said) = read(post.send().await.unwrap()).await;
    assert_eq!(status, 201, "{said}");
    for method in ["weak", "trajectory"] {
        let asked = json!({ "ship": "demo-ship", "source": "auto", "law": "deep",
            "settings": { "method": method } });
        let (status, job) = harness.post("/v1/refinements", &asked).await;
        assert_eq!(status, 202, "{job}");
        let job = harness.follow(job["id"].as_str().unwrap()).await;
        assert!(
            ["succeeded", "failed"].contains(&job["state"].as_str().unwrap()),
            "{method}: {job}"
        );
    }
    assert_eq!(harness.get("/v1/ships?limit=1").await["items"].as_array().unwrap().len(), 1);
    harness.server.stop().await;
}

#[tokio::test(flavor = "multi_thread")]
async fn a_law_that_an_earlier_release_took_fails_what_uses_it_and_nothing_else() {
    let database = TestDatabase::new_sqlite();
    let store = Store::connect(&database.url, Arc::new(SystemClock)).await.unwrap();
    let endless = law("1", &"X_u, ".repeat(3_320)).replace("name: tried", "name: endless");
    store.laws().insert("endless", &endless).await.unwrap();
    drop(store);
    let harness = Harness::on(database).await;
    harness.create_ship().await;
    harness.upload_trials().await;
    let asked = json!({ "ship": "demo-ship", "law": "endless", "settings": { "method": "weak" } });
    let (status, said) = harness.post("/v1/refinements", &asked).await;
    assert_eq!(status, 202, "{said}");
    let job = harness.follow(said["id"].as_str().unwrap()).await;
    assert!(job["state"] == "failed" && job["error"].to_string().contains("endless"), "{job}");
    let (status, job) = harness.post("/v1/refinements", &json!({ "ship": "demo-ship" })).await;
    assert_eq!(status, 202, "{job}");
    assert_eq!(harness.follow(job["id"].as_str().unwrap()).await["state"], "succeeded");
    harness.server.stop().await;
}
