//! A process that is told to stop ends within its stated time, whatever it does.

use std::time::{Duration, Instant};

use reqwest::Method;
use sistership_store::testing::TestDatabase;
use sistership_tests::server::TestServer;
use sistership_tests::worker::TestWorker;
use tokio::io::AsyncWriteExt as _;
use tokio::net::TcpStream;

use super::over_http::{create, refine, upload};

/// Of `docs/operation.md`, beyond `--drain-s`.
const BEYOND_DRAIN: Duration = Duration::from_secs(15);

#[tokio::test]
async fn a_server_with_everything_under_way_ends_in_time() {
    let mut server = TestServer::on(TestDatabase::new_sqlite(), &["--drain-s", "1"]).await;
    create(&server).await;
    upload(&server).await;
    let job = refine(&server, "stopped").await;
    let mut events = server
        .request(Method::GET, &format!("/v1/jobs/{job}/events"))
        .send()
        .await
        .expect("events");
    events.chunk().await.expect("an event");
    let mut stalled = Vec::new();
    for _ in 0..50 {
        let mut stream = TcpStream::connect(server.address()).await.expect("a connection");
        let head = "POST /v1/ships HTTP/1.1\r\nHost: localhost\r\nContent-Type: \
            application/json\r\nContent-Length: 9\r\n\r\n{";
        stream.write_all(head.as_bytes()).await.expect("a head");
        stalled.push(stream);
    }
    // Deep YAML, which a parser may take minutes for.
    let deep = "{a: ".repeat(200_000);
    let laws: Vec<_> = (0..4)
        .map(|_| {
            server
                .request(Method::POST, "/v1/laws")
                .header("content-type", "application/yaml")
                .body(deep.clone())
                .send()
        })
        .map(tokio::spawn)
        .collect();
    tokio::time::sleep(Duration::from_secs(1)).await;
    let told = Instant::now();
    let status = tokio::task::spawn_blocking(move || server.terminate()).await.expect("it ends");
    let took = told.elapsed();
    println!("a server with everything under way ended after {took:.1?} with {status}");
    assert!(took < Duration::from_secs(1) + BEYOND_DRAIN + Duration::from_secs(2), "{took:?}");
    drop((laws, stalled));
}

#[tokio::test]
async fn a_worker_with_a_job_ends_in_time() {
    let server = TestServer::on(TestDatabase::new_sqlite(), &["--no-worker"]).await;
    create(&server).await;
    upload(&server).await;
    let mut store = server.store_arguments().to_vec();
    store.extend(["--drain-s".to_owned(), "0".to_owned()]);
    let mut worker = TestWorker::begin(&store, "5");
    worker.until_it_works();
    let job = refine(&server, "worked").await;
    while server.get(&format!("/v1/jobs/{job}")).await["state"] == "queued" {
        tokio::time::sleep(Duration::from_millis(2)).await;
    }
    let told = Instant::now();
    assert_eq!(worker.terminate().code(), Some(0));
    assert!(told.elapsed() < BEYOND_DRAIN, "{:?}", told.elapsed());
    assert_eq!(server.get(&format!("/v1/jobs/{job}")).await["state"], "queued", "it went back");
}
