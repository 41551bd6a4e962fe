//! Webhooks: an event reaches a receiver, signed, whatever fails on the way.

use std::sync::{Arc, Mutex};
use std::time::Duration;

use axum::Router;
use axum::extract::State;
use axum::http::{HeaderMap, StatusCode};
use axum::routing::post;
use serde_json::{Value, json};
use sistership_store::testing::TestDatabase;
use tokio::net::TcpListener;

use super::harness::{Harness, config, read};
use crate::Server;

/// Deliveries that a receiver has got: event, delivery, signature, body.
type Seen = Arc<Mutex<Vec<[String; 4]>>>;

/// A receiver on this machine that refuses a number of deliveries before it accepts one.
#[derive(Clone)]
struct Receiver {
    seen: Seen,
    refuses: Arc<Mutex<usize>>,
}

async fn hook(State(receiver): State<Receiver>, headers: HeaderMap, body: String) -> StatusCode {
    let of = |name: &str| headers[name].to_str().unwrap().to_owned();
    let [event, delivery, signature] =
        ["sistership-event", "sistership-delivery", "sistership-signature"].map(of);
    receiver.seen.lock().unwrap().push([event, delivery, signature, body]);
    let mut refuses = receiver.refuses.lock().unwrap();
    if *refuses == 0 {
        return StatusCode::NO_CONTENT;
    }
    *refuses -= 1;
    StatusCode::SERVICE_UNAVAILABLE
}

async fn receiver(refuses: usize) -> (Receiver, String) {
    let receiver = Receiver { seen: Seen::default(), refuses: Arc::new(Mutex::new(refuses)) };
    let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let url = format!("http://{}/hook", listener.local_addr().unwrap());
    let routes = Router::new().route("/hook", post(hook)).with_state(receiver.clone());
    tokio::spawn(async move { axum::serve(listener, routes).await.unwrap() });
    (receiver, url)
}

async fn started(database: TestDatabase, private: bool) -> Harness {
    let mut config = config(&database);
    config.limits.webhooks_private = private;
    let server = Server::start(config).await.unwrap();
    Harness { server, client: reqwest::Client::new(), database }
}

/// Moves the Mariner's champion to the version where it already is.
async fn move_champion(harness: &Harness, reason: &str) {
    let path = "/v1/models/mariner/aliases/champion";
    let stands = harness.get(path).await;
    let asked = json!({ "version": stands["version"], "reason": reason });
    let revision = format!("\"{}\"", stands["revision"]);
    let request = harness.client.put(harness.url(path)).header("if-match", revision).json(&asked);
    let (status, moved) = read(request.send().await.unwrap()).await;
    assert!(status.is_success(), "{moved}");
}

async fn until(what: &str, holds: impl Fn() -> bool) {
    for _ in 0..600 {
        if holds() {
            return;
        }
        tokio::time::sleep(Duration::from_millis(50)).await;
    }
    panic!("{what} did not come");
}

/// The hexadecimal HMAC-SHA256 as Python's standard library makes it, which is not the code that
/// signs.
fn by_python(secret: &str, message: &str) -> String {
    let program = "import hmac,hashlib,sys;print(hmac.new(sys.argv[1].encode(),sys.argv[2].encode(),hashlib.sha256).hexdigest())";
    let made =
        std::process::Command::new("python3").args(["-c", program, secret, message]).output();
    String::from_utf8(made.unwrap().stdout).unwrap().trim().to_owned()
}

async fn deliveries(harness: &Harness, id: &str) -> Vec<Value> {
    let listed = harness.get(&format!("/v1/webhooks/{id}/deliveries")).await;
    listed["items"].as_array().unwrap().clone()
}

