//! A provider whose answers a test can falsify. It signs its own tokens, by ring and not by the
//! library that reads them, and follows the protocol unless a test changes that.

use std::collections::{BTreeMap, HashMap};
use std::sync::{Arc, Mutex, MutexGuard};
use std::time::{SystemTime, UNIX_EPOCH};

use base64::Engine as _;
use base64::prelude::{BASE64_STANDARD, BASE64_URL_SAFE_NO_PAD};
use ring::rand::SystemRandom;
use ring::signature::{ECDSA_P256_SHA256_FIXED_SIGNING, EcdsaKeyPair, KeyPair as _};
use serde_json::{Map, Value, json};
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::{TcpListener, TcpStream};

/// Name and secret of the client.
pub const CLIENT: (&str, &str) = ("ships", "a secret: with signs & spaces");

/// A provider on this machine with configurable answers.
#[derive(Debug)]
pub struct ScriptedProvider {
    /// Its issuer.
    pub url: String,
    told: Arc<Mutex<ProviderScript>>,
}

/// Behaviour of the provider, and the requests to it.
#[derive(Debug)]
pub struct ProviderScript {
    /// The keys by name.
    keys: BTreeMap<String, EcdsaKeyPair>,
    /// Names of the published keys.
    pub published: Vec<String>,
    /// Name of the key that signs.
    pub signs: String,
    /// Replaced fields of the next token's header; null removes a field.
    pub head: Map<String, Value>,
    /// Replaced claims of the next token; null removes a claim.
    pub claims: Map<String, Value>,
    /// Final modification of the next token.
    pub mangle: fn(String) -> String,
    /// Replaced fields of the discovery document.
    pub discovery: Map<String, Value>,
    /// Answer of the UserInfo endpoint.
    pub described: Value,
    /// True if it checks PKCE.
    pub checks_pkce: bool,
    /// True if it answers every request with 503.
    pub down: bool,
    /// Nonce and challenge by code; each code can be used once.
    codes: HashMap<String, (String, String)>,
    /// Number of requests by path.
    pub asked: HashMap<String, usize>,
    /// Method by which the client has authenticated itself.
    pub client_by: &'static str,
}

/// Returns the time, seconds of the Unix epoch.
///
/// # Panics
/// Panics if the clock is before the epoch.
pub fn now_s() -> i64 {
    SystemTime::now()
        .duration_since(UNIX_EPOCH)
        .expect("a provider for tests")
        .as_secs()
        .try_into()
        .expect("a provider for tests")
}

fn generate_key() -> EcdsaKeyPair {
    let (random, kind) = (SystemRandom::new(), &ECDSA_P256_SHA256_FIXED_SIGNING);
    let document = EcdsaKeyPair::generate_pkcs8(kind, &random).expect("a provider for tests");
    EcdsaKeyPair::from_pkcs8(kind, document.as_ref(), &random).expect("a provider for tests")
}

fn base64_url(bytes: impl AsRef<[u8]>) -> String {
    BASE64_URL_SAFE_NO_PAD.encode(bytes)
}

impl ProviderScript {
    /// Creates a key, which is not published yet.
    pub fn add_key(&mut self, name: &str) {
        self.keys.insert(name.to_owned(), generate_key());
    }

    fn key_set(&self) -> Value {
        let known = |name: &String| {
            // An uncompressed point: one byte of format, then 32 bytes each of x and y.
            let point = self.keys[name].public_key().as_ref();
            json!({ "kty": "EC", "crv": "P-256", "use": "sig", "alg": "ES256", "kid": name,
                "x": base64_url(&point[1..33]), "y": base64_url(&point[33..]) })
        };
        json!({ "keys": self.published.iter().map(known).collect::<Vec<_>>() })
    }

