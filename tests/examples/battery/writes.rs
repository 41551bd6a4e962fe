//! Writes that a ledger keeps: each is unlike every other, so that it can be found again, and found
//! twice.

use rand::RngExt as _;
use rand_chacha::ChaCha12Rng;
use reqwest::Method;
use serde_json::json;

use crate::attack::Failure;
use crate::client::{Client, Reply};
use crate::documents;

/// What is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A ship of its own name.
    Ship,
    /// A law of its own name.
    Law,
    /// A trial with samples of its own.
    Trial,
    /// A refinement, asked for.
    Refinement,
    /// A version with an origin of its own.
    Version,
    /// A move of the writer's alias, with a reason of its own.
    Alias,
    /// A tag of its own.
    Tag,
}

const KINDS: [Kind; 10] = [
    Kind::Ship,
    Kind::Law,
    Kind::Trial,
    Kind::Trial,
    Kind::Refinement,
    Kind::Version,
    Kind::Version,
    Kind::Version,
    Kind::Alias,
    Kind::Tag,
];

/// A request that writes.
#[derive(Debug, Clone)]
pub struct Write {
    /// What it writes.
    pub kind: Kind,
    /// The ship that it is about.
    pub ship: String,
    /// What tells it from others: a name, an origin, a reason.
    pub mark: String,
    method: Method,
    path: String,
    media: &'static str,
    body: String,
    /// Its Idempotency-Key, where the route takes one.
    pub key: Option<String>,
    conditions: Vec<(&'static str, String)>,
}

/// Writes for one ship before the next one: a ship has at most 100 tags, and a refinement at most
/// 1000 trials.
pub const FOR_ONE_SHIP: u64 = 300;

impl Write {
    /// A new ship.
    pub fn ship(name: &str) -> Self {
        Self::keyed(
            Kind::Ship,
            name,
            name,
            "/v1/ships".to_owned(),
            "application/yaml",
            documents::ship(name),
        )
    }

    /// A new law.
    pub fn law(ship: &str, name: &str) -> Self {
        Self::keyed(
            Kind::Law,
            ship,
            name,
            "/v1/laws".to_owned(),
            "application/yaml",
            documents::law(name),
        )
    }

    /// A trial of a ship.
    pub fn trial(ship: &str, name: &str, number: u64) -> Self {
        let path = format!("/v1/trials?ship={ship}&name={name}.csv&diagnose=false");
        Self::keyed(
            Kind::Trial,
            ship,
            &format!("{name}.csv"),
            path,
            "text/csv",
            documents::rows(number),
        )
    }

    /// A refinement of a ship by all its trials.
    pub fn refinement(ship: &str, mark: &str) -> Self {
        let body = json!({ "ship": ship, "source": documents::PATTERN }).to_string();
        Self::keyed(
            Kind::Refinement,
            ship,
            mark,
            "/v1/refinements".to_owned(),
            "application/json",
            body,
        )
    }

    /// A version of a ship.
    ///
    /// # Errors
    /// The zoo has no model for it.
    pub fn version(ship: &str, origin: &str) -> Result<Self, Failure> {
        let body = documents::version(ship, origin)?.to_string();
        Ok(Self::keyed(
            Kind::Version,
            ship,
            origin,
            format!("/v1/models/{ship}/versions"),
            "application/json",
            body,
        ))
    }

    /// A move of an alias to a version, from a revision or from nothing.
    pub fn alias(ship: &str, reason: &str, version: u64, etag: Option<&str>) -> Self {
        let condition = match etag {
            Some(etag) => ("if-match", etag.to_owned()),
            None => ("if-none-match", "*".to_owned()),
        };
        let body = json!({ "version": version, "reason": reason }).to_string();
        let path = format!("/v1/models/{ship}/aliases/ledger");
        let write = Self::keyed(Kind::Alias, ship, reason, path, "application/json", body);
        Self { method: Method::PUT, key: None, conditions: vec![condition], ..write }
    }

    /// A tag on a ship.
    pub fn tag(ship: &str, tag: &str) -> Self {
        let path = format!("/v1/ships/{ship}/tags/{tag}");
        let write = Self::keyed(Kind::Tag, ship, tag, path, "application/json", String::new());
        Self { method: Method::PUT, key: None, ..write }
    }

    /// One of any kind.
    ///
    /// # Errors
    /// As [`Write::version`].
    pub async fn any(
        client: &Client,
        ship: &str,
        number: u64,
        rng: &mut ChaCha12Rng,
    ) -> Result<Self, Failure> {
        let name = format!("{ship}-{number}");
        Ok(match KINDS[rng.random_range(0..KINDS.len())] {
            Kind::Ship => Self::ship(&name),
            Kind::Law => Self::law(ship, &name),
            Kind::Trial => Self::trial(ship, &name, rng.random_range(0..1_000_000_000)),
            Kind::Refinement => Self::refinement(ship, &name),
            Kind::Tag => Self::tag(ship, &name),
            Kind::Version => Self::version(ship, &name)?,
            Kind::Alias => {
                let alias =
                    client.request(Method::GET, &format!("/v1/models/{ship}/aliases/ledger"));
                match client.send(alias).await {
                    Some(alias) if alias.ok() => {
                        Self::alias(ship, &name, 1, Some(alias.header("etag")))
                    }
                    Some(_) => Self::alias(ship, &name, 1, None),
                    // Without an answer it is not known whether there is an alias yet.
                    None => Self::tag(ship, &name),
                }
            }
        })
    }

    /// What a ship begins with, in the order of sending.
    ///
    /// # Errors
    /// The zoo has no model for it.
    pub fn first(ship: &str, number: u64) -> Result<[Self; 3], Failure> {
        Ok([
            Self::ship(ship),
            Self::version(ship, "the first")?,
            Self::trial(ship, "the-first", number),
        ])
    }

    /// The same without its key.
    pub fn unkeyed(self) -> Self {
        Self { key: None, ..self }
    }

    /// Sends it once.
    pub async fn send(&self, client: &Client) -> Option<Reply> {
        let request =
            client.request(self.method.clone(), &self.path).header("content-type", self.media);
        let request =
            self.key.iter().fold(request, |request, key| request.header("idempotency-key", key));
        let request = self
            .conditions
            .iter()
            .fold(request, |request, (name, value)| request.header(*name, value));
        client.send(request.body(self.body.clone())).await
    }

    fn keyed(
        kind: Kind,
        ship: &str,
        mark: &str,
        path: String,
        media: &'static str,
        body: String,
    ) -> Self {
        // Keys are the caller's over all ships, and have no spaces.
        let key = Some(format!("{ship}-{kind:?}-{mark}").replace(' ', "-"));
        let (ship, mark) = (ship.to_owned(), mark.to_owned());
        Self {
            kind,
            ship,
            mark,
            method: Method::POST,
            path,
            media,
            body,
            key,
            conditions: Vec::new(),
        }
    }
}
