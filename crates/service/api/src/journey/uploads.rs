//! Uploads with everything that a manifest may declare.

use std::time::Duration;

use reqwest::StatusCode;
use reqwest::multipart::{Form, Part};
use sistership_store::ObjectsPlace;
use sistership_store::testing::TestDatabase;

use super::harness::{Harness, config, read};
use crate::Server;
use crate::process::Process;

/// Two segments of a log, a heading from a sensor's own file, knots, a derived yaw rate.
const MANIFEST: &str = "
kind: trials
ship: mariner
derive: [r]
columns: { u: { column: log, unit: kn } }
trials:
  - { file: day.csv, from: 0, to: 30, sensors: [{ file: gyro.csv, columns: { psi: { column: hdg, unit: deg } } }] }
  - { file: day.csv, from: 31, to: 59, manoeuvre: turn }
";

fn log() -> String {
    let row = |k: u32| format!("{k},{},0.1,0.05,2.0", 14 + k % 2);
    let rows: Vec<String> = (0..60).map(row).collect();
    format!("t_s,log,v_m_s,delta_rad,n_rps\n{}\n", rows.join("\n"))
}

fn gyro() -> String {
    let row = |k: u32| format!("{},{}", f64::from(k) + 0.5, (350 + k) % 360);
    let rows: Vec<String> = (0..31).map(row).collect();
    format!("t_s,hdg\n{}\n", rows.join("\n"))
}

fn form(manifest: &str, files: &[(&str, String)]) -> Form {
    files.iter().fold(Form::new().text("manifest", manifest.to_owned()), |form, (name, text)| {
        form.part("file", Part::text(text.clone()).file_name((*name).to_owned()))
    })
}

#[tokio::test(flavor = "multi_thread")]
async fn declarations_sensors_and_stretches_are_taken_and_kept() {
    let harness = Harness::on(TestDatabase::new_sqlite()).await;
    let post =
        |path: &str, form: Form| harness.client.post(harness.url(path)).multipart(form).send();
    let files = [("day.csv", log()), ("gyro.csv", gyro())];
    let checked = read(post("/v1/trials/check", form(MANIFEST, &files)).await.unwrap()).await;
    assert_eq!(checked.0, StatusCode::OK, "{}", checked.1);
    // Without a heading nothing is derived for the second: all errors of both are reported at once.
    let errors = checked.1["trials"][1]["errors"].to_string();
    assert!(errors.contains("`r`") || errors.contains("psi"), "{}", checked.1);
    let whole = MANIFEST.replace("derive: [r]\n", "");
    let (status, kept) = read(post("/v1/trials", form(&whole, &files)).await.unwrap()).await;
    assert_eq!((status, kept["new"].as_u64()), (StatusCode::CREATED, Some(2)), "{kept}");
    let first = &kept["trials"][0];
    // The gyro begins half a second later.
    assert_eq!(first["rows"], 30, "{first}");
    assert_eq!(first["manifest"]["trials"][0]["sensors"][0]["file"], "gyro.csv", "{first}");
    assert_eq!(kept["trials"][1]["manoeuvre"], "turn");
    let place = format!("/v1/trials/{}/samples", first["id"].as_str().unwrap());
    let samples = harness.client.get(harness.url(&place)).send().await.unwrap();
    let text = samples.text().await.unwrap();
    assert!(text.lines().next().unwrap().contains("psi_rad"), "{text}");
    let (status, problem) =
        read(post("/v1/trials", form(&whole, &files[..1])).await.unwrap()).await;
    assert_eq!(status, StatusCode::UNPROCESSABLE_ENTITY);
    assert_eq!(problem["errors"][0]["field"], "trials[0].sensors[0].file", "{problem}");
    harness.server.stop().await;
}

/// Large files of one caller do not delay small ones.
#[tokio::test]
async fn small_files_wait_for_no_large_one() {
    let database = TestDatabase::new_sqlite();
    let mut config = config(&database);
    config.workers = 0;
    let (process, app) = Process::start(&config, false).await.unwrap();
    let (mut large, patience) = (Vec::new(), Duration::from_millis(200));
    while let Ok(turn) = tokio::time::timeout(patience, app.wait_file_turn(u64::MAX)).await {
        large.push(turn.unwrap());
    }
    assert!(!large.is_empty());
    let small = tokio::time::timeout(patience, app.wait_file_turn(1000)).await;
    assert!(small.is_ok_and(|turn| turn.is_ok()));
    process.stop().await;
}

/// Only what needs objects waits for a bucket that does not answer.
#[tokio::test(flavor = "multi_thread")]
async fn a_server_starts_while_its_bucket_does_not_answer() {
    let database = TestDatabase::new_sqlite();
    let mut config = config(&database);
    let nowhere = Some("http://127.0.0.1:1".to_owned());
    config.objects = ObjectsPlace::parse_s3("s3://samples/fleet", nowhere, None).unwrap();
    let server = Server::start(config).await.unwrap();
    let harness = Harness { server, client: reqwest::Client::new(), database };
    let ask = async |path: &str| harness.client.get(harness.url(path)).send().await.unwrap();
    assert_eq!(ask("/readyz").await.status(), StatusCode::SERVICE_UNAVAILABLE);
    assert_eq!(ask("/v1/ships").await.status(), StatusCode::OK);
    harness.server.stop().await;
}
