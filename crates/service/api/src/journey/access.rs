//! Access: every route for every role, on both databases; and its record in the audit.

use std::collections::BTreeSet;
use std::path::Path;

use reqwest::redirect::Policy;
use reqwest::{Client, Method, StatusCode};
use serde_json::{Value, json};
use sistership_auth::Role;
use sistership_store::testing::TestDatabase;
use sistership_store::{JobClaim, NewOutcome, NewVersion, WorkerClaim};

use super::harness::{Harness, config, read};
use crate::Server;
use crate::rights::{HEALTH_ROUTES, IDENTIFIED_ROUTES, OPEN_ROUTES, ROLE_TABLE};

/// The server's own key.
pub(super) const OWNER: &str = "sesame";
const PASSWORD: &str = "a long sentence of its own";

impl Harness {
    /// Starts a server that identifies every caller.
    pub(super) async fn guarded(database: TestDatabase) -> Self {
        let mut config = config(&database);
        config.api_key = Some(OWNER.into());
        config.accounts = true;
        config.workers = 0;
        let server = Server::start(config).await.unwrap();
        let client = Client::builder().redirect(Policy::none()).build().unwrap();
        Self { server, client, database }
    }

    /// Sends a request with a key, or without one.
    pub(super) async fn asks(
        &self,
        key: Option<&str>,
        method: Method,
        path: &str,
    ) -> (StatusCode, Value) {
        let request = self.client.request(method, self.url(path));
        let request = match key {
            Some(key) => request.bearer_auth(key),
            None => request,
        };
        read(request.send().await.unwrap()).await
    }

    /// Sends a document with a key.
    pub(super) async fn sends(
        &self,
        key: &str,
        method: Method,
        path: &str,
        body: &Value,
    ) -> (StatusCode, Value) {
        let request = self.client.request(method, self.url(path)).bearer_auth(key).json(body);
        read(request.send().await.unwrap()).await
    }

    /// Creates a service key with these roles.
    pub(super) async fn key(&self, about: &Value) -> String {
        let (status, made) = self.sends(OWNER, Method::POST, "/v1/keys", about).await;
        assert_eq!(status, StatusCode::CREATED, "{made}");
        made["key"].as_str().unwrap().to_owned()
    }

    async fn key_of(&self, role: &str) -> String {
        self.key(&json!({ "title": role, "roles": [{ "role": role }] })).await
    }
}

/// Returns every route of the server: those of the document, and those of pages, by the source that
/// registers them.
fn routes() -> BTreeSet<(String, String)> {
    let document = crate::openapi();
    let mut all = BTreeSet::new();
    for (path, methods) in document["paths"].as_object().unwrap() {
        for method in methods.as_object().unwrap().keys() {
            all.insert((method.to_uppercase(), path.clone()));
        }
    }
    let source = include_str!("../routes/pages/mod.rs").replace("\n            ", "");
    for line in source.split(".route(\"").skip(1) {
        let (path, rest) = line.split_once('"').unwrap();
        for (name, method) in [("get(", "GET"), ("post(", "POST")] {
            if rest.lines().next().unwrap().contains(name) {
                all.insert((method.to_owned(), path.to_owned()));
            }
        }
    }
    all.insert(("GET".into(), "/openapi.json".into()));
    all
}

/// Every route is in the table once, and nothing else is.
#[test]
fn the_table_has_every_route() {
    let known = ROLE_TABLE.iter().map(|(method, path, ..)| (*method, *path));
    let rows: Vec<(&str, &str)> =
        known.chain(IDENTIFIED_ROUTES).chain(HEALTH_ROUTES).chain(OPEN_ROUTES).collect();
    let set: BTreeSet<(String, String)> =
        rows.iter().map(|(method, path)| ((*method).to_owned(), (*path).to_owned())).collect();
    assert_eq!(set.len(), rows.len(), "rights/table.rs has a row twice");
    let routes = routes();
    assert!(routes.len() > 100, "{}", routes.len());
    let missing: Vec<_> = routes.difference(&set).collect();
    let gone: Vec<_> = set.difference(&routes).collect();
    assert!(
        missing.is_empty() && gone.is_empty(),
        "rights/table.rs: add a row for each of {missing:?}, remove the rows of {gone:?}"
    );
}

