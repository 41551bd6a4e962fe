//! Behaviour of connections, byte by byte.

use std::time::{Duration, Instant};

use reqwest::StatusCode;
use serde_json::json;
use sistership_store::testing::TestDatabase;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::TcpStream;

use super::harness::{Harness, config};
use crate::{Config, Server};

const STALLED: &str = "POST /v1/ships HTTP/1.1\r\nHost: localhost\r\nContent-Type: \
    application/json\r\nContent-Length: 9000\r\n\r\n{";

async fn harness(change: impl FnOnce(&mut Config)) -> Harness {
    let database = TestDatabase::new_sqlite();
    let mut config = config(&database);
    change(&mut config);
    let client = reqwest::Client::builder().pool_max_idle_per_host(0).build().unwrap();
    Harness { server: Server::start(config).await.unwrap(), client, database }
}

impl Harness {
    async fn connect(&self, send: &str) -> TcpStream {
        let mut stream = TcpStream::connect(self.server.local_addr()).await.unwrap();
        stream.write_all(send.as_bytes()).await.unwrap();
        stream
    }

    /// Returns the answer to the bytes sent, until the server closes.
    async fn exchange(&self, send: &str) -> String {
        rest(self.connect(send).await).await
    }
}

/// Reads until the server closes, which it must within ten seconds.
async fn rest(mut stream: TcpStream) -> String {
    let mut all = Vec::new();
    let read = tokio::time::timeout(Duration::from_secs(10), stream.read_to_end(&mut all)).await;
    drop(read.expect("the server closes"));
    String::from_utf8_lossy(&all).into_owned()
}

#[tokio::test]
async fn a_body_that_does_not_come_is_given_up_and_a_slow_one_is_not() {
    let harness = harness(|config| {
        config.limits.body_grace = Duration::from_secs(1);
        config.limits.least_rate = 100;
    })
    .await;
    let start = Instant::now();
    let answer = harness.exchange(STALLED).await;
    assert!(answer.starts_with("HTTP/1.1 408") && answer.contains("too slowly"), "{answer}");
    assert!(start.elapsed() < Duration::from_secs(4), "{:?}", start.elapsed());
    let mut slow = harness
        .connect(
            &STALLED
                .replace("9000", "1001")
                .replace("HTTP/1.1\r\n", "HTTP/1.1\r\nConnection: close\r\n"),
        )
        .await;
    for _ in 0..10 {
        tokio::time::sleep(Duration::from_millis(300)).await;
        slow.write_all(&[b' '; 100]).await.unwrap();
    }
    let answer = rest(slow).await;
    assert!(
        answer.starts_with("HTTP/1.1 422") || answer.starts_with("HTTP/1.1 400"),
        "it was read: {answer}"
    );
    harness.server.stop().await;
}

#[tokio::test]
async fn who_sends_too_much_is_told_so() {
    let harness = harness(|_| ()).await;
    let head = "POST /v1/laws HTTP/1.1\r\nHost: localhost\r\nContent-Type: \
        application/yaml\r\nConnection: close\r\n";
    for bytes in [2 << 20, 12 << 20] {
        let mut stream = harness.connect(&format!("{head}Content-Length: {bytes}\r\n\r\n")).await;
        stream.write_all(&vec![b'a'; bytes]).await.unwrap();
        let answer = rest(stream).await;
        assert!(
            answer.starts_with("HTTP/1.1 413") && answer.contains("larger than the limit of"),
            "{bytes}: {answer}"
        );
    }
    let asks = harness
        .exchange(&format!(
            "{head}Expect: 100-continue\r\nContent-Length: 9\r\nHost: elsewhere\r\n\r\n"
        ))
        .await;
    assert!(
        asks.starts_with("HTTP/1.1 4"),
        "no body is asked for where it would not be read: {asks}"
    );
    harness.server.stop().await;
}

