//! Refusals: every one is a problem that names its cause.

use reqwest::multipart::{Form, Part};
use reqwest::{Method, RequestBuilder, StatusCode};
use sistership_store::testing::TestDatabase;

use super::harness::{Harness, config, read};
use crate::Server;

/// A request, and the status and words of its problem.
struct Case(RequestBuilder, u16, &'static str);

fn cases(harness: &Harness) -> Vec<Case> {
    let ask = |method: Method, path: &str| harness.client.request(method, harness.url(path));
    let post = |path: &str, media: &'static str, body: &'static str| {
        ask(Method::POST, path).header("content-type", media).body(body)
    };
    let json = |path: &str, body: &'static str| post(path, "application/json", body);
    vec![
        Case(ask(Method::GET, "/v1/nothing"), 404, "/openapi.json"),
        Case(ask(Method::PATCH, "/v1/ships"), 405, "Allow"),
        Case(ask(Method::GET, "/v1/ships?limit=x"), 400, "limit"),
        Case(ask(Method::GET, "/v1/ships?limt=3"), 400, "limt: is not a parameter"),
        Case(
            ask(Method::GET, "/v1/ships?particular=length_m:1..2"),
            400,
            "there is no particular `length_m`",
        ),
        Case(
            ask(Method::GET, "/v1/ships?similar_to=atlantis"),
            422,
            "similar_to: there is no ship `atlantis`",
        ),
        Case(ask(Method::GET, "/v1/jobs?limt=3"), 400, "limt: is not a parameter"),
        Case(ask(Method::GET, "/v1/jobs?after=mariner"), 400, "after: is not the value `next`"),
        Case(
            ask(Method::PUT, "/v1/ships/mariner/tags/two%20words"),
            404,
            "tag: there is no `two words`",
        ),
        Case(ask(Method::GET, "/v1/ships/atlantis"), 404, "no ship `atlantis`"),
        Case(ask(Method::GET, "/v1/models/mariner/versions/one"), 404, "one"),
        Case(
            ask(Method::GET, "/v1/ships/mariner/model").header("accept", "image/png"),
            406,
            "application/yaml",
        ),
        Case(json("/v1/refinements", r#"{"ship":"#), 400, "EOF"),
        Case(
            json("/v1/refinements", r#"{"ship":"mariner","settings":{"fold":3}}"#),
            422,
            "settings.fold: unknown field",
        ),
        Case(
            json("/v1/refinements", r#"{"ship":"mariner","settings":{"folds":1}}"#),
            422,
            "from 2 to 100",
        ),
        Case(
            json("/v1/refinements", r#"{"ship":"mariner","settings":{"cma_es":{"wall_s":9}}}"#),
            422,
            "limit `evaluations`",
        ),
        Case(json("/v1/refinements", r#"{"ship":"mariner"}"#), 422, "POST /v1/trials"),
        Case(json("/v1/refinements", r#"{"ship":"mariner","trials":["x"]}"#), 422, "trials[0]"),
        Case(post("/v1/refinements", "text/csv", "a"), 415, "application/json"),
        Case(
            json("/v1/predictions", r#"{"model":"mariner/99","manoeuvre":{"turn_deg":35}}"#),
            422,
            "no model `mariner/99`",
        ),
        Case(post("/v1/laws", "application/yaml", "kind: law\nname: x"), 422, "body"),
        Case(
            post("/v1/trials?ship=atlantis", "text/csv", "t_s,u_m_s\n0,1\n1,1\n2,1\n"),
            422,
            "POST /v1/ships",
        ),
        Case(
            post("/v1/trials?ship=mariner&name=a.csv", "text/csv", "t_s,u_m_s\n0,1\n1,x\n"),
            422,
            "a.csv",
        ),
        Case(post("/v1/trials", "application/json", "{}"), 415, "multipart/form-data"),
        Case(
            post("/v1/trials?ship=mariner", "text/csv", "a").header("content-encoding", "gzip"),
            415,
            "Content-Encoding",
        ),
        Case(json("/v1/ships", "{}").body(vec![b' '; 5 << 20]), 413, "larger"),
        Case(ask(Method::GET, "/v1/ships").header("host", "evil.example"), 403, "localhost"),
        Case(json("/v1/ships", "{}").header("origin", "http://evil.example"), 403, "evil.example"),
        Case(
            ask(Method::PUT, "/v1/models/mariner/aliases/champion").json(&alias()),
            428,
            "If-Match",
        ),
        Case(
            ask(Method::PUT, "/v1/models/mariner/aliases/latest").json(&alias()),
            422,
            "reserved for the server",
        ),
        Case(json("/v1/ships", "{}").header("idempotency-key", "a b"), 400, "Idempotency-Key"),
    ]
}

fn alias() -> serde_json::Value {
    serde_json::json!({ "version": 1, "reason": "a test" })
}

#[tokio::test]
async fn every_error_is_a_problem_that_helps() {
    let harness = Harness::on(TestDatabase::new_sqlite()).await;
    for Case(request, status, words) in cases(&harness) {
        let shown = format!("{request:?}");
        let response = request.send().await.unwrap();
        let media = response.headers()["content-type"].clone();
        let (found, problem) = read(response).await;
        assert_eq!(
            (found.as_u16(), media.to_str().unwrap()),
            (status, "application/problem+json"),
            "{shown}: {problem}"
        );
        assert!(problem["detail"].as_str().unwrap().contains(words), "{shown}: {problem}");
        assert!(
            problem["instance"].as_str().unwrap().starts_with("urn:uuid:")
                && problem["errors"].is_array()
        );
        assert_eq!(problem["status"], status);
    }
    assert!(harness.get("/v1/trials?ship=mariner").await["items"].as_array().unwrap().is_empty());
    harness.server.stop().await;
}

#[tokio::test]
async fn uploads_are_bounded_and_their_parts_named() {
    let database = TestDatabase::new_sqlite();
    let mut config = config(&database);
    config.limits.upload_bytes = 1 << 20;
    config.api_key = Some("sesame".into());
    let harness = Harness {
        server: Server::start(config).await.unwrap(),
        client: reqwest::Client::new(),
        database,
    };
    let upload = |form: Form| {
        harness.client.post(harness.url("/v1/trials")).bearer_auth("sesame").multipart(form)
    };
    let big = || Part::bytes(vec![b'1'; 2 << 20]).file_name("big.csv");
    assert_eq!(
        upload(Form::new().part("file", big())).send().await.unwrap().status(),
        StatusCode::PAYLOAD_TOO_LARGE
    );
    let raw = harness
        .client
        .post(harness.url("/v1/trials?ship=mariner"))
        .bearer_auth("sesame")
        .header("content-type", "text/csv");
    assert_eq!(
        raw.body(vec![b'1'; 2 << 20]).send().await.unwrap().status(),
        StatusCode::PAYLOAD_TOO_LARGE
    );
    let manifest = "kind: trials\nship: mariner\ntrials: [{ file: a/b.csv }]\n";
    let (status, problem) =
        read(upload(Form::new().text("manifest", manifest)).send().await.unwrap()).await;
    assert_eq!((status.as_u16(), &problem["errors"][0]["field"]), (422, &"trials[0].file".into()));
    let (_, problem) = read(upload(Form::new().text("cargo", "grain")).send().await.unwrap()).await;
    assert!(problem["detail"].as_str().unwrap().contains("cargo"));
    assert_eq!(
        harness.client.get(harness.url("/")).send().await.unwrap().status(),
        StatusCode::UNAUTHORIZED
    );
    let uploads = std::fs::read_dir(harness.database.folder.path().join("data/uploads")).unwrap();
    let left = uploads.map(|process| std::fs::read_dir(process.unwrap().path()).unwrap().count());
    assert_eq!(left.sum::<usize>(), 0);
    harness.server.stop().await;
}