async fn told(database: TestDatabase) {
    let (receiver, url) = receiver(1).await;
    let harness = started(database, true).await;
    let asked = json!({ "title": "Bridge", "url": url, "events": ["champion.moved"] });
    let (status, made) = harness.post("/v1/webhooks", &asked).await;
    assert_eq!(status, StatusCode::CREATED.as_u16(), "{made}");
    let secret = made["secret"].as_str().unwrap().to_owned();
    let id = made["about"]["id"].as_str().unwrap().to_owned();
    assert!(harness.get(&format!("/v1/webhooks/{id}")).await.get("secret").is_none());

    // Refused once, the delivery stays due, and arrives when it is sent again.
    move_champion(&harness, "a test").await;
    until("the first attempt", || receiver.seen.lock().unwrap().len() == 1).await;
    let mut listed = deliveries(&harness, &id).await;
    while listed[0]["answer"].is_null() {
        listed = deliveries(&harness, &id).await;
    }
    assert_eq!(listed[0]["answer"], "answered 503", "{listed:?}");
    assert!(listed[0]["due_us"].as_i64().is_some() && listed[0]["delivered_us"].is_null());
    let delivery = listed[0]["id"].as_str().unwrap().to_owned();
    let again = format!("/v1/webhooks/{id}/deliveries/{delivery}/retry");
    assert_eq!(harness.post(&again, &json!({})).await.0, 200);
    until("the second attempt", || receiver.seen.lock().unwrap().len() == 2).await;

    // The same delivery both times, signed as the document says.
    let seen = receiver.seen.lock().unwrap().clone();
    assert_eq!((&seen[0][1], &seen[1][1]), (&delivery, &delivery));
    for [event, _, signature, body] in &seen {
        assert_eq!(event, "champion.moved");
        let (time, signed) = signature.strip_prefix("t=").unwrap().split_once(",v1=").unwrap();
        assert_eq!(signed, by_python(&secret, &format!("{time}.{body}")));
        let body: Value = serde_json::from_str(body).unwrap();
        assert_eq!(
            (&body["ship"], &body["about"]["reason"]),
            (&json!("mariner"), &json!("a test"))
        );
    }

    // Events that were acknowledged while the receiver was down are sent by the next server.
    *receiver.refuses.lock().unwrap() = usize::MAX;
    move_champion(&harness, "another").await;
    until("the third attempt", || receiver.seen.lock().unwrap().len() >= 3).await;
    let Harness { server, database, .. } = harness;
    server.stop().await;
    let harness = started(database, true).await;
    let due = deliveries(&harness, &id).await[0].clone();
    assert!(due["delivered_us"].is_null(), "{due}");
    *receiver.refuses.lock().unwrap() = 0;
    let again = format!("/v1/webhooks/{id}/deliveries/{}/retry", due["id"].as_str().unwrap());
    for attempt in 0.. {
        if !deliveries(&harness, &id).await[0]["delivered_us"].is_null() {
            break;
        }
        assert!(attempt < 600, "the event did not come");
        // The server may have sent it meanwhile, and is not asked to send it twice then.
        harness.post(&again, &json!({})).await;
        tokio::time::sleep(Duration::from_millis(100)).await;
    }
    let last = receiver.seen.lock().unwrap().last().unwrap().clone();
    assert_eq!(
        (last[1].as_str(), last[3].contains("another")),
        (due["id"].as_str().unwrap(), true)
    );

    // An ended webhook gets no further events.
    let ended = harness.client.delete(harness.url(&format!("/v1/webhooks/{id}"))).send().await;
    assert_eq!(ended.unwrap().status().as_u16(), 200);
    move_champion(&harness, "unheard").await;
    assert_eq!(deliveries(&harness, &id).await.len(), 2);
    harness.server.stop().await;
}

#[tokio::test(flavor = "multi_thread")]
async fn receivers_are_told_on_sqlite() {
    told(TestDatabase::new_sqlite()).await;
}

#[tokio::test(flavor = "multi_thread")]
async fn receivers_are_told_on_postgres() {
    if let Some(database) = TestDatabase::new_postgres().await {
        told(database).await;
    }
}

/// A receiver that accepts connections and never answers.
async fn silent_receiver() -> String {
    let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let url = format!("http://{}/hook", listener.local_addr().unwrap());
    tokio::spawn(async move {
        let mut held = Vec::new();
        while let Ok((stream, _)) = listener.accept().await {
            held.push(stream);
        }
    });
    url
}

#[tokio::test(flavor = "multi_thread")]
async fn silent_receivers_do_not_delay_another() {
    let (silent, (receiver, good)) = (silent_receiver().await, receiver(0).await);
    let harness = started(TestDatabase::new_sqlite(), true).await;
    for url in std::iter::repeat_n(&silent, 24).chain([&good]) {
        let asked = json!({ "title": "T", "url": url, "events": ["champion.moved"] });
        assert_eq!(harness.post("/v1/webhooks", &asked).await.0, 201);
    }
    let start = std::time::Instant::now();
    for n in 1..=6 {
        move_champion(&harness, &format!("move {n}")).await;
        until("the delivery", || receiver.seen.lock().unwrap().len() >= n).await;
    }
    // An attempt to a silent receiver takes fifteen seconds.
    assert!(start.elapsed() < Duration::from_secs(10), "{:?}", start.elapsed());
    harness.server.stop().await;
}

#[tokio::test(flavor = "multi_thread")]
async fn nobody_is_told_within_the_own_network_unless_that_is_allowed() {
    let harness = started(TestDatabase::new_sqlite(), false).await;
    for url in ["http://example.com/", "https://127.0.0.1/", "https://[::1]/", "https://10.0.0.1/"]
    {
        let asked = json!({ "title": "T", "url": url, "events": ["drift"] });
        let (status, problem) = harness.post("/v1/webhooks", &asked).await;
        assert_eq!(status, 422, "{url}: {problem}");
        assert!(problem.to_string().contains("url"), "{problem}");
    }
    // The address that a name leads to is checked when the connection is made.
    let asked =
        json!({ "title": "T", "url": "https://localhost:1/", "events": ["champion.moved"] });
    let (status, made) = harness.post("/v1/webhooks", &asked).await;
    assert_eq!(status, 201, "{made}");
    move_champion(&harness, "a test").await;
    let id = made["about"]["id"].as_str().unwrap();
    let mut listed = deliveries(&harness, id).await;
    while listed[0]["answer"].is_null() {
        listed = deliveries(&harness, id).await;
    }
    let answer = listed[0]["answer"].as_str().unwrap();
    assert!(answer.contains("not public"), "{answer}");
    harness.server.stop().await;
}
