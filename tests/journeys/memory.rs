//! Memory is bounded by what is admitted: the built server's own peak, under requests that each ask
//! for more than there is.

use std::io::Write as _;
use std::net::TcpStream;
use std::time::Duration;

use bytes::Bytes;
use reqwest::{Method, StatusCode};
use serde_json::{Value, json};
use sistership_model::trial::{Channel, Trial};
use sistership_model::version::sha256_hex;
use sistership_store::testing::TestDatabase;
use sistership_tests::server::{TestServer, memory_mb};
use sistership_tests::{binary, esso_osaka, shared};
use sistership_trials::samples::to_parquet;

/// What all requests may take, and the program beside them, MB.
const REQUESTS: u64 = 256;
const PROGRAM: u64 = 64;
const PARQUET: &str = "application/vnd.apache.parquet";

async fn server() -> TestServer {
    TestServer::on(TestDatabase::new_sqlite(), &["--no-worker"]).await
}

/// Constants by the million, in few bytes.
fn constants(rows: usize, channels: &[Channel]) -> Bytes {
    let t_s = (0..rows).map(|k| k as f64).collect();
    let channels = channels.iter().map(|&channel| (channel, vec![0.25; rows])).collect();
    to_parquet(&Trial { t_s, channels, ..Trial::default() }).expect("a file").into()
}

/// The statuses of the same request sent so many times at once, and the last answer.
async fn at_once(
    server: &TestServer,
    count: usize,
    path: &str,
    media: &str,
    body: &Bytes,
) -> (Vec<u16>, Value) {
    let one = |_| {
        let request =
            server.request(Method::POST, path).header("content-type", media).body(body.clone());
        tokio::spawn(async move {
            let answer = request.send().await.expect("an answer");
            let (status, retry) = (answer.status(), answer.headers().contains_key("retry-after"));
            assert_eq!(retry, status == StatusCode::TOO_MANY_REQUESTS);
            (status.as_u16(), answer.json::<Value>().await.expect("JSON"))
        })
    };
    let (mut statuses, mut last) = (Vec::new(), Value::Null);
    for asked in (0..count).map(one).collect::<Vec<_>>() {
        let (status, answer) = asked.await.expect("no panic");
        statuses.push(status);
        last = answer;
    }
    (statuses, last)
}

#[tokio::test(flavor = "multi_thread")]
async fn eight_uploads_of_millions_of_constants() {
    let server = server().await;
    let all =
        [Channel::U, Channel::V, Channel::R, Channel::Psi, Channel::X, Channel::Y, Channel::Delta];
    let (statuses, said) =
        at_once(&server, 8, "/v1/trials/check?ship=x", PARQUET, &constants(4_900_000, &all)).await;
    assert!(statuses.iter().all(|status| *status == 413), "{statuses:?}");
    let detail = said["detail"].as_str().unwrap_or_default();
    assert!(
        detail.contains("4900000 rows of 8 columns")
            && detail.contains("more than the limit of 256 MiB"),
        "{detail}"
    );
    let (statuses, said) = at_once(
        &server,
        8,
        "/v1/trials/check?ship=x",
        PARQUET,
        &constants(4_900_000, &[Channel::U]),
    )
    .await;
    assert!(
        statuses.iter().all(|status| [200, 429].contains(status)) && statuses.contains(&200),
        "{statuses:?} {said}"
    );
    let (peak, _) = server.memory_mb();
    println!("eight uploads: {statuses:?}, peak {peak} MB");
    assert!(peak < REQUESTS + PROGRAM, "{peak} MB");
}

#[tokio::test(flavor = "multi_thread")]
async fn sixteen_large_documents() {
    let server = server().await;
    let of = |bytes: usize| Bytes::from(format!("name: [{}a]", "a,".repeat(bytes / 2 - 8)));
    let (statuses, said) = at_once(&server, 16, "/v1/laws", "application/yaml", &of(4 << 20)).await;
    assert!(statuses.iter().all(|status| *status == 413), "{statuses:?} {said}");
    let (statuses, said) = at_once(&server, 16, "/v1/laws", "application/yaml", &of(1 << 20)).await;
    assert!(
        statuses.iter().all(|status| [422, 429].contains(status)) && statuses.contains(&422),
        "{statuses:?} {said}"
    );
    let json =
        Bytes::from(format!("{{\"name\":\"a\",\"members\":[{}\"\"]}}", "\"\",".repeat(1 << 20)));
    let (statuses, _) = at_once(&server, 16, "/v1/families", "application/json", &json).await;
    assert!(
        statuses.iter().all(|status| [422, 429].contains(status)) && statuses.contains(&422),
        "{statuses:?}"
    );
    let (peak, _) = server.memory_mb();
    println!("sixteen documents: peak {peak} MB");
    assert!(peak < REQUESTS + PROGRAM, "{peak} MB");
}

