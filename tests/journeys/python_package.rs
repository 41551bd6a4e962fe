//! The Python package as people get it: the README's lines in an environment that holds nothing
//! else, and the tour that is its documentation.

use std::path::{Path, PathBuf};
use std::process::Command;

use sistership_tests::binary;
use sistership_tests::server::TestServer;

use super::sea_trials::{csv, few, ship};

/// The package alone in an empty environment runs the README's lines with a server.
#[tokio::test(flavor = "multi_thread")]
async fn python_with_a_server() {
    let folder = ship_and_trial();
    let server = TestServer::sqlite().await;
    installed("served", folder.path(), Some(&server)).await;
}

/// The same without a server: the program does the work.
#[tokio::test(flavor = "multi_thread")]
async fn python_without_a_server() {
    installed("local", ship_and_trial().path(), None).await;
}

/// A folder with the files that the README's lines name.
fn ship_and_trial() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::write(folder.path().join("my-ship.yaml"), ship()).expect("written");
    std::fs::write(folder.path().join("zigzag.csv"), csv(&few()[1])).expect("written");
    folder
}

/// The tour is executed, and its figures are what it says.
#[tokio::test(flavor = "multi_thread")]
async fn python_tour() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    if installed("ready", folder.path(), None).await.starts_with("skipped") {
        return;
    }
    let server = TestServer::sqlite().await;
    installed("tour", folder.path(), Some(&server)).await;
}

/// Runs `clients/python/tests/installed.py` in a folder; shows and gives what it says.
async fn installed(what: &str, folder: &Path, server: Option<&TestServer>) -> String {
    let mut command = Command::new("python3");
    command
        .args([Path::new("-B"), &script(), Path::new(what)])
        .current_dir(folder)
        .env_remove("PYTHONPATH")
        .env("SISTERSHIP_PROGRAM", binary::path())
        .env("SISTERSHIP_URL", server.map_or("", TestServer::url));
    let output = tokio::task::spawn_blocking(move || command.output()).await.expect("an end");
    let Ok(output) = output else {
        assert!(!required(), "there is no python3, and SISTERSHIP_REQUIRE_PIP=1");
        eprintln!("skipped: no python3");
        return "skipped".to_owned();
    };
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    eprint!("{said}");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    said
}

fn required() -> bool {
    std::env::var("SISTERSHIP_REQUIRE_PIP").is_ok_and(|value| value == "1")
}

fn script() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../clients/python/tests/installed.py")
}
