//! The Python client's own tests, against a server.

use std::path::Path;
use std::process::Command;

use sistership_tests::binary;
use sistership_tests::server::TestServer;

use super::sea_trials::{csv, ship, trials};

#[tokio::test(flavor = "multi_thread")]
async fn python_client() {
    let there = Command::new("python3")
        .args(["-c", "import sys; sys.exit(sys.version_info < (3, 9))"])
        .status();
    if !there.is_ok_and(|status| status.success()) {
        eprintln!("skipped: no python3 of version 3.9 or later");
        return;
    }
    let server = TestServer::sqlite().await;
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::write(folder.path().join("ship.yaml"), ship()).expect("written");
    for (number, trial) in trials()[..2].iter().enumerate() {
        let file = folder.path().join(format!("{number}.csv"));
        std::fs::write(file, csv(trial)).expect("written");
    }
    let client = Path::new(env!("CARGO_MANIFEST_DIR")).join("../clients/python");
    let mut tests = Command::new("python3");
    tests
        .args(["-B", "-m", "unittest", "discover", "-s", "tests"])
        .current_dir(&client)
        .env("PYTHONPATH", client.join("src"))
        .env("SISTERSHIP_URL", server.url())
        .env("SISTERSHIP_PROGRAM", binary::path())
        .env("SISTERSHIP_SHIP", folder.path().join("ship.yaml"))
        .env("SISTERSHIP_TRIALS", folder.path());
    let output = tokio::task::spawn_blocking(move || tests.output()).await.expect("an end");
    let output = output.expect("python3 runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}