/// The table as people read it.
fn written() -> String {
    let mut text =
        "# Who may do what\n\nGenerated from `crates/service/api/src/rights/table.rs` by \
         `UPDATE_RIGHTS=1 cargo test -p sistership-api --lib the_table_is_written_down`. Each \
         role has the rights of those before it. A role may be given for the whole server, or for \
         one ship or family; then it opens what the last column names. Where approval by a second \
         person is required, moving the alias `champion` needs the role approver.\n\n| method | \
         route | reader | engineer | approver | admin | given for |\n| --- | --- | --- | --- | \
         --- | --- | --- |\n"
            .to_owned();
    for (method, path, least, of) in ROLE_TABLE {
        let marks = Role::ALL.map(|role| if role >= *least { "yes" } else { "no" }).join(" | ");
        text += &format!("| {method} | `{path}` | {marks} | {} |\n", of.description());
    }
    text += "\nFor whoever has shown who they are, without any role: ";
    text += &IDENTIFIED_ROUTES.map(|(method, path)| format!("{method} `{path}`")).join(", ");
    text += ". For everybody: ";
    let open: Vec<String> = HEALTH_ROUTES
        .iter()
        .chain(&OPEN_ROUTES)
        .map(|(method, path)| format!("{method} `{path}`"))
        .collect();
    text += &open.join(", ");
    text + ".\n"
}

#[test]
fn the_table_is_written_down() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../docs/rights.md");
    if std::env::var_os("UPDATE_RIGHTS").is_some() {
        std::fs::write(&path, written()).unwrap();
    }
    let there = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(
        there == written(),
        "docs/rights.md is not current: run this test with UPDATE_RIGHTS=1, and read the difference"
    );
}

/// Returns a path with names that do not exist, so that an allowed request changes nothing.
fn filled(path: &str) -> String {
    let parts = path.split('/').map(|part| match part {
        "{number}" => "1",
        "{prefix}" => "000000000000",
        "{id}" | "{draft}" => "00000000-0000-0000-0000-000000000000",
        "{sha256}" => "0000000000000000000000000000000000000000000000000000000000000000",
        part if part.starts_with('{') => "nothing",
        part => part,
    });
    parts.collect::<Vec<_>>().join("/")
}

/// Returns true if the answer is the refusal of a caller whose roles do not suffice.
pub(super) fn is_refused(status: StatusCode, problem: &Value) -> bool {
    let detail = problem["detail"].as_str().unwrap_or_default();
    status == StatusCode::FORBIDDEN && detail.starts_with("this needs the role ")
}

async fn each_route_is_for_the_roles_of_the_table(database: TestDatabase) {
    let harness = Harness::guarded(database).await;
    let mut keys = Vec::new();
    for role in Role::ALL {
        keys.push((role, harness.key_of(role.as_str()).await));
    }
    let none = harness.key(&json!({ "title": "no role" })).await;
    let mut faults = Vec::new();
    for (method, path, least, _) in ROLE_TABLE {
        let (asked, place) = (method.parse::<Method>().unwrap(), filled(path));
        let (status, problem) = harness.asks(None, asked.clone(), &place).await;
        if status != StatusCode::UNAUTHORIZED || problem["status"] != 401 {
            faults.push(format!("{method} {path} without a key: {status}"));
        }
        let (status, problem) = harness.asks(Some(&none), asked.clone(), &place).await;
        if !is_refused(status, &problem) {
            faults.push(format!("{method} {path} without a role: {status} {problem}"));
        }
        for (role, key) in &keys {
            let (status, problem) = harness.asks(Some(key), asked.clone(), &place).await;
            let wrong = status == StatusCode::UNAUTHORIZED || status.is_server_error();
            if wrong || is_refused(status, &problem) != (role < least) {
                faults.push(format!("{method} {path} as {role}: {status} {problem}"));
            }
        }
    }
    for (method, path) in IDENTIFIED_ROUTES {
        let (status, _) = harness.asks(None, method.parse().unwrap(), path).await;
        let (known, problem) = harness.asks(Some(&none), method.parse().unwrap(), path).await;
        if status != StatusCode::UNAUTHORIZED || is_refused(known, &problem) {
            faults.push(format!("{method} {path}: {status}, {known}"));
        }
    }
    for (method, path) in HEALTH_ROUTES.into_iter().chain(OPEN_ROUTES) {
        let (status, _) = harness.asks(None, method.parse().unwrap(), path).await;
        if status == StatusCode::UNAUTHORIZED {
            faults.push(format!("{method} {path}: {status}"));
        }
    }
    assert!(faults.is_empty(), "{} faults:\n{}", faults.len(), faults.join("\n"));
    harness.server.stop().await;
}

