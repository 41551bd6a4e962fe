//! The server checks what its document says: each parameter and field of each operation is sent
//! with values on both sides of every limit that the document has.

mod bodies;
mod values;

use reqwest::{Method, RequestBuilder};
use serde_json::{Map, Value, json};
use sistership_store::testing::TestDatabase;

use super::harness::{Harness, read};
use values::{fitting, unfit};

/// Texts of refusals that concern no limit of a field.
const RULES: [&str; 8] = [
    "there is no",
    "has no trials",
    "has no prior yet",
    "the name of a ship cannot be changed",
    "give either",
    "versions cannot be compared; give",
    "is beyond the rudder's limit",
    "has no posterior to draw from",
];

/// One operation of the document.
struct Operation {
    method: Method,
    path: String,
    about: Value,
}

/// Errors found; all of them are reported together.
type Faults = Vec<String>;

impl Operation {
    fn all(document: &Value) -> Vec<Self> {
        let mut all = Vec::new();
        for (path, item) in document["paths"].as_object().unwrap() {
            for (method, about) in item.as_object().unwrap() {
                let method = method.to_uppercase().parse().unwrap();
                all.push(Self { method, path: path.clone(), about: about.clone() });
            }
        }
        all
    }

    fn parameters(&self, place: &str) -> impl Iterator<Item = &Map<String, Value>> {
        let all = self.about["parameters"].as_array().map(Vec::as_slice).unwrap_or_default();
        all.iter().filter(move |known| known["in"] == place).map(|known| known.as_object().unwrap())
    }

    fn media(&self) -> Vec<&str> {
        let content = self.about["requestBody"]["content"].as_object();
        content.map(|content| content.keys().map(String::as_str).collect()).unwrap_or_default()
    }

    /// Returns a request that is valid in path, query and headers; `changed` replaces a parameter
    /// of the path.
    fn request(
        &self,
        harness: &Harness,
        changed: Option<(&str, &str)>,
        query: &[(&str, String)],
    ) -> RequestBuilder {
        let mut url = reqwest::Url::parse(&harness.server.url()).unwrap();
        for segment in self.path.split('/').skip(1) {
            let name = segment.strip_prefix('{').map(|name| name.trim_end_matches('}'));
            let value = match (name, changed) {
                (Some(name), Some((changed, value))) if name == changed => value,
                (Some(name), _) => usual(name),
                (None, _) => segment,
            };
            url.path_segments_mut().unwrap().push(value);
        }
        let ship = self.parameters("query").any(|known| known["name"] == "ship")
            && !query.iter().any(|(name, _)| *name == "ship");
        if ship {
            url.query_pairs_mut().append_pair("ship", "mariner");
        }
        for (name, value) in query {
            url.query_pairs_mut().append_pair(name, value);
        }
        let mut request = harness.client.request(self.method.clone(), url);
        if self.media().contains(&"text/csv") {
            request = request.header("content-type", "text/csv").body("t_s,u_m_s\n0,1\n1,x\n");
        }
        request
    }

    /// Sends a value that must be refused with one of these statuses, because of `field`.
    async fn refused(
        &self,
        request: RequestBuilder,
        allowed: &[u16],
        field: &str,
        faults: &mut Faults,
    ) {
        let shown = format!("{request:?}");
        let response = request.send().await.unwrap();
        let media = response
            .headers()
            .get("content-type")
            .map(|media| media.to_str().unwrap().to_owned())
            .unwrap_or_default();
        let (status, problem) = read(response).await;
        let named = |text: &Value| {
            text.as_str().is_some_and(|text| text.to_lowercase().contains(&field.to_lowercase()))
        };
        let placed = problem["errors"]
            .as_array()
            .is_some_and(|errors| errors.iter().any(|error| named(&error["field"])));
        let documented = self.about["responses"].get(status.as_str()).is_some();
        let right = allowed.contains(&status.as_u16()) && media == "application/problem+json";
        if !(right && documented && (placed || named(&problem["detail"]))) {
            let place = format!("{} {}: `{field}`", self.method, self.path);
            let short: String = shown.chars().take(300).collect();
            faults.push(format!(
                "{place} should be refused as {allowed:?} (documented: {documented}): {status} \
                 {problem}\n    {short}"
            ));
        }
    }

    /// Sends a value that must not be refused because of `field`.
    async fn taken(&self, request: RequestBuilder, field: &str, faults: &mut Faults) {
        let shown = format!("{request:?}");
        let (status, problem) = read(request.send().await.unwrap()).await;
        let mut errors = problem["errors"].as_array().into_iter().flatten();
        let blamed = status.is_client_error() && errors.any(|error| error["field"] == field);
        // The objects that are named need not exist, two fields may have a rule between them, and a
        // model may know less than the document allows.
        let detail = problem["detail"].as_str().unwrap_or_default();
        let missing = RULES.iter().any(|words| detail.contains(words));
        if (blamed && !missing) || status.is_server_error() {
            let short: String = shown.chars().take(300).collect();
            faults.push(format!(
                "{} {}: `{field}` should be taken: {status} {problem}\n    {short}",
                self.method, self.path
            ));
        }
    }

