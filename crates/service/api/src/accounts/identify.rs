//! Identification of the caller: by a key, by the session of a browser, or by being on this
//! machine.

use std::sync::Arc;

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use http::{HeaderMap, Method, StatusCode, header};
use sistership_auth::{ServiceKey, hex, sha256};
use sistership_store::{KeyRow, User};
use sistership_web_support::acting::{Kind, Principal};
use sistership_web_support::host;
use sistership_web_support::problem::{Problem, Result};

use crate::accounts::credentials::Accounts;
use crate::accounts::grants::rights;

/// Name of the session cookie.
pub const COOKIE: &str = "sistership_session";

/// Shortest interval at which the use of a key is recorded, µs.
const NOTED_EVERY: i64 = 60_000_000;

/// Reason for which a caller is not identified.
#[derive(Debug)]
pub enum Refusal {
    /// Another error.
    Problem(Problem),
    /// A key was presented that is not valid.
    WrongKey(Problem),
}

impl From<Problem> for Refusal {
    fn from(problem: Problem) -> Self {
        Self::Problem(problem)
    }
}

type Identified = std::result::Result<Arc<Principal>, Refusal>;

impl Accounts<'_> {
    /// Returns the caller of a request; `own` is true if a page of this server sends it.
    ///
    /// # Errors
    /// Returns 401 without valid credentials, marked as a wrong key if one was presented.
    pub async fn identify(&self, method: &Method, headers: &HeaderMap, own: bool) -> Identified {
        // Browsers send some credentials by themselves, also on behalf of other sites: good enough
        // to read, not to change, unless the browser says that a page of this server asks.
        let by_browser = method.is_safe() || own;
        if let Some(found) = self.presented(headers, by_browser).await? {
            return Ok(found);
        }
        if by_browser && let Some(found) = self.session(headers).await? {
            return Ok(found);
        }
        match self.credentials.is_open() {
            true => Ok(Arc::new(Principal::owner("local", Kind::Local))),
            false => Err(needed().into()),
        }
    }

    /// Returns the caller by the header `Authorization`; `None` if it is missing, or not needed.
    async fn presented(
        &self,
        headers: &HeaderMap,
        by_browser: bool,
    ) -> std::result::Result<Option<Arc<Principal>>, Refusal> {
        let Some(value) = host::single(headers, &header::AUTHORIZATION)? else { return Ok(None) };
        let Some((key, basic)) = key_of(value) else {
            return if self.credentials.is_open() { Ok(None) } else { Err(needed().into()) };
        };
        if basic && !by_browser {
            return Err(needed().into());
        }
        if self.credentials.key().is_some_and(|own| own.is(&key)) {
            return Ok(Some(Arc::new(Principal::owner("server-key", Kind::ServerKey))));
        }
        match self.service(&key).await? {
            Some(found) => Ok(Some(found)),
            None if self.credentials.is_open() => Ok(None),
            None => Err(Refusal::WrongKey(needed())),
        }
    }

    /// Returns the caller of a service key.
    async fn service(&self, text: &str) -> Result<Option<Arc<Principal>>> {
        let Some(prefix) = ServiceKey::prefix(text) else { return Ok(None) };
        // The cache is cleared whenever rights change.
        if let Some(found) = self.credentials.known.get(text) {
            return Ok(Some(found));
        }
        let store = self.store;
        let Some(row) = store.service_keys().find(prefix).await? else { return Ok(None) };
        let kept = ServiceKey { prefix: row.prefix.clone(), sha256: row.sha256.clone() };
        if !row.is_valid(store.now_us()) || !kept.is(text) {
            return Ok(None);
        }
        if let Some(name) = &row.user_name
            && !store.users().get(name).await?.is_enabled()
        {
            return Ok(None);
        }
        self.note_use(&row);
        let principal = KeyRow::principal(prefix);
        let rights = rights(self.store, &principal).await?;
        let name = row.user_name.unwrap_or(principal);
        Ok(Some(self.credentials.known.put(text, Principal { name, rights, kind: Kind::Key })))
    }

    /// Records that a key is used. The request does not wait for it.
    fn note_use(&self, row: &KeyRow) {
        if row.last_used_us.is_some_and(|last| self.store.now_us() - last < NOTED_EVERY) {
            return;
        }
        let (store, prefix) = (self.store.clone(), row.prefix.clone());
        tokio::spawn(async move {
            if let Err(error) = store.service_keys().used(&prefix).await {
                tracing::warn!(%error, "the use of a key could not be noted");
            }
        });
    }

    /// Returns the user who has signed in with this browser.
    pub(crate) async fn session(&self, headers: &HeaderMap) -> Result<Option<Arc<Principal>>> {
        let Some(secret) = cookie(headers, COOKIE) else { return Ok(None) };
        if let Some(found) = self.credentials.known.get(secret) {
            return Ok(Some(found));
        }
        // The store has only the hash of the secret.
        let hash = hex(&sha256(secret));
        let Some(session) = self.store.sessions().find(&hash).await? else { return Ok(None) };
        let user = self.store.users().get(&session.user_name).await?;
        if !user.is_enabled() {
            return Ok(None);
        }
        let rights = rights(self.store, &User::principal(&user.name)).await?;
        let form_token = hex(&sha256(&format!("form {secret}")));
        let kind = Kind::Session { form_token, sha256: hash };
        Ok(Some(self.credentials.known.put(secret, Principal { name: user.name, rights, kind })))
    }
}

