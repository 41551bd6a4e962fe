//! Simulation sessions: by requests and over a WebSocket, each of the caller that opened it.

use std::time::{Duration, Instant};

use futures::{SinkExt as _, StreamExt as _};
use reqwest::{Method, StatusCode};
use serde_json::{Value, json};
use sistership_jobs::predictions::session::SessionLimits;
use sistership_store::testing::TestDatabase;
use tokio_tungstenite::tungstenite::client::IntoClientRequest as _;
use tokio_tungstenite::tungstenite::{Error, Message};
use tokio_tungstenite::{MaybeTlsStream, WebSocketStream, connect_async};

use super::harness::{Harness, config, read};
use crate::Server;

type Socket = WebSocketStream<MaybeTlsStream<tokio::net::TcpStream>>;

impl Harness {
    async fn under_way(&self, asked: &Value) -> String {
        let (status, session) = self.post("/v1/sessions", asked).await;
        assert_eq!(status, StatusCode::CREATED, "{session}");
        format!("/v1/sessions/{}", session["id"].as_str().unwrap())
    }

    async fn stream(&self, session: &str, origin: Option<&str>) -> Result<Socket, Error> {
        let url = self.url(&format!("{session}/stream")).replace("http://", "ws://");
        let mut request = url.into_client_request()?;
        if let Some(origin) = origin {
            request.headers_mut().insert("origin", origin.parse().unwrap());
        }
        Ok(connect_async(request).await?.0)
    }
}

async fn next(socket: &mut Socket) -> Option<Value> {
    match socket.next().await?.ok()? {
        Message::Text(text) => Some(serde_json::from_str(&text).unwrap()),
        _ => None,
    }
}

async fn say(socket: &mut Socket, asked: &Value) {
    socket.send(Message::Text(asked.to_string().into())).await.unwrap();
}

#[tokio::test(flavor = "multi_thread")]
async fn a_ship_sails_on_by_requests_and_by_a_stream() {
    let harness = Harness::on(TestDatabase::new_sqlite()).await;
    let asked = json!({ "model": "mariner", "start": { "u_m_s": 7.0, "psi_rad": 1.0 },
        "wind": { "speed_m_s": 5.0, "from_rad": 0.5 } });
    let (one, two) = (harness.under_way(&asked).await, harness.under_way(&asked).await);
    assert_eq!(harness.get("/v1/sessions").await["items"].as_array().unwrap().len(), 2);
    let turn = json!({ "orders": { "delta_rad": 0.3 }, "dt_s": 0.5, "steps": 100 });
    let (status, sailed) = harness.post(&format!("{one}/steps"), &turn).await;
    assert_eq!(status, StatusCode::OK, "{sailed}");
    let mut socket = harness.stream(&two, Some(&harness.server.url())).await.unwrap();
    say(&mut socket, &turn).await;
    for step in 0..100 {
        let row = next(&mut socket).await.unwrap();
        for column in ["t_s", "x_m", "psi_rad", "delta_rad"] {
            assert_eq!(row[column], sailed["trajectory"][column][step], "{column} of step {step}");
        }
    }
    // The same ship in both ways, with a problem in between which ends nothing.
    say(&mut socket, &json!({ "orders": { "inputs": { "bow": 1.0 } }, "dt_s": 0.5 })).await;
    assert_eq!(next(&mut socket).await.unwrap()["errors"][0]["field"], "orders.inputs.bow");
    say(&mut socket, &json!({ "dt_s": -1.0 })).await;
    assert_eq!(next(&mut socket).await.unwrap()["errors"][0]["field"], "dt_s");
    let (_, more) = harness.post(&format!("{two}/steps"), &json!({ "dt_s": 0.5 })).await;
    let shown = harness.get(&two).await;
    assert_eq!(shown["psi_rad"], more["trajectory"]["psi_rad"][0]);
    assert_eq!((&shown["model"], &shown["orders"]["delta_rad"]), (&json!("mariner"), &json!(0.3)));
    times(&harness, &one, &mut socket).await;
    let delete = harness.client.delete(harness.url(&two)).send().await.unwrap();
    assert_eq!(delete.status(), StatusCode::NO_CONTENT);
    say(&mut socket, &json!({ "dt_s": 0.5 })).await;
    assert_eq!(next(&mut socket).await.unwrap()["status"], 404);
    harness.server.stop().await;
    assert!(next(&mut socket).await.is_none());
}

