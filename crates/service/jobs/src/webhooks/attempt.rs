//! Single attempt of a delivery.

use std::net::SocketAddr;
use std::time::Duration;

use reqwest::{Client, Url, redirect};
use sistership_auth::sign_message;
use sistership_store::{Delivery, Webhook, provide_cryptography};

use super::addresses::is_public;

/// Timeout of an attempt.
const TIMEOUT: Duration = Duration::from_secs(15);

/// An attempt to send a delivery.
pub(super) struct DeliveryAttempt<'a> {
    pub delivery: &'a Delivery,
    pub webhook: &'a Webhook,
    /// Address of the receiver.
    pub url: Url,
    /// Body in the format of the receiver.
    pub body: String,
    pub now_us: i64,
    /// True if the receiver may be in a private network and use plain http.
    pub private: bool,
}

impl DeliveryAttempt<'_> {
    /// Sends the delivery once; returns the status of the answer, or the reason of the failure.
    pub async fn send_once(self) -> Result<String, String> {
        // The client's own timeout does not include the look-up of the name.
        let sent = tokio::time::timeout(TIMEOUT, self.send_delivery());
        sent.await.unwrap_or_else(|_| Err("no answer in time".to_owned()))
    }

    async fn send_delivery(self) -> Result<String, String> {
        let Self { delivery, webhook, url, body, now_us, private } = self;
        let client = pinned_client(&url, &resolve_addresses(&url, private).await?)?;
        let at_s = now_us / 1_000_000;
        // The time is part of the signed text, so that a receiver can refuse a replay.
        let signed = sign_message(&webhook.secret, format!("{at_s}.{body}").as_bytes());
        let request = client
            .post(url)
            .header("Content-Type", "application/json")
            .header("Sistership-Event", &delivery.event)
            .header("Sistership-Delivery", &delivery.id)
            .header("Sistership-Signature", format!("t={at_s},v1={signed}"))
            .body(body);
        let answer = request.send().await.map_err(|error| describe_error(&error))?;
        // The body of the answer is not read: it could be of any size and content.
        match answer.status() {
            status if status.is_success() => Ok(status.as_u16().to_string()),
            status => Err(format!("answered {}", status.as_u16())),
        }
    }
}

/// Resolves the addresses of a receiver, if all of them are allowed.
async fn resolve_addresses(url: &Url, private: bool) -> Result<Vec<SocketAddr>, String> {
    let host = url.host_str().unwrap_or_default().trim_matches(['[', ']']);
    let port = url.port_or_known_default().unwrap_or(443);
    let found = tokio::net::lookup_host((host, port)).await;
    let found: Vec<SocketAddr> = found.map_err(|_| format!("{host} has no address"))?.collect();
    // One private address is enough to refuse: the client could choose it.
    match found.iter().find(|address| !private && !is_public(address.ip())) {
        Some(address) => Err(format!("{host} is {}, which is not public", address.ip())),
        None => Ok(found),
    }
}

/// Creates a client that connects only to the addresses that were checked, whatever the name
/// resolves to later; it follows no redirect and uses no proxy.
fn pinned_client(url: &Url, addresses: &[SocketAddr]) -> Result<Client, String> {
    provide_cryptography();
    let host = url.host_str().unwrap_or_default();
    let client = Client::builder()
        .timeout(TIMEOUT)
        .redirect(redirect::Policy::none())
        .no_proxy()
        .user_agent(concat!("sistership/", env!("CARGO_PKG_VERSION")))
        .resolve_to_addrs(host, addresses);
    client.build().map_err(|error| describe_error(&error))
}

/// Describes an error without the URL, which may contain a secret.
fn describe_error(error: &reqwest::Error) -> String {
    let kind = if error.is_timeout() {
        "no answer in time"
    } else if error.is_connect() {
        "no connection"
    } else {
        "the connection was interrupted"
    };
    kind.to_owned()
}