/// A role for one ship or family opens it, and nothing else.
async fn a_role_for_a_ship_goes_no_further(database: TestDatabase) {
    let harness = Harness::guarded(database).await;
    let family = json!({ "name": "tankers", "foundation": "kvlcc2/1", "members": ["kvlcc2"] });
    let (status, made) = harness.sends(OWNER, Method::POST, "/v1/families", &family).await;
    assert_eq!(status, StatusCode::CREATED, "{made}");
    let roles = json!([{ "role": "engineer", "ship": "mariner" },
        { "role": "reader", "family": "tankers" }]);
    let key = harness.key(&json!({ "title": "limited", "roles": roles })).await;
    let ask = async |method: Method, path: &str, body: Value| {
        let (status, problem) = harness.sends(&key, method, path, &body).await;
        (!is_refused(status, &problem), status)
    };
    let tag = "/v1/ships/mariner/tags/own";
    assert_eq!(ask(Method::PUT, tag, Value::Null).await, (true, StatusCode::NO_CONTENT));
    assert!(ask(Method::GET, "/v1/ships/mariner/model", Value::Null).await.0);
    assert!(ask(Method::GET, "/v1/trials?ship=mariner", Value::Null).await.0);
    assert!(ask(Method::GET, "/v1/laws", Value::Null).await.0);
    assert!(ask(Method::GET, "/v1/ships/kvlcc2", Value::Null).await.0, "by its family");
    assert!(ask(Method::GET, "/v1/families/tankers/members", Value::Null).await.0);
    let refine = |ship: &str| json!({ "ship": ship, "source": "mariner" });
    assert_eq!(ask(Method::POST, "/v1/refinements", refine("mariner")).await.1, 422, "no trials");
    let sail = |model: &str| json!({ "model": model, "manoeuvre": { "turn_deg": 20 } });
    assert!(ask(Method::POST, "/v1/predictions", sail("mariner")).await.0);
    for (method, path, body) in [
        (Method::GET, "/v1/ships", Value::Null),
        (Method::GET, "/v1/ships/kcs", Value::Null),
        (Method::PUT, "/v1/ships/kvlcc2/tags/own", Value::Null),
        (Method::GET, "/v1/trials?ship=kcs", Value::Null),
        (Method::GET, "/v1/jobs", Value::Null),
        (Method::POST, "/v1/families/tankers/members", json!({ "ships": ["kcs"] })),
        (Method::POST, "/v1/refinements", refine("kcs")),
        (Method::POST, "/v1/diagnoses", json!({ "model": "kvlcc2" })),
        (Method::POST, "/v1/predictions", sail("kcs")),
        (Method::GET, "/v1/compare?version=mariner&version=kcs", Value::Null),
        (Method::POST, "/v1/trials?ship=kcs", Value::Null),
    ] {
        let request = harness.client.request(method, harness.url(path)).bearer_auth(&key);
        let request = match path.starts_with("/v1/trials?ship=kcs") && body.is_null() {
            true => request.header("content-type", "text/csv").body("t_s,u_m_s\n0,1\n1,1\n"),
            false => request.json(&body),
        };
        let (status, problem) = read(request.send().await.unwrap()).await;
        assert!(is_refused(status, &problem), "{path}: {status} {problem}");
    }
    foreign_trials(&harness, &key).await;
    let similar = harness.asks(Some(&key), Method::GET, "/v1/ships/mariner/similar").await.1;
    let ranked = similar["ranking"].as_array().unwrap().iter().map(|one| one["ship"].as_str());
    assert_eq!(ranked.collect::<Vec<_>>(), [Some("kvlcc2")], "others it has no role for");
    family_jobs(&harness).await;
    harness.server.stop().await;
}