/// Prints the time of one step and its answer.
async fn times(harness: &Harness, session: &str, socket: &mut Socket) {
    let (step, mut least) = (json!({ "dt_s": 0.1 }), [Duration::MAX; 2]);
    for _ in 0..200 {
        let start = Instant::now();
        harness.post(&format!("{session}/steps"), &step).await;
        least[0] = least[0].min(start.elapsed());
        let start = Instant::now();
        say(socket, &step).await;
        next(socket).await.unwrap();
        least[1] = least[1].min(start.elapsed());
    }
    println!(
        "one step there and back, least of 200: POST {:?}, WebSocket {:?}",
        least[0], least[1]
    );
}

#[tokio::test(flavor = "multi_thread")]
async fn another_site_opens_no_stream_and_what_is_no_websocket_is_told() {
    let harness = Harness::on(TestDatabase::new_sqlite()).await;
    let session = harness.under_way(&json!({ "model": "kvlcc2" })).await;
    match harness.stream(&session, Some("https://evil.example")).await {
        Err(Error::Http(answer)) => assert_eq!(answer.status().as_u16(), 403),
        other => panic!("{other:?}"),
    }
    let plain = harness.client.get(harness.url(&format!("{session}/stream"))).send().await.unwrap();
    let (status, problem) = read(plain).await;
    assert_eq!(status, StatusCode::BAD_REQUEST);
    assert!(problem["detail"].as_str().unwrap().contains("WebSocket"), "{problem}");
    harness.server.stop().await;
}

#[tokio::test(flavor = "multi_thread")]
async fn sessions_are_of_whoever_opened_them_and_bounded() {
    let database = TestDatabase::new_sqlite();
    let mut config = config(&database);
    config.api_key = Some("secret".into());
    config.limits.sessions = SessionLimits { of_one: 2, ..SessionLimits::default() };
    let server = Server::start(config).await.unwrap();
    let harness = Harness { server, client: reqwest::Client::new(), database };
    let (ann, bob) = (harness.reader().await, harness.reader().await);
    let model = json!({ "model": "mariner" });
    let open =
        |key: String| harness.as_key(key, Method::POST, "/v1/sessions".into(), model.clone());
    let (_, session) = open(ann.clone()).await;
    let place = format!("/v1/sessions/{}", session["id"].as_str().unwrap());
    let show = |key: &str| harness.as_key(key.into(), Method::GET, place.clone(), Value::Null);
    assert_eq!(show(&ann).await.0, StatusCode::OK);
    assert_eq!(show(&bob).await.0, StatusCode::NOT_FOUND);
    open(ann.clone()).await;
    let (status, problem) = open(ann).await;
    assert_eq!(status, StatusCode::TOO_MANY_REQUESTS, "{problem}");
    assert_eq!(open(bob).await.0, StatusCode::CREATED);
    harness.server.stop().await;
}

impl Harness {
    /// Creates a key that may read everything.
    async fn reader(&self) -> String {
        let asked = json!({ "title": "a reader", "roles": [{ "role": "reader" }] });
        let (status, made) =
            self.as_key("secret".into(), Method::POST, "/v1/keys".into(), asked).await;
        assert_eq!(status, StatusCode::CREATED, "{made}");
        made["key"].as_str().unwrap().to_owned()
    }

    async fn as_key(
        &self,
        key: String,
        method: Method,
        path: String,
        body: Value,
    ) -> (StatusCode, Value) {
        let request = self.client.request(method, self.url(&path)).bearer_auth(key);
        read(request.json(&body).send().await.unwrap()).await
    }
}
