//! `rights`: every route of the document, by a key of every role for one ship, with the
//! identifiers of another ship.

use std::time::Instant;

use reqwest::Method;
use serde_json::{Value, json};

use crate::attack::{Attack, Failure, Field, Running};
use crate::client::Client;
use crate::documents;

/// The server's own key.
const OWNER: &str = "rights-of-the-battery";
/// The ship on which the callers have a role.
const OWN: &str = "mariner";
/// The ship on which they have none.
const FOREIGN: &str = documents::PATTERN;
/// Part of the texts of the foreign objects.
const MARK: &str = "hidden-from-others";
const ROLES: [&str; 3] = ["reader", "engineer", "approver"];

/// The attack.
pub struct Rights;

impl Attack for Rights {
    fn name(&self) -> &'static str {
        "rights"
    }

    fn share(&self) -> f64 {
        0.3
    }

    fn run<'a>(&'a self, field: &'a Field) -> Running<'a> {
        Box::pin(run(field))
    }
}

async fn run(field: &Field) -> Result<(), Failure> {
    let place = field.place().await?;
    let start = place.start().environment([("SISTERSHIP_API_KEY", OWNER)]);
    let server = start.argument("--no-worker").argument("--accounts").server().await?;
    let client = &server.client;
    let ids = foreign_ids(client).await?;
    let document: Value = serde_json::from_str(include_str!("../../../../api/openapi.json"))?;
    let paths = document["paths"].as_object().ok_or("no paths")?;
    let (mut routes, mut rounds) = (0, 0);
    while rounds == 0 || Instant::now() < field.until && rounds < 3 {
        rounds += 1;
        routes = 0;
        for role in ROLES {
            let key = key_for_own(client, role).await?;
            for (path, methods) in paths {
                for method in methods.as_object().ok_or("no methods")?.keys() {
                    routes += 1;
                    ask(field, client, &key, (role, method, path), &ids).await?;
                }
            }
        }
    }
    server.process.kill();
    place.check("after the callers without rights").await?;
    field.tally.remark(format!("{routes} routes by role"));
    Ok(())
}

/// A key with a role for the own ship only.
async fn key_for_own(client: &Client, role: &str) -> Result<String, Failure> {
    let body = json!({ "title": role, "roles": [{ "role": role, "ship": OWN }] });
    let request = client.request(Method::POST, "/v1/keys").bearer_auth(OWNER).json(&body);
    let made = client.try_send(request).await?.json();
    made["key"].as_str().map(str::to_owned).ok_or_else(|| format!("no key: {made}").into())
}

/// Identifiers of objects of the foreign ship, each of which leads somewhere for the owner.
struct ForeignIds {
    trial: String,
    job: String,
    session: String,
}

async fn foreign_ids(client: &Client) -> Result<ForeignIds, Failure> {
    let path = format!("/v1/trials?ship={FOREIGN}&name={MARK}.csv&diagnose=false");
    let trial = client.request(Method::POST, &path).bearer_auth(OWNER);
    let trial = trial.header("content-type", "text/csv").body(documents::rows(7));
    let trial = client.try_send(trial).await?.json();
    let post = async |path: &str, body: Value| -> Result<Value, Failure> {
        let request = client.request(Method::POST, path).bearer_auth(OWNER).json(&body);
        Ok(client.try_send(request).await?.json())
    };
    let job = post("/v1/refinements", json!({ "ship": FOREIGN, "source": FOREIGN })).await?;
    let session = post("/v1/sessions", json!({ "model": FOREIGN })).await?;
    let text = |value: &Value| value.as_str().map(str::to_owned).ok_or("an object is missing");
    Ok(ForeignIds {
        trial: text(&trial["trials"][0]["id"])?,
        job: text(&job["id"])?,
        session: text(&session["id"])?,
    })
}

/// Sends one request with foreign identifiers in its path, its query and its body.
async fn ask(
    field: &Field,
    client: &Client,
    key: &str,
    (role, method, path): (&str, &str, &str),
    ids: &ForeignIds,
) -> Result<(), Failure> {
    let id = match path.split('/').nth(2) {
        Some("jobs") => &ids.job,
        Some("sessions") => &ids.session,
        _ => &ids.trial,
    };
    let place = path
        .replace("{ship}", FOREIGN)
        .replace("{model}", FOREIGN)
        .replace("{number}", "1")
        .replace("{alias}", "champion")
        .replace("{tag}", "own")
        .replace("{id}", id);
    let query = match path {
        "/v1/trials" | "/v1/jobs" if method == "get" => format!("?ship={FOREIGN}"),
        "/v1/trials" => format!("?ship={FOREIGN}&name=a.csv"),
        "/v1/compare" => format!("?version={OWN}&version={OWN}/1&trial={}", ids.trial),
        _ => String::new(),
    };
    let request = client.request(method.to_uppercase().parse()?, &format!("{place}{query}"));
    let request = request.bearer_auth(key);
    let request = match method {
        "post" | "put" if path == "/v1/trials" => {
            request.header("content-type", "text/csv").body(documents::rows(8))
        }
        "post" | "put" => request.json(&json!({ "ship": FOREIGN, "model": FOREIGN })),
        _ => request,
    };
    let reply = client.try_send(request).await?;
    let said = String::from_utf8_lossy(&reply.bytes);
    // A route with a foreign identifier in its path refuses; all others say nothing of its objects.
    let foreign = ["{ship}", "{model}", "{id}"].iter().any(|name| path.contains(name));
    if (foreign && reply.ok()) || said.contains(MARK) || said.contains(&ids.job) {
        let answer = crate::client::clipped(&said);
        field.tally.wrong(format!("{method} {path} as {role}: {}: {answer}", reply.status));
    }
    Ok(())
}