/// A trial of a ship without a role is not there, wherever a request names it.
async fn foreign_trials(harness: &Harness, key: &str) {
    let csv = "t_s,u_m_s,v_m_s,r_rad_s,delta_rad\n0,8,0,0,0\n1,8,0,0,0\n2,8,0,0,0\n3,8,0,0,0\n";
    let post = harness.client.post(harness.url("/v1/trials?ship=kcs&name=a.csv&diagnose=false"));
    let post = post.bearer_auth(OWNER).header("content-type", "text/csv").body(csv);
    let (status, uploaded) = read(post.send().await.unwrap()).await;
    assert_eq!(status, StatusCode::CREATED, "{uploaded}");
    let id = uploaded["trials"][0]["id"].as_str().unwrap();
    let compare = format!("/v1/compare?version=mariner&version=mariner/1&trial={id}");
    let (status, problem) = harness.asks(Some(key), Method::GET, &compare).await;
    assert_eq!(status, StatusCode::UNPROCESSABLE_ENTITY, "{problem}");
    assert!(problem.to_string().contains("there is no trial"), "{problem}");
    assert_eq!(harness.asks(Some(OWNER), Method::GET, &compare).await.0, StatusCode::OK);
    for path in ["/v1/refinements", "/v1/diagnoses", "/v1/branches"] {
        let model = if path == "/v1/refinements" { "ship" } else { "model" };
        let body = json!({ model: "mariner", "trials": [id] });
        let (status, problem) = harness.sends(key, Method::POST, path, &body).await;
        assert_eq!(status, StatusCode::UNPROCESSABLE_ENTITY, "{path}: {problem}");
        assert!(!problem.to_string().contains("kcs"), "{path} names its ship: {problem}");
    }
}

/// The user who queued a job of a family can read and cancel it; a user without a role for it
/// cannot.
async fn family_jobs(harness: &Harness) {
    let roles = |family: &str| json!([{ "role": "engineer", "family": family }]);
    let own = harness.key(&json!({ "title": "own", "roles": roles("tankers") })).await;
    let other = json!({ "name": "söhne-100%", "foundation": "kcs/1", "members": [] });
    let post = harness.client.post(harness.url("/v1/families")).bearer_auth(OWNER).json(&other);
    let made = post.send().await.unwrap();
    assert_eq!(made.status(), StatusCode::CREATED);
    assert_eq!(made.headers()["location"], "/v1/families/s%C3%B6hne-100%25");
    let foreign = harness.key(&json!({ "title": "foreign", "roles": roles("söhne-100%") })).await;
    let (status, job) =
        harness.sends(&own, Method::POST, "/v1/families/tankers/prior", &Value::Null).await;
    assert_eq!(status, StatusCode::ACCEPTED, "{job}");
    let path = format!("/v1/jobs/{}", job["id"].as_str().unwrap());
    assert_eq!(harness.asks(Some(&own), Method::GET, &path).await.0, StatusCode::OK);
    let (status, problem) = harness.asks(Some(&foreign), Method::GET, &path).await;
    assert!(is_refused(status, &problem), "{status} {problem}");
    assert_eq!(harness.asks(Some(&own), Method::DELETE, &path).await.0, StatusCode::OK);
}

/// Behind a trusted proxy wrong passwords count for the client that it names, and the audit has its
/// address; what the client itself wrote into the header is not believed.
#[tokio::test(flavor = "multi_thread")]
async fn one_client_behind_a_proxy_does_not_shut_out_others() {
    let database = TestDatabase::new_sqlite();
    let mut config = config(&database);
    (config.api_key, config.accounts, config.workers) = (Some(OWNER.into()), true, 0);
    config.proxies.networks = vec!["127.0.0.0/8".parse().unwrap()];
    let server = Server::start(config).await.unwrap();
    let client = Client::builder().redirect(Policy::none()).build().unwrap();
    let harness = Harness { server, client, database };
    let user = json!({ "name": "ann", "password": PASSWORD, "roles": [{ "role": "reader" }] });
    let (status, made) = harness.sends(OWNER, Method::POST, "/v1/users", &user).await;
    assert_eq!(status, StatusCode::CREATED, "{made}");
    let page = harness.client.get(harness.url("/sign-in")).send().await.unwrap();
    let token = super::sessions::token(&page.text().await.unwrap());
    let sign_in = async |from: &str, password: &str| {
        let form = [("form_token", &*token), ("name", "ann"), ("password", password)];
        let body = serde_urlencoded::to_string(form).unwrap();
        let post = harness.client.post(harness.url("/sign-in")).body(body);
        let post = post.header("content-type", "application/x-www-form-urlencoded");
        let post = post.header("origin", harness.url(""));
        post.header("x-forwarded-for", from).send().await.unwrap().status()
    };
    for guess in 0..5 {
        let from = format!("10.9.9.{guess}, 203.0.113.1");
        assert_ne!(sign_in(&from, "a wrong sentence of mine").await, 429, "{guess}");
    }
    let again = sign_in("10.9.9.9, 203.0.113.1", PASSWORD).await;
    assert_eq!(again, StatusCode::TOO_MANY_REQUESTS, "the same client");
    assert_eq!(sign_in("203.0.113.2", PASSWORD).await, StatusCode::SEE_OTHER, "another client");
    harness.server.stop().await;
}