#[tokio::test]
async fn answers_that_nobody_reads_do_not_pile_up_and_end_the_connection() {
    let harness = harness(|config| {
        // The bytes that the system's buffers take earn almost no time.
        (config.limits.answer_grace, config.limits.least_rate) = (Duration::from_secs(2), 1 << 30);
    })
    .await;
    let request = "GET /openapi.json HTTP/1.1\r\nHost: localhost\r\n\r\n";
    let mut unread = harness.connect(request).await;
    let mut asked = 1;
    while tokio::time::timeout(Duration::from_millis(500), unread.write_all(request.as_bytes()))
        .await
        .is_ok_and(|sent| sent.is_ok())
    {
        asked += 1;
        if asked == 20_000 {
            break;
        }
    }
    tokio::time::sleep(Duration::from_secs(4)).await;
    let metrics =
        harness.client.get(harness.url("/metrics")).send().await.unwrap().text().await.unwrap();
    let line = metrics
        .lines()
        .find(|line| line.contains("requests_total") && line.contains("/openapi.json"))
        .unwrap();
    let answered: u64 = line.rsplit(' ').next().unwrap().parse().unwrap();
    assert!(answered < 200 && answered * 10 < asked, "{answered} of {asked} answered for nobody");
    let mut all = Vec::new();
    let read = tokio::time::timeout(Duration::from_secs(10), unread.read_to_end(&mut all))
        .await
        .expect("it has ended");
    assert!(read.is_err(), "it was cut, not answered: {} bytes", all.len());
    harness.server.stop().await;
}

#[tokio::test]
async fn a_connection_without_a_request_is_closed() {
    let harness = harness(|config| config.limits.header_time = Duration::from_secs(1)).await;
    for begun in ["", "GET /v1/ships HT", "GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n"] {
        harness.exchange(begun).await;
    }
    harness.server.stop().await;
}

#[tokio::test]
async fn who_stalls_gives_way_and_events_live_on() {
    let harness = harness(|config| {
        (config.limits.connections, config.limits.connections_per_address, config.workers) =
            (8, 8, 0);
    })
    .await;
    harness.create_ship().await;
    harness.upload_trials().await;
    let (_, job) =
        harness.post("/v1/refinements", &json!({ "ship": "demo-ship", "source": "auto" })).await;
    let events = harness.url(&format!("/v1/jobs/{}/events", job["id"].as_str().unwrap()));
    let mut followed = harness.client.get(&events).send().await.unwrap();
    assert!(followed.chunk().await.unwrap().is_some());
    let mut stalled = Vec::new();
    for _ in 0..40 {
        stalled.push(harness.connect(STALLED).await);
    }
    tokio::time::sleep(Duration::from_millis(600)).await;
    for _ in 0..20 {
        let start = Instant::now();
        assert_eq!(
            harness.client.get(harness.url("/v1/ships")).send().await.unwrap().status(),
            200
        );
        assert!(start.elapsed() < Duration::from_secs(1), "{:?}", start.elapsed());
    }
    let quiet = tokio::time::timeout(Duration::from_millis(300), followed.chunk()).await;
    assert!(quiet.is_err(), "the events go on: {quiet:?}");
    harness.server.stop().await;
}

