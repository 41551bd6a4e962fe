//! One attempt at a delivery.

use std::net::SocketAddr;
use std::time::Duration;

use reqwest::{Client, Url, redirect};
use sistership_auth::sign;
use sistership_store::{Delivery, Webhook, provide_cryptography};

use super::addresses::{check_url, is_public};

/// How long a receiver may take in all.
const PATIENCE: Duration = Duration::from_secs(15);

/// Sends a delivery once; says what was answered, or why it has not arrived.
pub(super) async fn send(
    delivery: &Delivery,
    webhook: &Webhook,
    now_us: i64,
    private: bool,
) -> Result<String, String> {
    let url = check_url(&webhook.url, private)?;
    let client = client(&url, &addresses(&url, private).await?)?;
    let at_s = now_us / 1_000_000;
    let signed = sign(&webhook.secret, format!("{at_s}.{}", delivery.body).as_bytes());
    let request = client
        .post(url)
        .header("Content-Type", "application/json")
        .header("Sistership-Event", &delivery.event)
        .header("Sistership-Delivery", &delivery.id)
        .header("Sistership-Signature", format!("t={at_s},v1={signed}"))
        .body(delivery.body.clone());
    let answer = request.send().await.map_err(|error| words(&error))?;
    // What a receiver says beside its status is not read: it could be anything.
    match answer.status() {
        status if status.is_success() => Ok(status.as_u16().to_string()),
        status => Err(format!("answered {}", status.as_u16())),
    }
}

/// The addresses of a receiver: all of them, if each may be spoken to.
async fn addresses(url: &Url, private: bool) -> Result<Vec<SocketAddr>, String> {
    let host = url.host_str().unwrap_or_default().trim_matches(['[', ']']);
    let port = url.port_or_known_default().unwrap_or(443);
    let found = tokio::net::lookup_host((host, port)).await;
    let found: Vec<SocketAddr> = found.map_err(|_| format!("{host} has no address"))?.collect();
    match found.iter().find(|address| !private && !is_public(address.ip())) {
        Some(address) => Err(format!("{host} is {}, which is not public", address.ip())),
        None => Ok(found),
    }
}

/// Speaks to the addresses that were looked at, whatever the name has become since; follows nobody
/// elsewhere, and goes through no proxy.
fn client(url: &Url, addresses: &[SocketAddr]) -> Result<Client, String> {
    provide_cryptography();
    let host = url.host_str().unwrap_or_default();
    let client = Client::builder()
        .timeout(PATIENCE)
        .redirect(redirect::Policy::none())
        .no_proxy()
        .user_agent(concat!("sistership/", env!("CARGO_PKG_VERSION")))
        .resolve_to_addrs(host, addresses);
    client.build().map_err(|error| words(&error))
}

/// Why, without the address: it may hold a secret.
fn words(error: &reqwest::Error) -> String {
    let kind = if error.is_timeout() {
        "no answer in time"
    } else if error.is_connect() {
        "no connection"
    } else {
        "the request broke off"
    };
    kind.to_owned()
}