/// Keys and users identify callers until they are revoked or disabled.
async fn keys_and_users_come_and_go(database: TestDatabase) {
    let harness = Harness::guarded(database).await;
    let user = json!({ "name": "ann", "password": PASSWORD, "roles": [{ "role": "engineer" }] });
    let (status, ann) = harness.sends(OWNER, Method::POST, "/v1/users", &user).await;
    assert_eq!((status, &ann["has_password"]), (StatusCode::CREATED, &json!(true)), "{ann}");
    assert!(!ann.to_string().contains("argon2"), "{ann}");
    let about = json!({ "title": "of ann", "user": "ann", "roles": [{ "role": "reader" }] });
    let key = harness.key(&about).await;
    let me = harness.asks(Some(&key), Method::GET, "/v1/me").await.1;
    assert_eq!(
        (&me["name"], &me["kind"], &me["roles"][0]["role"]),
        (&json!("ann"), &json!("key"), &json!("reader"))
    );
    let me = harness.asks(Some(OWNER), Method::GET, "/v1/me").await.1;
    assert_eq!((&me["name"], &me["roles"][0]["role"]), (&json!("server-key"), &json!("admin")));
    let roles = json!({ "roles": [{ "role": "approver" }] });
    let prefix = &key[4..16];
    let place = format!("/v1/keys/{prefix}");
    let (status, _) = harness.sends(OWNER, Method::PUT, &format!("{place}/roles"), &roles).await;
    assert_eq!(status, StatusCode::OK);
    let me = harness.asks(Some(&key), Method::GET, "/v1/me").await.1;
    assert_eq!(me["roles"][0]["role"], "approver", "at once");
    harness.asks(Some(OWNER), Method::DELETE, "/v1/users/ann").await;
    assert_eq!(harness.asks(Some(&key), Method::GET, "/v1/me").await.0, 401, "its user has gone");
    harness.asks(Some(OWNER), Method::POST, "/v1/users/ann/enable").await;
    assert_eq!(harness.asks(Some(&key), Method::GET, "/v1/me").await.0, StatusCode::OK);
    let (status, gone) = harness.asks(Some(OWNER), Method::DELETE, &place).await;
    assert!(status == StatusCode::OK && gone["revoked_us"].is_i64(), "{gone}");
    assert_eq!(harness.asks(Some(&key), Method::GET, "/v1/me").await.0, 401);
    let wrong = format!("{}x", harness.key_of("reader").await);
    assert_eq!(harness.asks(Some(&wrong), Method::GET, "/v1/me").await.0, 401);
    let past = harness.key(&json!({ "title": "past", "expires_us": 1 })).await;
    assert_eq!(harness.asks(Some(&past), Method::GET, "/v1/me").await.0, 401);
    for wrong in [
        json!({ "name": "bob", "password": "short" }),
        json!({ "name": "local" }),
        json!({ "name": "bob", "roles": [{ "role": "admin", "ship": "kcs" }] }),
        json!({ "name": "bob", "roles": [{ "role": "reader", "ship": "nobody" }] }),
    ] {
        let (status, problem) = harness.sends(OWNER, Method::POST, "/v1/users", &wrong).await;
        assert_eq!(status, StatusCode::UNPROCESSABLE_ENTITY, "{wrong}: {problem}");
    }
    harness.server.stop().await;
}