#[tokio::test]
async fn where_all_are_at_work_the_rest_is_refused_and_health_answers() {
    let harness = harness(|config| {
        (config.limits.connections, config.limits.connections_per_address, config.workers) =
            (4, 4, 0);
    })
    .await;
    harness.create_ship().await;
    harness.upload_trials().await;
    let (_, job) =
        harness.post("/v1/refinements", &json!({ "ship": "demo-ship", "source": "auto" })).await;
    let events = harness.url(&format!("/v1/jobs/{}/events", job["id"].as_str().unwrap()));
    let mut held = Vec::new();
    for _ in 0..4 {
        let mut followed = harness.client.get(&events).send().await.unwrap();
        assert!(followed.chunk().await.unwrap().is_some());
        held.push(followed);
    }
    let start = Instant::now();
    let refused = harness.client.get(harness.url("/v1/ships")).send().await.unwrap();
    assert_eq!(
        (refused.status(), start.elapsed() < Duration::from_secs(4)),
        (StatusCode::SERVICE_UNAVAILABLE, true)
    );
    assert!(
        refused.headers().contains_key("retry-after")
            && refused.headers().contains_key("x-request-id")
    );
    for path in ["/healthz", "/readyz"] {
        assert_eq!(
            harness.client.get(harness.url(path)).send().await.unwrap().status(),
            200,
            "{path}"
        );
    }
    held.pop();
    tokio::time::sleep(Duration::from_millis(300)).await;
    assert_eq!(harness.client.get(harness.url("/v1/ships")).send().await.unwrap().status(), 200);
    harness.server.stop().await;
}

#[tokio::test]
async fn without_the_key_no_body_is_awaited_and_guesses_are_throttled() {
    let harness = harness(|config| config.api_key = Some("sesame".into())).await;
    let start = Instant::now();
    let answer = harness.exchange(STALLED).await;
    assert!(
        answer.starts_with("HTTP/1.1 401") && start.elapsed() < Duration::from_secs(5),
        "{answer}"
    );
    let ask =
        |key: &'static str| harness.client.get(harness.url("/v1/ships")).bearer_auth(key).send();
    for _ in 0..10 {
        assert_eq!(ask("open").await.unwrap().status(), 401);
    }
    let throttled = ask("open").await.unwrap();
    assert_eq!(throttled.status(), StatusCode::TOO_MANY_REQUESTS);
    let wait: u64 = throttled.headers()["retry-after"].to_str().unwrap().parse().unwrap();
    assert!((1..=60).contains(&wait) && throttled.headers()["connection"] == "close");
    assert_eq!(ask("sesame").await.unwrap().status(), 200, "nobody can shut the owner out");
    harness.server.stop().await;
}

#[tokio::test]
async fn requests_are_addressed_to_this_server_and_to_no_other() {
    let harness = harness(|_| {}).await;
    let own = format!("http://{}", harness.server.local_addr());
    let host = format!("Host: {}\r\n", harness.server.local_addr());
    let post = |headers: &str| {
        format!(
            "POST /v1/refinements HTTP/1.1\r\nConnection: close\r\nContent-Length: \
             0\r\n{headers}\r\n"
        )
    };
    let get = |version: &str, headers: &str| {
        format!("GET /v1/ships HTTP/{version}\r\nConnection: close\r\n{headers}\r\n")
    };
    let cases = [
        (get("1.1", &host), 200),
        (get("1.1", "Host: localhost\r\nHost: localhost\r\n"), 400),
        (get("1.1", "Host: localhost\r\nHost: evil.example\r\n"), 400),
        (get("1.1", "Host: \u{e9}\r\n"), 400),
        (get("1.1", ""), 400),
        (get("1.0", ""), 200),
        (get("1.1", "Host: evil.example\r\n"), 403),
        (get("1.1", &format!("{host}Sec-Fetch-Site: cross-site\r\n")), 200),
        (post(&host), 415),
        (post(&format!("{host}Origin: {own}\r\nSec-Fetch-Site: same-origin\r\n")), 415),
        (post(&format!("{host}Sec-Fetch-Site: cross-site\r\n")), 403),
        (post(&format!("{host}Sec-Fetch-Site: same-site\r\n")), 403),
        (post(&format!("{host}Origin: {}\r\n", own.replace("http:", "https:"))), 403),
        (post(&format!("{host}Origin: null\r\n")), 403),
    ];
    for (request, status) in cases {
        let answer = harness.exchange(&request).await;
        assert!(
            answer.starts_with(&format!(
                "HTTP/1.{} {status}",
                u8::from(!request.contains("HTTP/1.0"))
            )),
            "{request}: {answer}"
        );
    }
    harness.server.stop().await;
}
