//! A model into other tools, and models side by side: on files, and over HTTP.

use sistership_tests::binary;
use sistership_tests::server::TestServer;

use super::over_http::{create, upload};
use super::sea_trials::{NAME, csv, trials};

/// A folder with one trial of SR108.
fn folder() -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let trial = &trials()[0];
    let path = folder.path().join("trial.csv");
    std::fs::write(&path, csv(trial)).expect("written");
    (folder, path.display().to_string())
}

#[test]
fn a_model_is_written_down_for_other_tools() {
    let (folder, _) = folder();
    let path = |name: &str| folder.path().join(name).display().to_string();
    let begins = [("c", "/*"), ("python", "# Model"), ("matlab", "function")];
    let archives = ["fmu2", "fmu3", "ssp"].map(|format| (format, "PK"));
    for (format, begins) in begins.into_iter().chain(archives) {
        let out = path(format);
        let done = binary::run(&["export", "sr108", "--format", format, "--out", &out]);
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        let bytes = std::fs::read(&out).expect("a file");
        assert!(bytes.starts_with(begins.as_bytes()), "{format}");
    }
    let refused = |arguments: &[&str], status: i32, words: &str| {
        let done = binary::run(arguments);
        let error = String::from_utf8_lossy(&done.stderr).into_owned();
        assert!(done.status.code() == Some(status) && error.contains(words), "{error}");
    };
    let out = path("lost");
    refused(&["export", "sr108", "--format", "fortran", "--out", &out], 2, "`matlab`");
    refused(&["export", "sr18", "--format", "c", "--out", &out], 1, "did you mean `sr108`?");
    assert!(!std::path::Path::new(&out).exists(), "nothing is left of what was refused");
}

#[test]
fn models_stand_side_by_side_on_files() {
    let (_folder, trial) = folder();
    let found = binary::json(&["compare", "sr108", "kcs", "--trials", &trial, "--json"], 0);
    let error = |place: usize| found["trials"][0]["errors"][place]["standardised_mse"].as_f64();
    let own = error(0).expect("an error");
    assert!(error(1).is_none_or(|other| other > own), "SR108 made the trial: {found}");
    assert_eq!(found["models"][0]["standardised_mse"].as_f64(), error(0));
    let names = |list: &str| -> Vec<&str> {
        let all = found[list].as_array().into_iter().flatten();
        all.filter_map(|row| row["name"].as_str()).collect()
    };
    assert_eq!(names("models"), ["sr108", "kcs"]);
    assert!(names("figures").contains(&"IMO: advance"), "{found}");
    let text = binary::run(&["compare", "sr108", "kcs"]);
    assert!(String::from_utf8_lossy(&text.stdout).contains("turn 35 deg: tactical diameter"));
    assert_eq!(binary::run(&["compare", "sr108"]).status.code(), Some(2));
    assert_eq!(binary::run(&["compare", "sr108", "sr108"]).status.code(), Some(2));
}

#[tokio::test(flavor = "multi_thread")]
async fn versions_over_http() {
    let server = TestServer::sqlite().await;
    let of = |path: String| server.request(reqwest::Method::GET, &path);
    let answer = of("/v1/models/kvlcc2/versions/1/export?format=c".to_owned()).send().await;
    let answer = answer.expect("an answer");
    let kept = answer.headers()["content-disposition"].to_str().expect("text").to_owned();
    assert_eq!(kept, "attachment; filename=\"kvlcc2_mmg.c\"");
    let code = answer.text().await.expect("a file");
    let version = server.get("/v1/models/kvlcc2/versions/1").await;
    let sha256 = version["version"]["sha256"].as_str().expect("a hash");
    assert!(code.contains("version kvlcc2/1") && code.contains(sha256), "{code}");
    create(&server).await;
    let uploaded = upload(&server).await;
    let trial = uploaded["trials"][0]["id"].as_str().expect("an id");
    let path = format!("/v1/compare?version=sr108/1&version=kvlcc2&trial={trial}");
    let found = server.get(&path).await;
    let error = |place: usize| found["trials"][0]["errors"][place]["standardised_mse"].as_f64();
    let own = error(0).expect("an error");
    assert!(error(1).is_none_or(|other| other > own), "SR108 made the trials of {NAME}: {found}");
    assert_eq!(found["models"][1]["law"], "mmg", "{found}");
    let missing = server.get("/v1/compare?version=sr108&version=lost/1").await;
    assert_eq!(
        (missing["status"].as_u64(), &missing["errors"][0]["field"]),
        (Some(422), &"version".into())
    );
    let alone = server.get("/v1/compare?version=sr108").await;
    assert_eq!(alone["status"], 400, "{alone}");
}

/// A ship with a version and trials, from a server on SQLite into one on PostgreSQL where that is
/// installed.
#[tokio::test(flavor = "multi_thread")]
async fn a_ship_moves_to_another_server() {
    let here = TestServer::sqlite().await;
    let there = match TestServer::postgres().await {
        Some(server) => server,
        None => TestServer::sqlite().await,
    };
    create(&here).await;
    let uploaded = upload(&here).await;
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("ship.bundle").display().to_string();
    let with = |server: &TestServer, arguments: &[&str]| {
        let all: Vec<String> =
            arguments.iter().map(|&a| a.to_owned()).chain(server.store_arguments()).collect();
        binary::run(&all.iter().map(String::as_str).collect::<Vec<_>>())
    };
    let key = |name: &str| format!("{}/data/keys/{name}", env!("CARGO_MANIFEST_DIR"));
    let (private, public, other) = (key("yard.pem"), key("yard.pub.pem"), key("other.pub.pem"));
    let signed = ["export", NAME, "--format", "bundle", "--sign-key", &private, "--out", &file];
    let done = with(&here, &signed);
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let refused = with(&there, &["import", "--bundle", &file, "--signed-by", &other]);
    let says = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(says.contains("which is not one of the given keys"), "{says}");
    let done = with(&there, &["import", "--bundle", &file, "--signed-by", &public, "--json"]);
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let taken: serde_json::Value = serde_json::from_slice(&done.stdout).expect("a document");
    assert_eq!((&taken["ships"][0], &taken["trials"]), (&NAME.into(), &4.into()), "{taken}");
    assert_eq!(taken["known_signer"], true, "{taken}");
    let trials = there.get(&format!("/v1/trials?ship={NAME}")).await;
    let hashes = |list: &serde_json::Value| -> Vec<String> {
        let all = list.as_array().into_iter().flatten();
        let mut all: Vec<String> =
            all.filter_map(|trial| Some(trial["sha256"].as_str()?.to_owned())).collect();
        all.sort();
        all
    };
    assert_eq!(hashes(&trials["items"]), hashes(&uploaded["trials"]));
    let broken = with(&there, &["import", "--bundle", "/dev/null"]);
    assert!(String::from_utf8_lossy(&broken.stderr).contains("is not a bundle"));
}