/// A version becomes champion by a second person only, if the setting requires one.
async fn promotion_takes_a_second_person(database: TestDatabase) {
    let harness = Harness::guarded(database).await;
    let (ann, bob) = (harness.key_of("engineer").await, harness.key_of("approver").await);
    let own = harness.key(&json!({ "title": "both", "roles": [{ "role": "approver" }] })).await;
    let model = harness.asks(Some(OWNER), Method::GET, "/v1/ships/mariner/model").await.1;
    let body = json!({ "model": model["model"], "origin": "a test" });
    for key in [&ann, &own] {
        let (status, made) =
            harness.sends(key, Method::POST, "/v1/models/mariner/versions", &body).await;
        assert_eq!(status, StatusCode::CREATED, "{made}");
    }
    let promote = async |key: &str, version: i64| {
        let body = json!({ "version": version, "reason": "better" });
        let put = harness.client.put(harness.url("/v1/models/mariner/aliases/champion"));
        read(put.bearer_auth(key).header("if-match", "*").json(&body).send().await.unwrap()).await
    };
    assert_eq!(promote(&ann, 2).await.0, StatusCode::OK, "nobody asks for a second person");
    let on = json!({ "second_person": true });
    assert_eq!(harness.sends(&ann, Method::PUT, "/v1/settings", &on).await.0, 403);
    assert_eq!(harness.sends(OWNER, Method::PUT, "/v1/settings", &on).await.0, StatusCode::OK);
    let (status, problem) = promote(&ann, 1).await;
    assert!(is_refused(status, &problem), "an engineer cannot: {status} {problem}");
    let (status, problem) = promote(&own, 3).await;
    let detail = problem["detail"].as_str().unwrap();
    assert!(status == 403 && detail.contains("a second person"), "{status} {problem}");
    let (status, moved) = promote(&bob, 3).await;
    assert_eq!((status, &moved["version"]), (StatusCode::OK, &json!(3)), "{moved}");
    let versions = harness.asks(Some(&bob), Method::GET, "/v1/models/mariner/versions").await.1;
    let author = format!("key:{}", &own[4..16]);
    assert_eq!(versions["items"][0]["author"], json!(author));
    harness.server.stop().await;
}

/// Queues a refinement of a family with a candidate for each ship, and returns its id.
async fn candidates(harness: &Harness, ships: &[&str]) -> String {
    let store = &harness.server.archive().store;
    let foundation = store.versions().get(ships[0], 1).await.unwrap().head.id;
    store.families().create("tankers", "Tankers", &foundation).await.unwrap();
    let chunk = ships.iter().map(|&ship| ship.to_owned()).collect();
    let bulks = store.bulks();
    let kind = sistership_jobs::fleet::BULK_JOB_KIND;
    let bulk = bulks.create("tankers", "{}", kind, &[chunk], |_, _| "{}".into()).await.unwrap().id;
    let lease = std::time::Duration::from_secs(60);
    let claim = WorkerClaim { worker: "test", lease, alone: true, small: false };
    let JobClaim::Job(job) = store.jobs().claim_next(&claim).await.unwrap() else {
        panic!("the chunk is queued")
    };
    let mut outcomes = Vec::new();
    for &ship in ships {
        let known = store.versions().get(ship, 1).await.unwrap();
        let version = NewVersion {
            model: ship.into(),
            parent: None,
            law: known.head.law,
            method: "statistics".into(),
            document: known.document,
            weights: None,
        };
        outcomes.push(NewOutcome {
            ship: ship.into(),
            outcome: "candidate".into(),
            version: Some((version, Vec::new())),
            worst_change: None,
            document: "{}".into(),
        });
    }
    bulks.commit_chunk(&bulk, (&job.id, job.fence), &outcomes, "{}").await.unwrap();
    bulk
}

