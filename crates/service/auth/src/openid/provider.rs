//! Client of an OpenID provider. Its discovery document is requested at the first sign-in, so that
//! a provider that is down does not affect other functions of the server.

use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use crate::random_secret;
use reqwest::{Client, RequestBuilder, StatusCode, Url, header};
use serde::Deserialize;
use serde_json::{Map, Value};

use crate::openid::failure::{Result, SignInFailure};
use crate::openid::fetch;
use crate::openid::identity::ProviderIdentity;
use crate::openid::keys::KeySet;
use crate::openid::metadata::{ProviderMetadata, discovery_url};
use crate::openid::settings::ProviderSettings;
use crate::openid::ticket::{SignInPurpose, SignInTicket};
use crate::openid::token::{self, ExpectedClaims};

/// Time for which the discovery document and the keys of a provider are reused.
const MAX_CACHE_AGE: Duration = Duration::from_secs(3600);

/// Client of an OpenID provider.
pub struct OpenIdProvider {
    settings: ProviderSettings,
    /// Key with which the tickets of browsers are sealed.
    seal: String,
    known: Mutex<Option<Arc<ProviderCache>>>,
}

/// Discovery document and keys of a provider.
#[derive(Debug)]
struct ProviderCache {
    client: Client,
    metadata: ProviderMetadata,
    keys: KeySet,
    at: Instant,
}

/// A sign-in that has begun.
#[derive(Clone, PartialEq, Eq)]
pub struct SignInStart {
    /// URL to which the browser goes.
    pub place: String,
    /// Sealed ticket that the browser keeps meanwhile.
    pub ticket: String,
}

/// Query with which the provider sends the browser back.
#[derive(Clone, Default, Deserialize)]
pub struct CallbackQuery {
    code: Option<String>,
    state: Option<String>,
    error: Option<String>,
    iss: Option<String>,
}

/// A completed sign-in.
#[derive(Debug, Clone, PartialEq)]
pub struct SignInResult {
    /// Identity of the person.
    pub identity: ProviderIdentity,
    /// Purpose of the sign-in.
    pub purpose: SignInPurpose,
    /// Target of the browser after the sign-in.
    pub next: String,
    /// Hash of the sign-in, by which a second use is recognised.
    pub sha256: String,
    /// Expiry of the sign-in, seconds of the Unix epoch.
    pub until_s: i64,
}

impl CallbackQuery {
    /// Parses the query of the browser; one with a repeated parameter counts as empty.
    pub fn read(query: &str) -> Self {
        serde_urlencoded::from_str(query).unwrap_or_default()
    }
}

#[derive(Deserialize)]
struct TokenResponse {
    id_token: Option<String>,
    access_token: Option<String>,
}

#[derive(Deserialize)]
struct ErrorResponse {
    error: String,
}

impl OpenIdProvider {
    /// Creates the client of a provider. No request is made yet.
    ///
    /// # Errors
    /// Returns an error if the system gives no random numbers.
    pub fn new(settings: ProviderSettings) -> Result<Self> {
        // Derived from the client secret, so that several servers with this secret can read each
        // other's tickets.
        let seal = match &settings.client_secret {
            Some(known) => crate::sign_message(known, b"sistership tickets"),
            None => random_secret().map_err(|_| {
                SignInFailure::Provider("random numbers are not available".to_owned())
            })?,
        };
        Ok(Self { settings, seal, known: Mutex::default() })
    }

    /// Returns the settings.
    pub fn settings(&self) -> &ProviderSettings {
        &self.settings
    }

    /// Begins a sign-in at the time `now_s`, seconds of the Unix epoch, which continues at `next`.
    /// # Errors
    /// Returns an error if the provider does not answer, or the system gives no random numbers.
    pub async fn begin_sign_in(
        &self,
        purpose: SignInPurpose,
        next: &str,
        now_s: i64,
    ) -> Result<SignInStart> {
        let known = self.cached_metadata().await?;
        let broken = || SignInFailure::Provider("a sign-in cannot be started".to_owned());
        let ticket = SignInTicket::new(purpose, next, now_s).ok_or_else(broken)?;
        let mut place = Url::parse(&known.metadata.authorization_endpoint).map_err(|_| broken())?;
        place
            .query_pairs_mut()
            .append_pair("response_type", "code")
            .append_pair("client_id", &self.settings.client_id)
            .append_pair("redirect_uri", &self.settings.redirect_uri())
            .append_pair("scope", &self.settings.scopes)
            // `state` binds the answer to this browser, `nonce` the ID token to this sign-in, and
            // the challenge the code to the verifier (PKCE).
            .append_pair("state", &ticket.state())
            .append_pair("nonce", &ticket.nonce())
            .append_pair("code_challenge", &ticket.challenge())
            .append_pair("code_challenge_method", "S256");
        let ticket = ticket.to_sealed(&self.seal).ok_or_else(broken)?;
        Ok(SignInStart { place: place.into(), ticket })
    }