    async fn path(&self, harness: &Harness, faults: &mut Faults) {
        for known in self.parameters("path") {
            let name = known["name"].as_str().unwrap();
            for wrong in unfit(&known["schema"])
                .into_iter()
                .filter(|wrong| !wrong.is_empty() && !wrong.contains('/'))
            {
                self.refused(
                    self.request(harness, Some((name, &wrong)), &[]),
                    &[404],
                    name,
                    faults,
                )
                .await;
            }
        }
    }

    async fn query(&self, harness: &Harness, faults: &mut Faults) {
        for known in self.parameters("query") {
            let name = known["name"].as_str().unwrap();
            for wrong in unfit(&known["schema"]) {
                self.refused(self.request(harness, None, &[(name, wrong)]), &[400], name, faults)
                    .await;
            }
            let most = known["schema"]["maxItems"].as_u64().unwrap_or(1);
            for right in fitting(&known["schema"]) {
                self.taken(self.request(harness, None, &[(name, right.clone())]), name, faults)
                    .await;
                let many: Vec<_> = (0..=most).map(|_| (name, right.clone())).collect();
                self.refused(self.request(harness, None, &many), &[400], name, faults).await;
            }
            if known["required"] == true {
                let request = harness.client.request(self.method.clone(), harness.url(&self.path));
                self.refused(request, &[400], name, faults).await;
            }
        }
        if self.path.starts_with("/v1") {
            let unknown = self.request(harness, None, &[("nonsense", "1".into())]);
            self.refused(unknown, &[400], "nonsense", faults).await;
        }
    }

    async fn headers(&self, harness: &Harness, faults: &mut Faults) {
        for known in self.parameters("header") {
            let name = known["name"].as_str().unwrap();
            let sendable = |value: &String| reqwest::header::HeaderValue::from_str(value).is_ok();
            for wrong in unfit(&known["schema"]).into_iter().filter(sendable) {
                self.refused(
                    self.request(harness, None, &[]).header(name, wrong),
                    &[400],
                    name,
                    faults,
                )
                .await;
            }
            // Later operations need the ship.
            for right in
                fitting(&known["schema"]).into_iter().filter(|_| self.method != Method::DELETE)
            {
                self.taken(self.request(harness, None, &[]).header(name, right), name, faults)
                    .await;
            }
            if known["required"] == true {
                self.refused(self.request(harness, None, &[]), &[400, 428], name, faults).await;
            }
        }
    }

    /// Sends bodies that are none, or of another kind.
    async fn bodies(&self, harness: &Harness, faults: &mut Faults) {
        let media = self.media();
        let fresh = || self.request(harness, None, &[]).header("if-match", "*");
        if media.is_empty() {
            return;
        }
        if !media.contains(&"text/csv") {
            self.refused(fresh(), &[415], media[0], faults).await;
            self.refused(
                fresh().header("content-type", "image/png").body("x"),
                &[415],
                media[0],
                faults,
            )
            .await;
        }
        if media.contains(&"application/json") {
            for broken in ["", "{", "{} {}"] {
                let request = fresh().header("content-type", "application/json").body(broken);
                self.refused(request, &[400, 422], "", faults).await;
            }
        }
    }
}

/// Returns the value of a parameter of the path.
fn usual(name: &str) -> &'static str {
    match name {
        "ship" | "model" => "mariner",
        "law" => "abkowitz",
        "number" => "1",
        "alias" => "mine",
        "family" => "walked",
        "tag" => "walked",
        "user" => "nobody",
        "prefix" => "000000000000",
        _ => "00000000-0000-0000-0000-000000000000",
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn every_limit_of_the_document_is_one_of_the_server() {
    let harness = Harness::on(TestDatabase::new_sqlite()).await;
    let family = json!({ "name": "walked", "foundation": "mariner/1", "members": ["mariner"] });
    assert_eq!(harness.post("/v1/families", &family).await.0, 201);
    let document = crate::openapi();
    let mut faults = Faults::new();
    for operation in Operation::all(&document) {
        operation.path(&harness, &mut faults).await;
        operation.query(&harness, &mut faults).await;
        operation.headers(&harness, &mut faults).await;
        operation.bodies(&harness, &mut faults).await;
        bodies::walk(&operation, &harness, &document, &mut faults).await;
    }
    assert!(faults.is_empty(), "{} faults:\n{}", faults.len(), faults.join("\n"));
    harness.server.stop().await;
}