fn needed() -> Problem {
    Problem::new(
        StatusCode::UNAUTHORIZED,
        "send the header `Authorization: Bearer KEY` with the server's API key or a service key; \
         people sign in at /sign-in",
    )
}

/// Returns the key of a header, and whether a browser sends it by itself.
fn key_of(value: &str) -> Option<(String, bool)> {
    let (scheme, rest) = value.split_once(' ')?;
    match scheme.to_ascii_lowercase().as_str() {
        "bearer" => Some((rest.trim().to_owned(), false)),
        "basic" => Some((password(rest.trim())?, true)),
        _ => None,
    }
}

/// Returns the password of `user:password` in Base64.
fn password(encoded: &str) -> Option<String> {
    let text = String::from_utf8(BASE64_STANDARD.decode(encoded).ok()?).ok()?;
    text.split_once(':').map(|(_, password)| password.to_owned())
}

/// Returns the cookie of a name.
pub fn cookie<'a>(headers: &'a HeaderMap, name: &str) -> Option<&'a str> {
    let lines = headers.get_all(header::COOKIE).iter().filter_map(|value| value.to_str().ok());
    let mut pairs = lines.flat_map(|line| line.split(';')).filter_map(|pair| pair.split_once('='));
    pairs.find(|(known, _)| known.trim() == name).map(|(_, value)| value.trim())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn keys_are_read_from_either_header() {
        assert_eq!(key_of("Bearer secret"), Some(("secret".into(), false)));
        assert_eq!(key_of("bearer  secret"), Some(("secret".into(), false)));
        let basic = format!("Basic {}", BASE64_STANDARD.encode("me:secret"));
        assert_eq!(key_of(&basic), Some(("secret".into(), true)));
        for wrong in ["secret", "Basic !", "Digest x", ""] {
            assert_eq!(key_of(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn the_session_is_one_cookie_among_others() {
        let headers = |line: &str| HeaderMap::from_iter([(header::COOKIE, line.parse().unwrap())]);
        assert_eq!(cookie(&headers("a=b; sistership_session=x; c=d"), COOKIE), Some("x"));
        assert_eq!(cookie(&headers("sistership_session2=x"), COOKIE), None);
        assert_eq!(cookie(&HeaderMap::new(), COOKIE), None);
    }
}
