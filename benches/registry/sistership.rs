//! This project's server.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, Instant};

use reqwest::{Client, Method, RequestBuilder, Response};
use serde_json::{Value, json};

use crate::Failure;
use crate::registry::Moved;

/// The model that every version is a variation of.
static TEMPLATE: OnceLock<Value> = OnceLock::new();

/// How long the server may take over what it does in the background.
const PATIENCE: Duration = Duration::from_secs(300);

fn ask(client: &Client, method: Method, url: String) -> RequestBuilder {
    let request = client.request(method, url);
    match std::env::var("SISTERSHIP_API_KEY") {
        Ok(key) => request.bearer_auth(key),
        Err(_) => request,
    }
}

async fn done(request: RequestBuilder) -> Result<Response, Failure> {
    let response = request.send().await?;
    match response.error_for_status_ref() {
        Ok(_) => Ok(response),
        Err(error) => Err(format!("{error}: {}", response.text().await?).into()),
    }
}

pub async fn model(client: &Client, url: &str, model: &str) -> Result<(), Failure> {
    if TEMPLATE.get().is_none() {
        let mariner: Value =
            done(ask(client, Method::GET, format!("{url}/v1/ships/mariner/model")))
                .await?
                .json()
                .await?;
        let _ = TEMPLATE.set(mariner["model"].clone());
    }
    let ship = json!({
        "kind": "vessel", "name": model, "title": "For measuring", "category": "bench",
        "sources": { "made-up": { "citation": "For measuring" } },
        "particulars": { "source": "made-up",
        "values": { "lpp_m": 160.0, "beam_m": 23.0, "draught_m": 7.5 } }
    });
    done(ask(client, Method::POST, format!("{url}/v1/ships")).json(&ship)).await.map(drop)
}

pub async fn create(client: &Client, url: &str, model: &str) -> Result<u64, Failure> {
    static COUNT: AtomicU32 = AtomicU32::new(0);
    let mut document = TEMPLATE.get().ok_or("no model to vary")?.clone();
    document["ship"] = json!(model);
    document["name"] = json!(format!("{model}/measured"));
    document["note"] = json!(format!("variation {}", COUNT.fetch_add(1, Ordering::Relaxed)));
    let body = json!({ "model": document, "origin": "benches/registry" });
    let made: Value =
        done(ask(client, Method::POST, format!("{url}/v1/models/{model}/versions")).json(&body))
            .await?
            .json()
            .await?;
    made["number"].as_u64().ok_or_else(|| format!("no number in {made}").into())
}

/// Waits until the ships are found by the metrics of their champions: the server sails manoeuvres
/// for that in the background, which would otherwise be measured with whatever comes next.
pub async fn settle(client: &Client, url: &str, models: usize) -> Result<(), Failure> {
    let place =
        format!("{url}/v1/ships?category=bench&metric=turn_35.tactical_diameter_m:..&limit=1000");
    let start = Instant::now();
    while start.elapsed() < PATIENCE {
        let page: Value = done(ask(client, Method::GET, place.clone())).await?.json().await?;
        if page["items"].as_array().is_some_and(|found| found.len() >= models.min(1000)) {
            return Ok(());
        }
        tokio::time::sleep(Duration::from_millis(100)).await;
    }
    Err("the ships are not found by the metrics of their champions".into())
}

fn alias(client: &Client, url: &str, model: &str, version: u64) -> RequestBuilder {
    let place = format!("{url}/v1/models/{model}/aliases/champion");
    ask(client, Method::PUT, place).json(&json!({ "version": version, "reason": "measuring" }))
}

pub async fn crown(client: &Client, url: &str, model: &str, version: u64) -> Result<(), Failure> {
    done(alias(client, url, model, version).header("if-none-match", "*")).await.map(drop)
}

pub async fn champion(client: &Client, url: &str, model: &str) -> Result<(), Failure> {
    let body = done(ask(client, Method::GET, format!("{url}/v1/ships/{model}/model")))
        .await?
        .bytes()
        .await?;
    if body.is_empty() { Err("an empty champion".into()) } else { Ok(()) }
}

pub async fn tag(client: &Client, url: &str, model: &str) -> Result<String, Failure> {
    let response =
        done(ask(client, Method::GET, format!("{url}/v1/models/{model}/aliases/champion"))).await?;
    Ok(response.headers().get("etag").ok_or("no ETag")?.to_str()?.to_owned())
}

pub async fn swap(
    client: &Client,
    url: &str,
    model: &str,
    version: u64,
    tag: &str,
) -> Result<Moved, Failure> {
    let response = alias(client, url, model, version).header("if-match", tag).send().await?;
    match response.status().as_u16() {
        200 => Ok(Moved::Won),
        412 => Ok(Moved::Lost),
        _ => Err(format!(
            "a move was answered with {}: {}",
            response.status(),
            response.text().await?
        )
        .into()),
    }
}
