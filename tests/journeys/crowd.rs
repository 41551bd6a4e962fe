//! Hundreds of connections that stall, and those who want something of the server meanwhile.

use std::time::{Duration, Instant};

use reqwest::Method;
use sistership_store::testing::TestDatabase;
use sistership_tests::server::TestServer;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::TcpStream;

/// Connections of each kind that stall.
const STALLED: usize = 600;
/// Fresh connections that are timed, one at a time and then some at a time.
const TIMED: usize = 300;
const AT_A_TIME: usize = 4;
/// What a new connection may wait (p99), and the rounds of which one must keep it: a machine that
/// is busy with something else for a second is not the server's doing, but a server that is slow
/// stays so.
const BOUND: Duration = Duration::from_millis(50);
const ROUNDS: usize = 3;
const KEY: &str = "sesame";

/// What this process may open, raised as far as it may be.
fn raise_descriptors() {
    use rustix::process::{Resource, getrlimit, setrlimit};
    let mut limit = getrlimit(Resource::Nofile);
    limit.current = limit.maximum;
    setrlimit(Resource::Nofile, limit).expect("descriptors");
}

async fn connected(address: &str, send: &str) -> TcpStream {
    let mut stream = TcpStream::connect(address).await.expect("a connection");
    // A server that has had enough of it may close while this is sent.
    drop(tokio::time::timeout(Duration::from_millis(200), stream.write_all(send.as_bytes())).await);
    stream
}

/// Half of a request's body, and requests whose answers nobody reads.
fn stalling(key: Option<&str>) -> [String; 2] {
    // The unread answers need no key, the bodies would be refused at once without it.
    let authorised = key.map_or(String::new(), |key| format!("Authorization: Bearer {key}\r\n"));
    let body = format!(
        "POST /v1/ships HTTP/1.1\r\nHost: localhost\r\n{authorised}Content-Type: \
         application/json\r\nContent-Length: 9000\r\n\r\n{{"
    );
    [body, "GET /openapi.json HTTP/1.1\r\nHost: localhost\r\n\r\n".repeat(200)]
}

/// The time of one request over a connection of its own.
async fn timed(address: &str, key: Option<&str>) -> Duration {
    let authorised = key.map_or(String::new(), |key| format!("Authorization: Bearer {key}\r\n"));
    let request = format!(
        "GET /v1/ships HTTP/1.1\r\nHost: localhost\r\n{authorised}Connection: close\r\n\r\n"
    );
    let start = Instant::now();
    let mut stream = TcpStream::connect(address).await.expect("a connection");
    stream.write_all(request.as_bytes()).await.expect("it takes a request");
    let mut answer = Vec::new();
    stream.read_to_end(&mut answer).await.expect("an answer");
    assert!(answer.starts_with(b"HTTP/1.1 200"), "{}", String::from_utf8_lossy(&answer));
    start.elapsed()
}

/// Median and 99th percentile.
fn percentiles(mut times: Vec<Duration>) -> [Duration; 2] {
    times.sort();
    [times[times.len() / 2], times[times.len() * 99 / 100]]
}

async fn timed_together(address: &str, key: Option<&str>) -> Vec<Duration> {
    let mut times = Vec::new();
    for _ in 0..TIMED / AT_A_TIME {
        let tasks: Vec<_> = (0..AT_A_TIME)
            .map(|_| (address.to_owned(), key.map(str::to_owned)))
            .map(|(address, key)| {
                tokio::spawn(async move { timed(&address, key.as_deref()).await })
            })
            .collect();
        for task in tasks {
            times.push(task.await.expect("a time"));
        }
    }
    times
}

async fn quickly_answered(address: &str, key: Option<&str>, named: &str) -> bool {
    let mut alone = Vec::new();
    for _ in 0..TIMED {
        alone.push(timed(address, key).await);
    }
    let together = timed_together(address, key).await;
    let ([p50, p99], [p50_together, p99_together]) = (percentiles(alone), percentiles(together));
    println!(
        "{STALLED} stalled bodies and {STALLED} unread answers, {named}: /v1/ships over a new \
         connection p50 {p50:.1?}, p99 {p99:.1?}; \
         {AT_A_TIME} at a time p50 {p50_together:.1?}, p99 {p99_together:.1?}"
    );
    p99 < BOUND && p99_together < BOUND
}

async fn crowded(key: Option<&str>, authorised: bool) {
    raise_descriptors();
    let (database, mut arguments) =
        (TestDatabase::new_sqlite(), vec!["--workers".to_owned(), "0".to_owned()]);
    if let Some(key) = key {
        let file = database.folder.path().join("key");
        std::fs::write(&file, key).expect("a key");
        arguments.extend(["--api-key-file".to_owned(), file.display().to_string()]);
    }
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let server = TestServer::on(database, &arguments).await;
    let address = server.address();
    let mut held = Vec::new();
    let [body, unread] = stalling(key.filter(|_| authorised));
    for _ in 0..STALLED {
        held.push(connected(&address, &body).await);
        held.push(connected(&address, &unread).await);
    }
    // Who comes in the same half second as all of these from the same address may be told to come
    // again.
    tokio::time::sleep(Duration::from_secs(1)).await;
    let named = match (key, authorised) {
        (None, _) => "no key",
        (_, true) => "with the key",
        _ => "a key that they lack",
    };
    let mut quick = false;
    for _ in 0..ROUNDS {
        quick = quick || quickly_answered(&address, key, named).await;
    }
    assert!(quick, "{named}: none of {ROUNDS} rounds had a p99 below {BOUND:?}");
    for path in ["/healthz", "/readyz"] {
        assert_eq!(
            server.request(Method::GET, path).send().await.expect("an answer").status(),
            200,
            "{path}"
        );
    }
    drop(held);
}

#[tokio::test]
async fn new_connections_are_answered_in_a_crowd() {
    crowded(None, false).await;
    crowded(Some(KEY), false).await;
    crowded(Some(KEY), true).await;
}
