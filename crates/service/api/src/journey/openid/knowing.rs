//! A server with an OpenID provider, and a browser that goes between them.

use std::collections::BTreeMap;
use std::net::{SocketAddr, TcpListener};

use reqwest::redirect::Policy;
use reqwest::{Client, Method, StatusCode, Url};
use serde_json::{Value, json};
use sistership_auth::openid::testing::{CLIENT, ScriptedProvider, with_secret};
use sistership_auth::openid::{OpenIdArguments, ProviderSettings};
use sistership_store::testing::TestDatabase;

use super::super::harness::{config, read};
use crate::{RunningServer, Server, StartError};

pub(super) const OWNER: &str = "sesame";
pub(super) const PASSWORD: &str = "a long sentence of its own";

/// A server with an OpenID provider.
pub(super) struct Knowing {
    pub server: RunningServer,
    pub url: String,
    pub client: Client,
}

/// Response to a browser.
pub(super) struct Shown {
    pub status: StatusCode,
    /// Address of a redirect.
    pub place: String,
    pub cookies: Vec<String>,
    pub text: String,
}

/// A browser: it keeps cookies, and follows no redirect by itself.
#[derive(Default)]
pub(super) struct Browser(pub BTreeMap<String, String>);

pub(super) fn settings(
    url: &str,
    issuer: &str,
    secret: &str,
    change: impl FnOnce(&mut OpenIdArguments),
) -> ProviderSettings {
    let mut told = OpenIdArguments {
        issuer: Some(issuer.to_owned()),
        client_id: Some(CLIENT.0.to_owned()),
        base_url: Some(url.to_owned()),
        title: Some("The yard".to_owned()),
        ..OpenIdArguments::default()
    };
    change(&mut told);
    with_secret(told.resolve_settings(&OpenIdArguments::default()).unwrap().unwrap(), secret)
}

/// Returns an address without a listener.
pub(super) fn free() -> SocketAddr {
    TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap()
}

impl Knowing {
    pub async fn start(
        database: &TestDatabase,
        listen: SocketAddr,
        settings: ProviderSettings,
    ) -> Result<Self, StartError> {
        let mut config = config(database);
        config.listen = listen;
        config.api_key = Some(OWNER.into());
        config.accounts = true;
        config.workers = 0;
        config.openid = Some(settings);
        let server = Server::start(config).await?;
        // A connection for each request: the provider closes idle ones, and a test may be slow.
        let client = Client::builder().redirect(Policy::none()).pool_max_idle_per_host(0);
        let client = client.build().unwrap();
        Ok(Self { url: server.url(), server, client })
    }

    pub async fn on(
        database: &TestDatabase,
        hostile: &ScriptedProvider,
        change: impl FnOnce(&mut OpenIdArguments),
    ) -> Self {
        let listen = free();
        let settings = settings(&format!("http://{listen}"), &hostile.url, CLIENT.1, change);
        Self::start(database, listen, settings).await.unwrap()
    }

    /// Sends a request as the owner.
    pub async fn owner(&self, method: Method, path: &str, body: &Value) -> Value {
        let request = self.client.request(method, format!("{}{path}", self.url));
        let (status, answer) =
            read(request.bearer_auth(OWNER).json(body).send().await.unwrap()).await;
        assert!(status.is_success(), "{path}: {answer}");
        answer
    }

    pub async fn user(&self, name: &str, role: &str) {
        let user = json!({ "name": name, "password": PASSWORD, "roles": [{ "role": role }] });
        self.owner(Method::POST, "/v1/users", &user).await;
    }

    /// Number of entries of the audit.
    pub async fn entries(&self) -> i64 {
        let head = self.owner(Method::GET, "/v1/audit/head", &Value::Null).await;
        head["number"].as_i64().unwrap()
    }

    /// Returns the last entries of the audit, the last first: action, actor and state afterwards.
    pub async fn audited(&self, count: usize) -> Vec<(String, String, Value)> {
        let audit =
            self.owner(Method::GET, &format!("/v1/audit?limit={count}"), &Value::Null).await;
        let text = |entry: &Value, name: &str| entry[name].as_str().unwrap_or_default().to_owned();
        let entries = audit["items"].as_array().unwrap().iter();
        entries
            .map(|entry| (text(entry, "action"), text(entry, "actor"), entry["after"].clone()))
            .collect()
    }
}

impl Browser {
    pub async fn asks(
        &mut self,
        client: &Client,
        method: Method,
        url: &str,
        form: &[(&str, &str)],
    ) -> Shown {
        let cookies: Vec<String> =
            self.0.iter().map(|(name, value)| format!("{name}={value}")).collect();
        let mut request = client.request(method.clone(), url).header("accept", "text/html");
        request = request.header("cookie", cookies.join("; "));
        if method == Method::POST {
            let own = Url::parse(url).unwrap().origin().ascii_serialization();
            request = request.header("origin", own);
            request = request.header("content-type", "application/x-www-form-urlencoded");
            request = request.body(serde_urlencoded::to_string(form).unwrap());
        }
        let response = request.send().await.unwrap();
        let of = |name: &str| {
            let values = response.headers().get_all(name).iter();
            values.map(|value| value.to_str().unwrap().to_owned()).collect::<Vec<_>>()
        };
        let (status, cookies) = (response.status(), of("set-cookie"));
        let place = of("location").pop().unwrap_or_default();
        self.keep(&cookies);
        Shown { status, place, cookies, text: response.text().await.unwrap() }
    }

    fn keep(&mut self, cookies: &[String]) {
        for cookie in cookies {
            let (name, rest) = cookie.split_once('=').unwrap();
            let value = rest.split(';').next().unwrap();
            let gone = value.is_empty() || cookie.contains("Max-Age=0");
            match gone {
                true => drop(self.0.remove(name)),
                false => drop(self.0.insert(name.to_owned(), value.to_owned())),
            }
        }
    }

    pub async fn looks(&mut self, on: &Knowing, path: &str) -> Shown {
        self.asks(&on.client, Method::GET, &format!("{}{path}", on.url), &[]).await
    }

    pub async fn sends(&mut self, on: &Knowing, path: &str, form: &[(&str, &str)]) -> Shown {
        self.asks(&on.client, Method::POST, &format!("{}{path}", on.url), form).await
    }

    /// Goes to the provider, which admits the person; returns the address of the way back.
    pub async fn leaves(&mut self, on: &Knowing, hostile: &ScriptedProvider, next: &str) -> String {
        let gone = self.looks(on, &format!("/sign-in/oidc{next}")).await;
        assert_eq!(gone.status, StatusCode::SEE_OTHER, "{}", gone.text);
        assert!(gone.place.starts_with(&format!("{}/authorize?", hostile.url)), "{}", gone.place);
        format!("/sign-in/oidc/callback?{}", hostile.accept_person(&gone.place))
    }

    pub async fn signs_in(&mut self, on: &Knowing, hostile: &ScriptedProvider) -> Shown {
        let back = self.leaves(on, hostile, "").await;
        self.looks(on, &back).await
    }

    /// Returns the user whom the server names.
    pub async fn me(&mut self, on: &Knowing) -> Value {
        let shown = self.looks(on, "/v1/me").await;
        serde_json::from_str(&shown.text).unwrap_or_default()
    }
}

pub(super) fn claims(hostile: &ScriptedProvider, claims: Value) {
    hostile.lock_script().claims = claims.as_object().unwrap().clone();
}

pub(in crate::journey) fn token(page: &str) -> &str {
    page.split("name=\"form_token\" value=\"").nth(1).unwrap().split('"').next().unwrap()
}