#[tokio::test(flavor = "multi_thread")]
async fn downloads_that_nobody_reads() {
    let server = server().await;
    let samples = constants(3_750_000, &[Channel::U]);
    let upload =
        server.request(Method::POST, "/v1/trials?ship=esso-osaka-3m&name=a&diagnose=false");
    let kept = upload
        .header("content-type", PARQUET)
        .body(samples.clone())
        .send()
        .await
        .expect("an answer");
    assert_eq!(kept.status(), StatusCode::CREATED);
    let kept: Value = kept.json().await.expect("JSON");
    let path = format!("/v1/trials/{}/samples", kept["trials"][0]["id"].as_str().expect("an id"));
    let get = |media: &str| server.request(Method::GET, &path).header("accept", media);
    let whole = get(PARQUET).send().await.expect("an answer").bytes().await.expect("a body");
    assert_eq!(kept["trials"][0]["rows"], json!(3_750_000));
    assert_eq!(kept["trials"][0]["sha256"], json!(sha256_hex(&whole)), "it comes as it is kept");
    let (_, before) = server.memory_mb();
    let address = server.url().trim_start_matches("http://").to_owned();
    let unread = |media: &&str| {
        let mut stream = TcpStream::connect(&address).expect("a connection");
        write!(stream, "GET {path} HTTP/1.1\r\nHost: {address}\r\nAccept: {media}\r\n\r\n")
            .expect("a request");
        stream
    };
    let held: Vec<TcpStream> = ["text/csv", PARQUET].repeat(6).iter().map(unread).collect();
    tokio::time::sleep(Duration::from_secs(5)).await;
    let (peak, now) = server.memory_mb();
    println!("twelve unread downloads: {before} MB before, {now} MB now, peak {peak} MB");
    assert!(
        now < before + 32 && peak < REQUESTS + PROGRAM,
        "{before} MB before, {now} MB now, peak {peak} MB"
    );
    drop(held);
    let text = get("text/csv").send().await.expect("an answer").bytes().await.expect("a body");
    assert!(
        text.starts_with(b"t_s,u_m_s\n0.0,0.25\n1.0,0.25\n")
            && text.ends_with(b"\n3749999.0,0.25\n")
    );
}

/// The most that the command below may have resident, MB.
const REFINEMENT: u64 = 1024;

/// `cargo test --release -p sistership-tests --test journeys refinement_of_many_trials -- --ignored
/// --nocapture`
#[test]
#[ignore = "takes a minute by itself on an optimised build"]
fn refinement_of_many_trials() {
    let Some(data) = shared::data("esso-osaka") else { return };
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("esso-osaka.yaml"), esso_osaka::MANIFEST)
        .expect("a manifest");
    for kind in ["turning", "zigzag", "random", "berthing"] {
        let copied = std::process::Command::new("cp")
            .arg("-r")
            .arg(data.join(kind))
            .arg(folder.path())
            .status();
        assert!(copied.is_ok_and(|status| status.success()), "{kind} is copied");
    }
    let mut process = std::process::Command::new(binary::path())
        .args([
            "refine",
            "--ship",
            "esso-osaka-3m",
            "--trials",
            "esso-osaka.yaml",
            "--law",
            "low-speed",
        ])
        .args(["--method", "trajectory"])
        .current_dir(folder.path())
        .stdout(std::process::Stdio::null())
        .spawn()
        .expect("the program starts");
    let mut peak = 0;
    while process.try_wait().expect("the program").is_none() {
        peak = peak.max(memory_mb(process.id()).0);
        std::thread::sleep(Duration::from_millis(100));
    }
    println!("a refinement of 34 trials: peak {peak} MB");
    assert!(process.wait().is_ok_and(|status| status.success()));
    assert!(0 < peak && peak < REFINEMENT, "{peak} MB");
}
