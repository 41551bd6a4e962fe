//! Identifiers of objects of another ship, in every place where a request can name one.

use reqwest::{Method, StatusCode};
use serde_json::{Value, json};
use sistership_store::testing::TestDatabase;
use sistership_store::{NewJob, NewReport};

use super::access::{OWNER, is_refused};
use super::harness::{Harness, read};
use crate::rights::{ROLE_TABLE, RoleScope};

/// The ship on which the caller has no role, and its family.
const SHIP: &str = "kcs";
const FAMILY: &str = "hidden-family";
/// Part of every text of the foreign objects.
const MARK: &str = "own-mark-7";

/// Objects of the foreign ship.
struct ForeignObjects {
    trial: String,
    job: String,
    report: String,
    bulk: String,
    session: String,
}

impl ForeignObjects {
    async fn create(harness: &Harness) -> Self {
        let archive = harness.server.archive();
        let store = &archive.store;
        let request = format!(r#"{{"note":"{MARK}"}}"#);
        let job = NewJob {
            kind: "refinement".into(),
            ship: Some(SHIP.into()),
            request: request.clone(),
            small: true,
        };
        let report = NewReport {
            version_id: None,
            ship: SHIP.into(),
            kind: "refinement".into(),
            document: request,
            html: MARK.into(),
        };
        let foundation = store.versions().get(SHIP, 1).await.unwrap().head.id;
        store.families().create(FAMILY, MARK, &foundation).await.unwrap();
        let chunk = [vec![SHIP.to_owned()]];
        let bulks = store.bulks();
        let bulk = bulks.create(FAMILY, "{}", "bulk-refinement", &chunk, |_, _| "{}".into()).await;
        let open = json!({ "model": SHIP });
        let (status, session) = harness.sends(OWNER, Method::POST, "/v1/sessions", &open).await;
        assert_eq!(status, StatusCode::CREATED, "{session}");
        Self {
            trial: upload_trial(harness).await,
            job: store.jobs().enqueue(&job).await.unwrap().id,
            report: store.reports().insert(&report).await.unwrap().id,
            bulk: bulk.unwrap().id,
            session: session["id"].as_str().unwrap().to_owned(),
        }
    }

    /// Returns a path with the identifiers of these objects.
    fn fill(&self, path: &str, of: RoleScope) -> String {
        let id = match of {
            RoleScope::Job => &self.job,
            RoleScope::Report => &self.report,
            RoleScope::Bulk => &self.bulk,
            RoleScope::Body => &self.session,
            _ => &self.trial,
        };
        let parts = path.split('/').map(|part| match part {
            "{ship}" | "{model}" => SHIP,
            "{family}" => FAMILY,
            "{number}" => "1",
            "{alias}" => "champion",
            "{tag}" => "own",
            "{id}" | "{draft}" => id,
            part => part,
        });
        parts.collect::<Vec<_>>().join("/")
    }

    /// Requests that name these objects in a query or a body, for each route whose scope is there.
    fn named_elsewhere(&self) -> Vec<(&'static str, &'static str, String, Value)> {
        let own = "mariner";
        let turn = json!({ "turn_deg": 20 });
        vec![
            ("POST", "/v1/trials", format!("?ship={SHIP}"), Value::Null),
            ("POST", "/v1/refinements", String::new(), json!({ "ship": SHIP })),
            (
                "POST",
                "/v1/refinements",
                String::new(),
                json!({ "ship": own, "trials": [self.trial] }),
            ),
            (
                "POST",
                "/v1/refinements",
                String::new(),
                json!({ "ship": own, "source": format!("{SHIP}/1") }),
            ),
            ("POST", "/v1/diagnoses", String::new(), json!({ "model": SHIP })),
            (
                "POST",
                "/v1/diagnoses",
                String::new(),
                json!({ "model": own, "trials": [self.trial] }),
            ),
            ("POST", "/v1/branches", String::new(), json!({ "model": SHIP })),
            (
                "POST",
                "/v1/branches",
                String::new(),
                json!({ "model": own, "trials": [self.trial] }),
            ),
            (
                "POST",
                "/v1/predictions",
                String::new(),
                json!({ "model": format!("{SHIP}/champion"), "manoeuvre": turn }),
            ),
            ("POST", "/v1/sessions", String::new(), json!({ "model": SHIP })),
            ("GET", "/v1/compare", format!("?version={own}&version={SHIP}"), Value::Null),
            (
                "GET",
                "/v1/compare",
                format!("?version={own}&version={own}/1&trial={}", self.trial),
                Value::Null,
            ),
        ]
    }
}

impl Harness {
    /// Uploads a trial with a key.
    async fn sends_csv(&self, key: &str, place: &str) -> (StatusCode, Value) {
        let csv = "t_s,u_m_s,v_m_s,r_rad_s,delta_rad\n0,8,0,0,0\n1,8,0,0,0\n2,8,0,0,0\n3,8,0,0,0\n";
        let post = self.client.post(self.url(place)).bearer_auth(key);
        read(post.header("content-type", "text/csv").body(csv).send().await.unwrap()).await
    }
}

async fn upload_trial(harness: &Harness) -> String {
    let path = format!("/v1/trials?ship={SHIP}&name={MARK}.csv&diagnose=false");
    let (status, uploaded) = harness.sends_csv(OWNER, &path).await;
    assert_eq!(status, StatusCode::CREATED, "{uploaded}");
    uploaded["trials"][0]["id"].as_str().unwrap().to_owned()
}

/// Returns true if an answer says nothing of the foreign objects, and did nothing to them.
fn is_closed(status: StatusCode, answer: &Value) -> bool {
    let unknown = [StatusCode::NOT_FOUND, StatusCode::UNPROCESSABLE_ENTITY].contains(&status);
    (unknown || is_refused(status, answer)) && !answer.to_string().contains(MARK)
}

async fn no_route_leads_to_objects_of_another_ship(database: TestDatabase) {
    let harness = Harness::guarded(database).await;
    let objects = ForeignObjects::create(&harness).await;
    let roles = json!([{ "role": "approver", "ship": "mariner" }]);
    let key = harness.key(&json!({ "title": "own", "roles": roles })).await;
    let named = objects.named_elsewhere();
    let mut faults = Vec::new();
    for (method, path, _, of) in ROLE_TABLE {
        let asked: Method = method.parse().unwrap();
        let place = objects.fill(path, *of);
        let has_object = place != *path && !place.contains('{');
        match of {
            RoleScope::Anything => {
                let (_, answer) = harness.asks(Some(&key), asked, &place).await;
                if answer.to_string().contains(MARK) {
                    faults.push(format!("{method} {path}: {answer}"));
                }
                continue;
            }
            RoleScope::Body if !has_object => {
                if !named.iter().any(|(known, at, ..)| known == method && at == path) {
                    faults.push(format!("{method} {path}: `named_elsewhere` lacks a request"));
                }
                continue;
            }
            _ => {}
        }
        let query = match of {
            RoleScope::ShipOfQuery => format!("?ship={SHIP}"),
            RoleScope::FamilyOfQuery => format!("?family={FAMILY}"),
            _ => String::new(),
        };
        let at = format!("{place}{query}");
        // Steps of a simulation are refused without a document, whatever the session.
        let (status, answer) = match place.ends_with("/steps") {
            true => harness.sends(&key, asked, &at, &json!({ "duration_s": 1.0 })).await,
            false => harness.asks(Some(&key), asked, &at).await,
        };
        if !is_closed(status, &answer) {
            faults.push(format!("{method} {place}{query}: {status} {answer}"));
        }
    }
    for (method, path, query, body) in &named {
        let place = format!("{path}{query}");
        let (status, answer) = match *path {
            "/v1/trials" => harness.sends_csv(&key, &place).await,
            _ => harness.sends(&key, method.parse().unwrap(), &place, body).await,
        };
        if !is_closed(status, &answer) {
            faults.push(format!("{method} {place} {body}: {status} {answer}"));
        }
    }
    assert!(faults.is_empty(), "{} faults:\n{}", faults.len(), faults.join("\n"));
    for path in ["trials", "jobs", "reports", "bulk-refinements", "sessions"] {
        let id = match path {
            "trials" => &objects.trial,
            "jobs" => &objects.job,
            "reports" => &objects.report,
            "bulk-refinements" => &objects.bulk,
            _ => &objects.session,
        };
        let (status, answer) =
            harness.asks(Some(OWNER), Method::GET, &format!("/v1/{path}/{id}")).await;
        assert_eq!(status, StatusCode::OK, "{path}: {answer}");
    }
    harness.server.stop().await;
}

on_both_databases!(no_route_leads_to_objects_of_another_ship);
