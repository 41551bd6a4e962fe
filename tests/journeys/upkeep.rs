//! `fsck` and `gc` on the store of a server that runs.

use sistership_tests::binary;
use sistership_tests::server::TestServer;

use super::over_http::{create, upload};

/// The exit status and the output of a command on the server's store.
fn on(server: &TestServer, arguments: &[&str], status: i32) -> serde_json::Value {
    let store = server.store_arguments();
    let all: Vec<&str> = arguments
        .iter()
        .copied()
        .chain(["--json"])
        .chain(store.iter().map(String::as_str))
        .collect();
    binary::json(&all, status)
}

async fn kept_up(server: TestServer) {
    create(&server).await;
    let uploaded = upload(&server).await;
    let findings = on(&server, &["fsck"], 0);
    assert_eq!(
        (findings["clean"].as_bool(), findings["checked"]["trials"].as_u64()),
        (Some(true), Some(4)),
        "{findings}"
    );
    let objects = server.database().folder.path().join("data/objects");
    let orphan = "ab".repeat(32);
    std::fs::create_dir_all(objects.join("ab")).expect("a folder");
    std::fs::write(objects.join("ab").join(&orphan[2..]), b"not its bytes").expect("an object");
    let findings = on(&server, &["fsck"], 1);
    assert_eq!(findings["faults"][0]["check"], "object-hash", "{findings}");
    assert_eq!(on(&server, &["gc"], 0)["removed"].as_array().map(Vec::len), Some(0), "it is young");
    assert_eq!(
        on(&server, &["gc", "--grace-h", "0", "--dry-run"], 0)["removed"][0],
        orphan.as_str()
    );
    assert_eq!(on(&server, &["gc", "--grace-h", "0"], 0)["removed"][0], orphan.as_str());
    assert_eq!(on(&server, &["fsck"], 0)["unreferred"]["objects"], 0);
    let key = uploaded["trials"][0]["sha256"].as_str().expect("a hash");
    std::fs::remove_file(objects.join(&key[..2]).join(&key[2..])).expect("the samples of a trial");
    let findings = on(&server, &["fsck"], 1);
    assert_eq!(findings["faults"][0]["check"], "trial-object", "{findings}");
    let store = server.store_arguments();
    let told = binary::run(&["fsck", store[0].as_str(), &store[1], &store[2], &store[3]]);
    assert!(String::from_utf8_lossy(&told.stdout).contains("1 fault"), "{told:?}");
}

#[tokio::test]
async fn upkeep_on_sqlite() {
    kept_up(TestServer::sqlite().await).await;
}

#[tokio::test]
async fn upkeep_on_postgres() {
    if let Some(server) = TestServer::postgres().await {
        kept_up(server).await;
    }
}
