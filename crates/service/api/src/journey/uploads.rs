//! Uploads with everything that a manifest may declare.

use reqwest::StatusCode;
use reqwest::multipart::{Form, Part};
use sistership_store::testing::TestDatabase;

use super::harness::{Harness, read};

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
