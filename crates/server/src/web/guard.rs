//! Who may ask: the API key, or, on a machine's own interface without a key, programs of that machine.

use std::net::IpAddr;

use axum::extract::{Request, State};
use axum::http::{HeaderMap, Method, StatusCode, header};
use axum::middleware::Next;
use axum::response::Response;
use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use sha2::{Digest as _, Sha256};

use crate::app::App;
use crate::problem::{Problem, Result};

/// Paths that tell nothing worth a key.
const OPEN: [&str; 3] = ["/healthz", "/readyz", "/openapi.json"];

/// An API key, as its hash.
#[derive(Clone, Copy)]
pub(crate) struct ApiKey([u8; 32]);

impl ApiKey {
    pub(crate) fn new(key: &str) -> Self {
        Self(Sha256::digest(key.as_bytes()).into())
    }

    /// Whether this is the key, in a time that does not tell how much of it is right.
    fn is(&self, presented: &str) -> bool {
        let presented: [u8; 32] = Sha256::digest(presented.as_bytes()).into();
        let difference = self.0.iter().zip(presented).fold(0, |all, (a, b)| all | (a ^ b));
        std::hint::black_box(difference) == 0
    }
}

/// Lets a request through, or says what it lacks.
pub(crate) async fn guard(State(app): State<App>, request: Request, next: Next) -> Result<Response> {
    if !OPEN.contains(&request.uri().path()) {
        match app.key() {
            Some(key) => authorised(key, request.method(), request.headers())?,
            None => from_this_machine(request.method(), request.headers())?,
        }
    }
    Ok(next.run(request).await)
}

fn authorised(key: &ApiKey, method: &Method, headers: &HeaderMap) -> Result<()> {
    let needed =
        || Problem::new(StatusCode::UNAUTHORIZED, "send the header `Authorization: Bearer KEY` with the server's API key");
    let value = headers.get(header::AUTHORIZATION).and_then(|value| value.to_str().ok()).ok_or_else(needed)?;
    let (scheme, rest) = value.split_once(' ').ok_or_else(needed)?;
    let presented = match scheme.to_ascii_lowercase().as_str() {
        "bearer" => rest.trim().to_owned(),
        // Browsers send this by themselves, also on behalf of other sites: good enough to look, not to change.
        "basic" if method.is_safe() => password(rest.trim()).ok_or_else(needed)?,
        _ => return Err(needed()),
    };
    if key.is(&presented) { Ok(()) } else { Err(needed()) }
}

/// The password of `user:password` in Base64.
fn password(encoded: &str) -> Option<String> {
    let text = String::from_utf8(BASE64_STANDARD.decode(encoded).ok()?).ok()?;
    text.split_once(':').map(|(_, password)| password.to_owned())
}

/// Without a key, web pages of others that a browser on this machine shows must not reach the server: neither by a name
/// that they let point here (`Host`), nor by sending forms (`Origin`).
fn from_this_machine(method: &Method, headers: &HeaderMap) -> Result<()> {
    let text = |name| headers.get(name).and_then(|value| value.to_str().ok());
    let refuse = |detail: String| Err(Problem::new(StatusCode::FORBIDDEN, detail));
    let host = text(header::HOST);
    if let Some(host) = host.filter(|host| !is_local(host)) {
        return refuse(format!("without an API key this server answers to localhost only, not to `{host}`"));
    }
    let origin = text(header::ORIGIN).map(|origin| origin.split_once("://").map_or(origin, |(_, authority)| authority));
    match origin.filter(|origin| !method.is_safe() && Some(*origin) != host) {
        Some(origin) => refuse(format!("without an API key this server takes no changes from the web site `{origin}`")),
        None => Ok(()),
    }
}

fn is_local(host: &str) -> bool {
    let name = match host.strip_prefix('[') {
        Some(rest) => rest.split(']').next().unwrap_or_default(),
        None => host.split(':').next().unwrap_or_default(),
    };
    name.eq_ignore_ascii_case("localhost") || name.parse().is_ok_and(|ip: IpAddr| ip.is_loopback())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn with(name: header::HeaderName, value: &str) -> HeaderMap {
        HeaderMap::from_iter([(name, value.parse().unwrap())])
    }

    #[test]
    fn only_the_key_opens() {
        let key = ApiKey::new("secret");
        let ask = |method: Method, value: &str| authorised(&key, &method, &with(header::AUTHORIZATION, value)).is_ok();
        assert!(ask(Method::POST, "Bearer secret") && ask(Method::GET, "bearer secret"));
        assert!(!ask(Method::GET, "Bearer secre") && !ask(Method::GET, "secret") && !ask(Method::GET, "Basic !"));
        let basic = format!("Basic {}", BASE64_STANDARD.encode("me:secret"));
        assert!(ask(Method::GET, &basic) && !ask(Method::POST, &basic));
        assert_eq!(authorised(&key, &Method::GET, &HeaderMap::new()).unwrap_err().status, 401);
    }

    #[test]
    fn without_a_key_other_sites_are_kept_out() {
        for host in ["localhost:8080", "127.0.0.1:1", "[::1]:80", "LOCALHOST"] {
            assert!(from_this_machine(&Method::GET, &with(header::HOST, host)).is_ok(), "{host}");
        }
        assert!(from_this_machine(&Method::GET, &with(header::HOST, "evil.example")).is_err());
        let mut headers = with(header::ORIGIN, "http://evil.example");
        headers.insert(header::HOST, "127.0.0.1:8080".parse().unwrap());
        assert!(from_this_machine(&Method::POST, &headers).is_err());
        headers.insert(header::ORIGIN, "http://127.0.0.1:8080".parse().unwrap());
        assert!(from_this_machine(&Method::POST, &headers).is_ok());
    }
}