    /// Completes a sign-in: exchanges the code of the answer for tokens, and checks them.
    ///
    /// # Errors
    /// Returns an error if the person was refused, or the identity is not proven.
    pub async fn finish_sign_in(
        &self,
        ticket: Option<&str>,
        answer: &CallbackQuery,
        now_s: i64,
    ) -> Result<SignInResult> {
        let ticket = ticket.and_then(|text| SignInTicket::from_sealed(text, &self.seal, now_s));
        let ticket = ticket.ok_or(SignInFailure::Expired)?;
        let state = answer.state.as_deref().unwrap_or_default();
        if !crate::constant_time_eq(state.as_bytes(), ticket.state().as_bytes()) {
            return Err(SignInFailure::Expired);
        }
        let known = self.cached_metadata().await?;
        if !known.metadata.is_from(answer.iss.as_deref()) {
            return Err(SignInFailure::Untrusted("another provider has answered".to_owned()));
        }
        if let Some(error) = &answer.error {
            return Err(authorization_error(error));
        }
        let code = answer.code.as_deref().filter(|code| !code.is_empty());
        let code = code.ok_or_else(|| SignInFailure::Provider("it sends no code".to_owned()))?;
        let tokens = self.exchange_code(&known, code, &ticket).await?;
        let identity = self.verify_identity(&known, tokens, &ticket).await?;
        let (sha256, until_s) = (ticket.sha256(), ticket.until_s());
        Ok(SignInResult { identity, purpose: ticket.purpose, next: ticket.next, sha256, until_s })
    }

    /// Returns the discovery document and the keys, at most an hour old.
    async fn cached_metadata(&self) -> Result<Arc<ProviderCache>> {
        let known = self.known.lock().unwrap_or_else(PoisonError::into_inner).clone();
        match known.filter(|known| known.at.elapsed() < MAX_CACHE_AGE) {
            Some(known) => Ok(known),
            None => self.fetch_metadata().await,
        }
    }

    async fn fetch_metadata(&self) -> Result<Arc<ProviderCache>> {
        let client = fetch::build_client()?;
        let issuer = &self.settings.issuer;
        let body =
            fetch::fetch_document(client.get(discovery_url(issuer)), "discovery document").await?;
        let metadata: ProviderMetadata = fetch::parse_document(&body, "discovery document")?;
        let metadata = metadata.check_issuer(issuer)?;
        let keys = fetch_keys(&client, &metadata).await?;
        Ok(self.store_metadata(ProviderCache { client, metadata, keys, at: Instant::now() }))
    }

    fn store_metadata(&self, known: ProviderCache) -> Arc<ProviderCache> {
        let known = Arc::new(known);
        *self.known.lock().unwrap_or_else(PoisonError::into_inner) = Some(Arc::clone(&known));
        known
    }

    /// Exchanges a code for tokens (RFC 6749, 4.1.3).
    async fn exchange_code(
        &self,
        known: &ProviderCache,
        code: &str,
        ticket: &SignInTicket,
    ) -> Result<TokenResponse> {
        let (redirect, verifier) = (self.settings.redirect_uri(), ticket.verifier());
        let id = &self.settings.client_id;
        let mut form = vec![
            ("grant_type", "authorization_code"),
            ("code", code),
            ("redirect_uri", &redirect),
            ("code_verifier", &verifier),
        ];
        let mut request = known.client.post(&known.metadata.token_endpoint);
        match &self.settings.client_secret {
            Some(secret) if known.metadata.secret_in_body() => {
                form.extend([("client_id", id.as_str()), ("client_secret", secret)]);
            }
            // Both are form-encoded first (RFC 6749, 2.3.1).
            Some(secret) => request = request.basic_auth(as_in_form(id), Some(as_in_form(secret))),
            None => form.push(("client_id", id)),
        }
        let body = serde_urlencoded::to_string(form)
            .map_err(|_| SignInFailure::Provider("its code cannot be exchanged".to_owned()))?;
        let request = request
            .header(header::CONTENT_TYPE, "application/x-www-form-urlencoded")
            .header(header::ACCEPT, "application/json")
            .body(body);
        match fetch::fetch_answer(request).await? {
            (StatusCode::OK, body) => fetch::parse_document(&body, "token"),
            (status, body) => Err(token_error(status, &body)),
        }
    }

