//! Traces that a server exports: the request of a caller and the job that it queues are in the
//! caller's trace.

use std::sync::{Arc, Mutex};

use reqwest::Method;
use serde_json::{Value, json};
use sistership_store::testing::TestDatabase;
use sistership_tests::server::TestServer;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::{TcpListener, TcpStream};

/// Spans in the encoding of OTLP, as a collector receives them.
type Received = Arc<Mutex<Vec<u8>>>;

/// A collector: keeps the bodies of all requests.
async fn collector() -> (String, Received) {
    let listener = TcpListener::bind("127.0.0.1:0").await.expect("a free port");
    let url = format!("http://{}", listener.local_addr().expect("an address"));
    let received = Received::default();
    let kept = Arc::clone(&received);
    tokio::spawn(async move {
        while let Ok((stream, _)) = listener.accept().await {
            tokio::spawn(receive(stream, Arc::clone(&kept)));
        }
    });
    (url, received)
}

/// Answers each request as soon as its body is complete.
async fn receive(mut stream: TcpStream, kept: Received) {
    let (mut bytes, mut chunk) = (Vec::new(), vec![0; 1 << 16]);
    while let Ok(read @ 1..) = stream.read(&mut chunk).await {
        bytes.extend_from_slice(&chunk[..read]);
        let Some(head) = bytes.windows(4).position(|end| end == b"\r\n\r\n") else { continue };
        let text = String::from_utf8_lossy(&bytes[..head]).to_lowercase();
        assert!(text.starts_with("post /v1/traces "), "{text}");
        let length = text.lines().find_map(|line| line.strip_prefix("content-length: "));
        let length: usize = length.and_then(|length| length.trim().parse().ok()).expect("a length");
        if bytes.len() >= head + 4 + length {
            kept.lock().expect("the bodies").extend(bytes.drain(..).skip(head + 4));
            let answer = b"HTTP/1.1 200 OK\r\ncontent-length: 0\r\n\r\n";
            stream.write_all(answer).await.expect("an answer");
        }
    }
}

/// Number of times that bytes occur.
fn count(bytes: &[u8], part: &[u8]) -> usize {
    bytes.windows(part.len()).filter(|window| *window == part).count()
}

#[tokio::test(flavor = "multi_thread")]
async fn a_job_is_in_the_trace_of_the_request_that_queued_it() {
    let (url, received) = collector().await;
    let mut server = TestServer::on(TestDatabase::new_sqlite(), &["--otlp-endpoint", &url]).await;
    let family = json!({ "name": "tankers", "foundation": "kvlcc2/1", "members": ["kvlcc2"] });
    assert_eq!(server.send(Method::POST, "/v1/families", &family, &[]).await.0, 201);
    let trace = "00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01";
    let headers = [("traceparent", trace)];
    let (status, job) =
        server.send(Method::POST, "/v1/families/tankers/prior", &Value::Null, &headers).await;
    assert_eq!(status, 202, "{job}");
    server.finished(job["id"].as_str().expect("an id")).await;
    // The last spans are sent when the server stops.
    assert_eq!(server.terminate().code(), Some(0));
    let spans = received.lock().expect("the bodies").clone();
    let id = 0x4bf9_2f35_77b3_4da6_a3ce_929d_0e0e_4736_u128.to_be_bytes();
    assert_eq!(count(&spans, &id), 2, "the request and its job");
    assert!(count(&spans, b"\x07request") > 1 && count(&spans, b"\x03job") >= 1);
}
