//! The Python client as people get it: its wheel, the README's lines, and the tour that is its
//! documentation.

use std::path::{Path, PathBuf};
use std::process::Command;

use sistership_tests::server::TestServer;
use tempfile::TempDir;

use super::sea_trials::{csv, few, ship};

/// The wheel alone in an empty environment runs the README's five lines.
#[tokio::test(flavor = "multi_thread")]
async fn python_wheel() {
    let server = TestServer::sqlite().await;
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::write(folder.path().join("my-ship.yaml"), ship()).expect("written");
    std::fs::write(folder.path().join("zigzag.csv"), csv(&few()[1])).expect("written");
    installed("lines", &server, folder).await;
}

/// The tour is executed, and its figures are what it says.
#[tokio::test(flavor = "multi_thread")]
async fn python_tour() {
    let server = TestServer::sqlite().await;
    installed("tour", &server, tempfile::tempdir().expect("a temporary folder")).await;
}

/// Runs `clients/python/tests/installed.py` in a folder and shows what it says.
async fn installed(what: &'static str, server: &TestServer, folder: TempDir) {
    let script = script();
    let mut command = Command::new("python3");
    command
        .args([Path::new("-B"), &script, Path::new(what)])
        .current_dir(folder.path())
        .env_remove("PYTHONPATH")
        .env("SISTERSHIP_URL", server.url());
    let output = tokio::task::spawn_blocking(move || command.output()).await.expect("an end");
    let Ok(output) = output else {
        assert!(!required(), "there is no python3, and SISTERSHIP_REQUIRE_PIP=1");
        eprintln!("skipped: no python3");
        return;
    };
    eprint!("{}", String::from_utf8_lossy(&output.stdout));
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

fn required() -> bool {
    std::env::var("SISTERSHIP_REQUIRE_PIP").is_ok_and(|value| value == "1")
}

fn script() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../clients/python/tests/installed.py")
}