    /// Returns the identity that the tokens prove.
    async fn verify_identity(
        &self,
        known: &ProviderCache,
        tokens: TokenResponse,
        ticket: &SignInTicket,
    ) -> Result<ProviderIdentity> {
        let TokenResponse { id_token, access_token } = tokens;
        let id_token =
            id_token.ok_or_else(|| SignInFailure::Untrusted("it sends no ID token".to_owned()))?;
        let nonce = ticket.nonce();
        let (issuer, client_id) = (self.settings.issuer.as_str(), self.settings.client_id.as_str());
        let expected = ExpectedClaims { issuer, client_id, nonce: &nonce };
        let header = token::read_header(&id_token)?;
        let claims = match token::verify_token(&id_token, &header, &known.keys, expected)? {
            Some(claims) => claims,
            // Signed by a key that was not known: the provider may have new keys. One request for
            // each sign-in, which itself costs the provider a request.
            None => {
                let keys = fetch_keys(&known.client, &known.metadata).await?;
                let found = token::verify_token(&id_token, &header, &keys, expected)?;
                let (client, metadata) = (known.client.clone(), known.metadata.clone());
                // The age stays that of the discovery document, which was not read again.
                self.store_metadata(ProviderCache { client, metadata, keys, at: known.at });
                let unknown = "its token is signed by a key that it does not publish";
                found.ok_or_else(|| SignInFailure::Untrusted(unknown.to_owned()))?
            }
        };
        let (issuer, subject) = (claims.iss, claims.sub);
        let mut identity = ProviderIdentity { issuer, subject, claims: claims.others };
        if !self.settings.admission.is_answered_by(&identity.claims) {
            self.add_user_info(known, access_token, &mut identity).await?;
        }
        Ok(identity)
    }

    /// Adds claims from the UserInfo endpoint (OpenID Connect Core 1.0, 5.3).
    async fn add_user_info(
        &self,
        known: &ProviderCache,
        access_token: Option<String>,
        identity: &mut ProviderIdentity,
    ) -> Result<()> {
        let (Some(place), Some(token)) = (&known.metadata.userinfo_endpoint, access_token) else {
            return Ok(());
        };
        let request: RequestBuilder = known.client.get(place).bearer_auth(token);
        let body = fetch::fetch_document(request, "description of you").await?;
        let claims: Map<String, Value> = fetch::parse_document(&body, "description of you")?;
        // The subject must be that of the ID token, otherwise the claims describe another person.
        if claims.get("sub").and_then(Value::as_str) != Some(&identity.subject) {
            return Err(SignInFailure::Untrusted("the description is of another user".to_owned()));
        }
        for (claim, value) in claims {
            identity.claims.entry(claim).or_insert(value);
        }
        Ok(())
    }
}

async fn fetch_keys(client: &Client, metadata: &ProviderMetadata) -> Result<KeySet> {
    let body = fetch::fetch_document(client.get(&metadata.jwks_uri), "set of keys").await?;
    KeySet::read(&body)
        .ok_or_else(|| SignInFailure::Provider("its set of keys cannot be parsed".to_owned()))
}

fn as_in_form(text: &str) -> String {
    serde_urlencoded::to_string([("", text)]).unwrap_or_default().trim_start_matches('=').to_owned()
}

/// Returns an error code in the form of the standard, or a fixed text: the query is not
/// trustworthy.
fn plain_error_code(text: &str) -> &str {
    let plain =
        text.len() <= 64 && text.bytes().all(|byte| byte.is_ascii_lowercase() || byte == b'_');
    if plain { text } else { "with an error code that is not in the standard" }
}

/// Maps an error of the authorization endpoint (RFC 6749, 4.1.2.1; OpenID Connect, 3.1.2.6).
fn authorization_error(error: &str) -> SignInFailure {
    match error {
        "access_denied"
        | "login_required"
        | "consent_required"
        | "interaction_required"
        | "account_selection_required" => SignInFailure::Denied,
        "temporarily_unavailable" | "server_error" => {
            SignInFailure::Unreachable(plain_error_code(error).to_owned())
        }
        other => SignInFailure::Refused(plain_error_code(other).to_owned()),
    }
}

/// Maps an error of the token endpoint (RFC 6749, 5.2).
fn token_error(status: StatusCode, body: &[u8]) -> SignInFailure {
    match fetch::parse_document::<ErrorResponse>(body, "refusal") {
        Ok(refusal) if refusal.error == "invalid_grant" => SignInFailure::Expired,
        Ok(refusal) => SignInFailure::Refused(plain_error_code(&refusal.error).to_owned()),
        Err(_) => {
            SignInFailure::Provider(format!("the exchange of its code gives {}", status.as_u16()))
        }
    }
}

impl fmt::Debug for OpenIdProvider {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.debug_tuple("Provider").field(&self.settings).finish()
    }
}
