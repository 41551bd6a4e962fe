//! Requests over HTTP, a connection for each, and what came of them.

use std::net::SocketAddr;
use std::sync::Arc;
use std::time::Duration;

use reqwest::header::HeaderMap;
use reqwest::{Method, RequestBuilder};
use serde_json::Value;

use crate::tally::Tally;

/// A request that is not answered within this has failed.
pub const PATIENCE: Duration = Duration::from_secs(30);

/// A client of one server.
#[derive(Clone)]
pub struct Client {
    http: reqwest::Client,
    /// Where the server listens.
    pub address: SocketAddr,
    tally: Arc<Tally>,
}

/// An answer.
#[derive(Debug, Clone)]
pub struct Reply {
    /// Its status.
    pub status: u16,
    /// Its headers.
    pub headers: HeaderMap,
    /// Its body; empty for a stream of events, which has no end.
    pub bytes: Vec<u8>,
}

impl Reply {
    /// The body as JSON; null where it is none.
    pub fn json(&self) -> Value {
        serde_json::from_slice(&self.bytes).unwrap_or(Value::Null)
    }

    /// Whether the status is one of success.
    pub fn ok(&self) -> bool {
        (200..300).contains(&self.status)
    }

    /// A header as text; empty where there is none.
    pub fn header(&self, name: &str) -> &str {
        self.headers.get(name).and_then(|value| value.to_str().ok()).unwrap_or_default()
    }
}

impl Client {
    /// Of the server at an address.
    pub fn new(address: SocketAddr, tally: Arc<Tally>) -> Self {
        let http = reqwest::Client::builder()
            .pool_max_idle_per_host(0)
            .no_proxy()
            .timeout(PATIENCE)
            .build();
        Self { http: http.unwrap_or_default(), address, tally }
    }

    /// A request to a path.
    pub fn request(&self, method: Method, path: &str) -> RequestBuilder {
        self.http.request(method, format!("http://{}{path}", self.address))
    }

    /// Sends a request; its status is judged by itself. None where no whole answer came.
    pub async fn send(&self, request: RequestBuilder) -> Option<Reply> {
        self.try_send(request).await.ok()
    }

    /// The same with the reason.
    ///
    /// # Errors
    /// No whole answer came.
    pub async fn try_send(&self, request: RequestBuilder) -> reqwest::Result<Reply> {
        let (http, request) = request.build_split();
        let request = request?;
        let what = format!("{} {}", request.method(), request.url().path());
        self.tally.tried(1);
        let answer = http.execute(request).await?;
        let (status, headers) = (answer.status().as_u16(), answer.headers().clone());
        let kind =
            headers.get("content-type").and_then(|kind| kind.to_str().ok()).unwrap_or_default();
        let bytes = match kind.starts_with("text/event-stream") {
            true => Vec::new(),
            false => answer.bytes().await?.to_vec(),
        };
        self.tally
            .status(status, || format!("{what}: {}", clipped(&String::from_utf8_lossy(&bytes))));
        Ok(Reply { status, headers, bytes })
    }

    /// A GET of JSON; null where it is not answered well.
    pub async fn get(&self, path: &str) -> Value {
        match self.send(self.request(Method::GET, path)).await {
            Some(reply) if reply.ok() => reply.json(),
            _ => Value::Null,
        }
    }

    /// All items of a list, page by page; none where a page is not answered.
    pub async fn items(&self, path: &str) -> Option<Vec<Value>> {
        let (mut items, mut after) = (Vec::new(), String::new());
        loop {
            let mark = if path.contains('?') { '&' } else { '?' };
            let page = self.get(&format!("{path}{mark}limit=1000{after}")).await;
            items.extend(page["items"].as_array()?.iter().cloned());
            match page["next"].as_str() {
                Some(next) => after = format!("&after={}", encoded(next)),
                None => return Some(items),
            }
        }
    }
}

/// A text as a part of a query.
pub fn encoded(text: &str) -> String {
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"-_.".contains(&byte);
    text.bytes()
        .map(|byte| if plain(byte) { char::from(byte).to_string() } else { format!("%{byte:02X}") })
        .collect()
}

/// The beginning of a text.
pub fn clipped(text: &str) -> String {
    match text.char_indices().nth(200) {
        Some((end, _)) => format!("{}… ({} bytes)", &text[..end], text.len()),
        None => text.to_owned(),
    }
}