    fn signed_token(&self, issuer: &str, nonce: &str) -> String {
        let head = json!({ "alg": "ES256", "kid": self.signs });
        let claims = json!({ "iss": issuer, "sub": "7-of-9", "aud": CLIENT.0, "nonce": nonce,
            "iat": now_s(), "exp": now_s() + 300, "preferred_username": "Ann" });
        let head = apply_changes(head, &self.head).to_string();
        let signed = format!(
            "{}.{}",
            base64_url(head),
            base64_url(apply_changes(claims, &self.claims).to_string())
        );
        // A JSON Web Signature covers the encoded header and claims, joined by a dot.
        let signature = self.keys[&self.signs]
            .sign(&SystemRandom::new(), signed.as_bytes())
            .expect("a provider for tests");
        (self.mangle)(format!("{signed}.{}", base64_url(signature)))
    }

    fn discovery_document(&self, url: &str) -> Value {
        let about = json!({ "issuer": url, "authorization_endpoint": format!("{url}/authorize"),
            "token_endpoint": format!("{url}/token"), "jwks_uri": format!("{url}/keys"),
            "userinfo_endpoint": format!("{url}/userinfo"),
            "authorization_response_iss_parameter_supported": true });
        apply_changes(about, &self.discovery)
    }

    /// Returns status and body of the answer to a request.
    fn answer_request(&mut self, url: &str, path: &str, head: &str, body: &str) -> (u16, String) {
        *self.asked.entry(path.to_owned()).or_default() += 1;
        if self.down {
            return (503, String::new());
        }
        match path {
            "/.well-known/openid-configuration" => (200, self.discovery_document(url).to_string()),
            "/keys" => (200, self.key_set().to_string()),
            "/userinfo" if head.contains("bearer an-access-token") => {
                (200, self.described.to_string())
            }
            "/token" => self.exchange_code(url, head, body),
            _ => (404, String::new()),
        }
    }

    fn exchange_code(&mut self, url: &str, head: &str, body: &str) -> (u16, String) {
        let form: HashMap<String, String> =
            serde_urlencoded::from_str(body).expect("a provider for tests");
        let refused = |error: &str| (400, json!({ "error": error }).to_string());
        self.client_by = match client_method(head, &form) {
            Some(by) => by,
            None => return refused("invalid_client"),
        };
        // Removed, not only read: a second use of a code is refused.
        let Some((nonce, challenge)) = self.codes.remove(&form["code"]) else {
            return refused("invalid_grant");
        };
        let hash = ring::digest::digest(&ring::digest::SHA256, form["code_verifier"].as_bytes());
        if self.checks_pkce && base64_url(hash) != challenge {
            return refused("invalid_grant");
        }
        assert_eq!(form["grant_type"], "authorization_code");
        assert!(form["redirect_uri"].ends_with("/sign-in/oidc/callback"));
        let token = self.signed_token(url, &nonce);
        (
            200,
            json!({ "id_token": token, "access_token": "an-access-token", "token_type": "Bearer" })
                .to_string(),
        )
    }
}

/// Returns the method by which a client has authenticated itself, if it has.
fn client_method(head: &str, form: &HashMap<String, String>) -> Option<&'static str> {
    // Name and secret of the client in form encoding; the request's head was set to lower case.
    let basic = BASE64_STANDARD.encode("ships:a+secret%3A+with+signs+%26+spaces").to_lowercase();
    let (id, secret) = (form.get("client_id"), form.get("client_secret"));
    match (id.map(String::as_str), secret.map(String::as_str)) {
        (None, None) => head.contains(&format!("basic {basic}")).then_some("header"),
        (Some(id), Some(secret)) => (id == CLIENT.0 && secret == CLIENT.1).then_some("body"),
        (Some(id), None) => (id == CLIENT.0).then_some("nothing"),
        (None, Some(_)) => None,
    }
}

fn apply_changes(mut value: Value, changes: &Map<String, Value>) -> Value {
    let fields = value.as_object_mut().expect("a provider for tests");
    for (name, change) in changes {
        match change {
            Value::Null => fields.remove(name),
            change => fields.insert(name.clone(), change.clone()),
        };
    }
    value
}

