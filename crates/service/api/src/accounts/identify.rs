//! Identification of the caller: by a key, by the session of a browser, or by being on this
//! machine.

use std::sync::Arc;

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use http::{HeaderMap, Method, StatusCode, header};
use sistership_auth::{ServiceKey, hash_text, to_hex};
use sistership_store::{KeyRow, User};
use sistership_web_support::acting::{AuthenticationKind, Principal};
use sistership_web_support::host;
use sistership_web_support::problem::{Problem, Result};

use crate::accounts::credentials::Accounts;
use crate::accounts::grants::principal_rights;

/// Name of the session cookie.
pub const SESSION_COOKIE: &str = "sistership_session";

/// Shortest interval at which the use of a key is recorded, µs.
const USE_RECORD_INTERVAL_US: i64 = 60_000_000;

/// Reason for which a caller is not identified.
#[derive(Debug)]
pub enum IdentityRefusal {
    /// Another error.
    Problem(Problem),
    /// A key was presented that is not valid.
    WrongKey(Problem),
}

impl From<Problem> for IdentityRefusal {
    fn from(problem: Problem) -> Self {
        Self::Problem(problem)
    }
}

type IdentityResult = std::result::Result<Arc<Principal>, IdentityRefusal>;

impl Accounts<'_> {
    /// Returns the caller of a request; `own` is true if a page of this server sends it.
    ///
    /// # Errors
    /// Returns 401 without valid credentials, marked as a wrong key if one was presented.
    pub async fn identify(
        &self,
        method: &Method,
        headers: &HeaderMap,
        own: bool,
    ) -> IdentityResult {
        // Browsers send some credentials by themselves, also on behalf of other sites: good enough
        // to read, not to change, unless the browser says that a page of this server asks.
        let by_browser = method.is_safe() || own;
        if let Some(found) = self.by_authorization(headers, by_browser).await? {
            return Ok(found);
        }
        if by_browser && let Some(found) = self.by_session(headers).await? {
            return Ok(found);
        }
        match self.credentials.is_open() {
            true => Ok(Arc::new(Principal::with_all_rights("local", AuthenticationKind::Local))),
            false => Err(credentials_needed().into()),
        }
    }

    /// Returns the caller by the header `Authorization`; `None` if it is missing, or not needed.
    async fn by_authorization(
        &self,
        headers: &HeaderMap,
        by_browser: bool,
    ) -> std::result::Result<Option<Arc<Principal>>, IdentityRefusal> {
        let Some(value) = host::single_header(headers, &header::AUTHORIZATION)? else {
            return Ok(None);
        };
        let Some((key, basic)) = parse_authorization(value) else {
            return if self.credentials.is_open() {
                Ok(None)
            } else {
                Err(credentials_needed().into())
            };
        };
        if basic && !by_browser {
            return Err(credentials_needed().into());
        }
        if self.credentials.server_key().is_some_and(|own| own.matches_key(&key)) {
            return Ok(Some(Arc::new(Principal::with_all_rights(
                "server-key",
                AuthenticationKind::ServerKey,
            ))));
        }
        match self.by_service_key(&key).await? {
            Some(found) => Ok(Some(found)),
            None if self.credentials.is_open() => Ok(None),
            None => Err(IdentityRefusal::WrongKey(credentials_needed())),
        }
    }

    /// Returns the caller of a service key.
    async fn by_service_key(&self, text: &str) -> Result<Option<Arc<Principal>>> {
        let Some(prefix) = ServiceKey::parse_prefix(text) else { return Ok(None) };
        // The cache is cleared whenever rights change.
        if let Some(found) = self.credentials.known.get(text) {
            return Ok(Some(found));
        }
        let store = self.store;
        let Some(row) = store.service_keys().find(prefix).await? else { return Ok(None) };
        let kept = ServiceKey { prefix: row.prefix.clone(), sha256: row.sha256.clone() };
        if !row.is_valid(store.now_us()) || !kept.matches_text(text) {
            return Ok(None);
        }
        if let Some(name) = &row.user_name
            && !store.users().get(name).await?.is_enabled()
        {
            return Ok(None);
        }
        self.record_key_use(&row);
        let principal = KeyRow::principal_name(prefix);
        let rights = principal_rights(self.store, &principal).await?;
        let name = row.user_name.unwrap_or(principal);
        Ok(Some(
            self.credentials
                .known
                .insert_principal(text, Principal { name, rights, kind: AuthenticationKind::Key }),
        ))
    }

    /// Records that a key is used. The request does not wait for it.
    fn record_key_use(&self, row: &KeyRow) {
        if row.last_used_us.is_some_and(|last| self.store.now_us() - last < USE_RECORD_INTERVAL_US)
        {
            return;
        }
        let (store, prefix) = (self.store.clone(), row.prefix.clone());
        tokio::spawn(async move {
            if let Err(error) = store.service_keys().record_use(&prefix).await {
                tracing::warn!(%error, "the use of a key could not be recorded");
            }
        });
    }

    /// Returns the user who has signed in with this browser.
    pub(crate) async fn by_session(&self, headers: &HeaderMap) -> Result<Option<Arc<Principal>>> {
        let Some(secret) = find_cookie(headers, SESSION_COOKIE) else { return Ok(None) };
        if let Some(found) = self.credentials.known.get(secret) {
            return Ok(Some(found));
        }
        // The store has only the hash of the secret.
        let hash = to_hex(&hash_text(secret));
        let Some(session) = self.store.sessions().find(&hash).await? else { return Ok(None) };
        let user = self.store.users().get(&session.user_name).await?;
        if !user.is_enabled() {
            return Ok(None);
        }
        let rights = principal_rights(self.store, &User::principal_name(&user.name)).await?;
        let form_token = to_hex(&hash_text(&format!("form {secret}")));
        let kind = AuthenticationKind::Session { form_token, sha256: hash };
        Ok(Some(
            self.credentials
                .known
                .insert_principal(secret, Principal { name: user.name, rights, kind }),
        ))
    }
}

