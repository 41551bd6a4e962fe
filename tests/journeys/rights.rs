//! Users and service keys by the command line, and what a key then opens.

use std::time::Duration;

use reqwest::Method;
use serde_json::Value;
use sistership_store::testing::TestDatabase;
use sistership_tests::binary;
use sistership_tests::server::TestServer;

use super::sea_trials::ship;

/// A command on the server's store, its flags after the sub-command.
fn told(server: &TestServer, words: &[&str], status: i32) -> Value {
    let store = server.store_arguments();
    let store: Vec<&str> = store.iter().map(String::as_str).collect();
    binary::json(&[words, &store, &["--json"]].concat(), status)
}

async fn status(server: &TestServer, method: Method, key: &str) -> u16 {
    let request = server
        .request(method, "/v1/ships")
        .header("authorization", format!("Bearer {key}"))
        .header("content-type", "application/yaml")
        .body(ship());
    request.send().await.expect("an answer").status().as_u16()
}

async fn a_key_opens_what_its_role_may(database: TestDatabase) {
    let server = TestServer::on(database, &["--accounts"]).await;
    let added = told(&server, &["users", "add", "ann", "--role", "engineer"], 0);
    assert!(added["password"].as_str().is_some_and(|drawn| drawn.len() > 20), "{added}");
    let listed = told(&server, &["users", "list"], 0);
    assert_eq!(listed["users"][0]["roles"][0], "engineer", "{listed}");
    let key = |title: &str, role: &str| {
        let made = told(&server, &["keys", "add", title, "--role", role], 0);
        let text = |name: &str| made[name].as_str().expect("text").to_owned();
        (text("key"), text("prefix"))
    };
    let (reads, prefix) = key("reads", "reader");
    let (writes, _) = key("writes", "engineer");
    assert_eq!(status(&server, Method::GET, "sis_000000000000_none").await, 401);
    assert_eq!(status(&server, Method::GET, &reads).await, 200);
    assert_eq!(status(&server, Method::POST, &reads).await, 403);
    assert_eq!(status(&server, Method::POST, &writes).await, 201);
    told(&server, &["keys", "revoke", &prefix], 0);
    // What was looked up is known for a second.
    tokio::time::sleep(Duration::from_millis(1500)).await;
    assert_eq!(status(&server, Method::GET, &reads).await, 401);
    let checked = told(&server, &["fsck"], 0);
    assert!(checked["checked"]["audit"].as_i64() >= Some(5), "{checked}");
}

#[tokio::test(flavor = "multi_thread")]
async fn a_key_on_sqlite() {
    a_key_opens_what_its_role_may(TestDatabase::new_sqlite()).await;
}

#[tokio::test(flavor = "multi_thread")]
async fn a_key_on_postgres() {
    if let Some(database) = TestDatabase::new_postgres().await {
        a_key_opens_what_its_role_may(database).await;
    }
}