/// Candidates of a refinement are promoted all together, or none of them.
async fn a_promotion_that_fails_midway_promotes_nothing(database: TestDatabase) {
    let harness = Harness::guarded(database).await;
    let bulk = candidates(&harness, &["kvlcc2", "mariner"]).await;
    let on = json!({ "second_person": true });
    assert_eq!(harness.sends(OWNER, Method::PUT, "/v1/settings", &on).await.0, StatusCode::OK);
    let roles = |ships: &[&str]| {
        let mut roles = vec![json!({ "role": "engineer", "family": "tankers" })];
        roles.extend(ships.iter().map(|ship| json!({ "role": "approver", "ship": ship })));
        json!({ "title": "approver", "roles": roles })
    };
    let of_one = harness.key(&roles(&["kvlcc2"])).await;
    let of_both = harness.key(&roles(&["kvlcc2", "mariner"])).await;
    let path = format!("/v1/bulk-refinements/{bulk}/champions");
    let word = json!({ "actor": "ann", "reason": "better" });
    let (status, problem) = harness.sends(&of_one, Method::POST, &path, &word).await;
    assert!(is_refused(status, &problem), "no approver of the second: {status} {problem}");
    let champion = async |ship: &str| {
        let path = format!("/v1/models/{ship}/aliases/champion");
        harness.asks(Some(OWNER), Method::GET, &path).await.1["version"].clone()
    };
    assert_eq!((champion("kvlcc2").await, champion("mariner").await), (json!(1), json!(1)));
    let (status, promoted) = harness.sends(&of_both, Method::POST, &path, &word).await;
    assert_eq!((status, &promoted["champions"]), (StatusCode::OK, &json!(2)), "{promoted}");
    assert_eq!((champion("kvlcc2").await, champion("mariner").await), (json!(2), json!(2)));
    harness.server.stop().await;
}

/// Every change is in the audit with its author; a later change of one row is detected.
async fn the_audit_names_who_did_what(database: TestDatabase) {
    let harness = Harness::guarded(database).await;
    let ann = harness.key_of("engineer").await;
    let tag = "/v1/ships/mariner/tags/own";
    assert_eq!(harness.asks(Some(&ann), Method::PUT, tag).await.0, StatusCode::NO_CONTENT);
    let law =
        sistership_model::Zoo::load_embedded().unwrap().law_text("abkowitz").unwrap().to_owned();
    let name = law.lines().find(|line| line.starts_with("name:")).unwrap().to_owned();
    let post = harness.client.post(harness.url("/v1/laws")).bearer_auth(&ann);
    let post = post.header("content-type", "application/yaml").header("idempotency-key", "law");
    let sent = post.body(law.replacen(&name, "name: another-law", 1)).send().await.unwrap();
    assert_eq!(sent.status(), StatusCode::CREATED);
    let actor = format!("key:{}", &ann[4..16]);
    let of = format!("/v1/audit?actor={actor}&limit=1");
    let (status, last) = harness.asks(Some(OWNER), Method::GET, &of).await;
    assert_eq!((status, &last["items"][0]["subject"]), (StatusCode::OK, &json!("law:another-law")));
    assert_eq!(last["items"][0]["origin"], json!("127.0.0.1"), "{last}");
    let next = last["next"].as_str().unwrap();
    let (_, before) = harness.asks(Some(OWNER), Method::GET, &format!("{of}&after={next}")).await;
    assert_eq!(before["items"][0]["action"], json!("ship.tag"));
    assert_eq!(before["items"][0]["after"], json!({ "tag": "own" }));
    let head = harness.asks(Some(OWNER), Method::GET, "/v1/audit/head").await.1;
    assert_eq!(head["sha256"], last["items"][0]["sha256"]);
    let found = sistership_jobs::upkeep::check_archive(harness.server.archive()).await.unwrap();
    assert!(found.clean, "{:?}", found.faults);
    harness
        .database
        .execute_unchecked("UPDATE audit SET actor = 'bob' WHERE action = 'ship.tag'")
        .await;
    let found = sistership_jobs::upkeep::check_archive(harness.server.archive()).await.unwrap();
    assert_eq!(found.faults.len(), 1, "{:?}", found.faults);
    assert_eq!(found.faults[0].check, "audit-chain");
    harness.server.stop().await;
}

on_both_databases!(
    each_route_is_for_the_roles_of_the_table,
    a_role_for_a_ship_goes_no_further,
    keys_and_users_come_and_go,
    promotion_takes_a_second_person,
    a_promotion_that_fails_midway_promotes_nothing,
    the_audit_names_who_did_what,
);