impl ScriptedProvider {
    /// Starts the provider.
    ///
    /// # Panics
    /// Panics if it cannot start.
    pub async fn start() -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").await.expect("a provider for tests");
        let url = format!("http://{}", listener.local_addr().expect("a provider for tests"));
        let mut told = ProviderScript {
            keys: BTreeMap::new(),
            published: vec!["first".into()],
            signs: "first".into(),
            head: Map::new(),
            claims: Map::new(),
            mangle: |token| token,
            discovery: Map::new(),
            described: Value::Null,
            checks_pkce: true,
            down: false,
            codes: HashMap::new(),
            asked: HashMap::new(),
            client_by: "",
        };
        told.add_key("first");
        let hostile = Self { url, told: Arc::new(Mutex::new(told)) };
        let (url, told) = (hostile.url.clone(), Arc::clone(&hostile.told));
        tokio::spawn(async move {
            while let Ok((stream, _)) = listener.accept().await {
                tokio::spawn(serve_connection(stream, url.clone(), Arc::clone(&told)));
            }
        });
        hostile
    }

    /// Returns the behaviour, for reading and changing.
    ///
    /// # Panics
    /// Panics if the provider has panicked.
    pub fn lock_script(&self) -> MutexGuard<'_, ProviderScript> {
        self.told.lock().expect("a provider for tests")
    }

    /// Accepts the person at this authorization URL; returns the query with which the browser is
    /// sent back.
    ///
    /// # Panics
    /// Panics if the URL is not a valid request.
    pub fn accept_person(&self, place: &str) -> String {
        let (_, query) = place.split_once("/authorize?").expect("its own endpoint");
        let asked: HashMap<String, String> =
            serde_urlencoded::from_str(query).expect("a provider for tests");
        assert_eq!((&*asked["response_type"], &*asked["client_id"]), ("code", CLIENT.0));
        assert_eq!(
            (&*asked["code_challenge_method"], &*asked["scope"]),
            ("S256", "openid profile email")
        );
        let mut told = self.lock_script();
        let code = format!("code-{}", told.codes.len() + told.asked.values().sum::<usize>());
        told.codes.insert(code.clone(), (asked["nonce"].clone(), asked["code_challenge"].clone()));
        let answer = [("code", &code), ("state", &asked["state"]), ("iss", &self.url)];
        serde_urlencoded::to_string(answer).expect("a provider for tests")
    }
}

async fn serve_connection(
    mut stream: TcpStream,
    url: String,
    told: Arc<Mutex<ProviderScript>>,
) -> std::io::Result<()> {
    let mut bytes = Vec::new();
    loop {
        let mut part = [0; 4096];
        let read = stream.read(&mut part).await?;
        bytes.extend_from_slice(&part[..read]);
        let text = String::from_utf8_lossy(&bytes).into_owned();
        let Some((head, body)) = text.split_once("\r\n\r\n") else {
            if read == 0 {
                return Ok(());
            }
            continue;
        };
        let head = head.to_lowercase();
        let length = head.split_once("content-length: ").map_or("0", |(_, rest)| rest);
        let length: usize = length.lines().next().unwrap_or_default().parse().unwrap_or(0);
        // The rest of the body is still to come.
        if body.len() < length {
            continue;
        }
        let path = head.split(' ').nth(1).unwrap_or_default().to_owned();
        let (status, answer) =
            told.lock().expect("a provider for tests").answer_request(&url, &path, &head, body);
        let answer = format!(
            "HTTP/1.1 {status} x\r\nContent-Type: application/json\r\nContent-Length: \
             {}\r\nConnection: close\r\n\r\n{answer}",
            answer.len()
        );
        return stream.write_all(answer.as_bytes()).await;
    }
}