fn credentials_needed() -> Problem {
    Problem::new(
        StatusCode::UNAUTHORIZED,
        "send the header `Authorization: Bearer KEY` with the server's API key or a service key; \
         people sign in at /sign-in",
    )
}

/// Returns the key of a header, and whether a browser sends it by itself.
fn parse_authorization(value: &str) -> Option<(String, bool)> {
    let (scheme, rest) = value.split_once(' ')?;
    match scheme.to_ascii_lowercase().as_str() {
        "bearer" => Some((rest.trim().to_owned(), false)),
        "basic" => Some((basic_password(rest.trim())?, true)),
        _ => None,
    }
}

/// Returns the password of `user:password` in Base64.
fn basic_password(encoded: &str) -> Option<String> {
    let text = String::from_utf8(BASE64_STANDARD.decode(encoded).ok()?).ok()?;
    text.split_once(':').map(|(_, password)| password.to_owned())
}

/// Returns the cookie of a name.
pub fn find_cookie<'a>(headers: &'a HeaderMap, name: &str) -> Option<&'a str> {
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
        assert_eq!(parse_authorization("Bearer secret"), Some(("secret".into(), false)));
        assert_eq!(parse_authorization("bearer  secret"), Some(("secret".into(), false)));
        let basic = format!("Basic {}", BASE64_STANDARD.encode("me:secret"));
        assert_eq!(parse_authorization(&basic), Some(("secret".into(), true)));
        for wrong in ["secret", "Basic !", "Digest x", ""] {
            assert_eq!(parse_authorization(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn the_session_is_one_cookie_among_others() {
        let headers = |line: &str| HeaderMap::from_iter([(header::COOKIE, line.parse().unwrap())]);
        assert_eq!(
            find_cookie(&headers("a=b; sistership_session=x; c=d"), SESSION_COOKIE),
            Some("x")
        );
        assert_eq!(find_cookie(&headers("sistership_session2=x"), SESSION_COOKIE), None);
        assert_eq!(find_cookie(&HeaderMap::new(), SESSION_COOKIE), None);
    }
}
