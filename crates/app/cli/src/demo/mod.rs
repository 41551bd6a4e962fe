//! `sistership demo`: the whole loop through the real server, on an embedded database, ending in a
//! report.

mod client;

use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::Args;
use serde_json::{Value, json};
use sistership_api::{Config, RunningServer, Server};
use sistership_identification::refine::HeldOut;
use sistership_jobs::example::{self, HELD_OUT_TRIALS, SHIP_NAME, SHIP_YAML, TRIAL_SHIP};
use sistership_model::{Trial, Zoo};

use self::client::ApiClient;
use crate::commands::refine_text;
use crate::commands::store::block_on;
use crate::failure::{Failure, about_file};
use crate::output;

const ABOUT: &str = "\
Starts the server on a database in FOLDER, creates a ship, uploads trials, selects a source,
refines, queries the champion, prints the errors before and after, and writes FOLDER/report.html.
The trials are simulations of the ship SR108 (4-DOF, with sensor noise), which is removed from the
zoo first, so that no model of its law can be selected.";

/// Show the whole loop: ship, trials, source, refinement, champion, report.
#[derive(Debug, Args)]
#[command(after_help = ABOUT)]
pub struct DemoArguments {
    /// Folder for the database, the samples and the report; emptied first.
    #[arg(long, value_name = "FOLDER", default_value = "demo-out")]
    out: PathBuf,
}

/// Runs the demonstration.
///
/// # Errors
/// Returns an error if the server refuses a request, or if a file cannot be written.
pub fn run(demo: &DemoArguments, zoo: &Zoo) -> Result<(), Failure> {
    // Before the folder is emptied: a failure leaves an old demonstration as it is.
    let trials = record_trials(zoo)?;
    empty_folder(&demo.out)?;
    block_on(async {
        let mut config = Config::new(demo.out.join("data"));
        // A free port: another server may run on the default one.
        config.listen.set_port(0);
        let running =
            Server::start(config).await.map_err(|error| Failure::Refused(error.to_string()))?;
        let told = run_steps(&running, &trials, &demo.out).await;
        // Also after an error, so that the database is closed.
        running.stop().await;
        told
    })
}

/// Simulates and records the trials of the unknown ship.
fn record_trials(zoo: &Zoo) -> Result<Vec<Trial>, Failure> {
    output::print_note(
        "1/8  simulating the trials: SR108 with roll, by Son and Nomoto's law, with sensor noise",
    );
    example::record_trials(zoo).map_err(Failure::Refused)
}

/// Removes an old demonstration; a folder with any other file is refused.
fn empty_folder(folder: &Path) -> Result<(), Failure> {
    // Checked for every entry before anything is removed.
    let ours = |name: &std::ffi::OsStr| name == "data" || name == "report.html";
    let failed = |error: std::io::Error| about_file(folder, error.to_string());
    std::fs::create_dir_all(folder).map_err(failed)?;
    for entry in std::fs::read_dir(folder).map_err(failed)? {
        let entry = entry.map_err(failed)?;
        if !ours(&entry.file_name()) {
            return Err(about_file(
                folder,
                "contains other files; choose an empty folder with --out",
            ));
        }
    }
    for (name, is_folder) in [("data", true), ("report.html", false)] {
        let path = folder.join(name);
        if path.exists() {
            if is_folder { std::fs::remove_dir_all(path) } else { std::fs::remove_file(path) }
                .map_err(failed)?;
        }
    }
    Ok(())
}

async fn run_steps(running: &RunningServer, trials: &[Trial], out: &Path) -> Result<(), Failure> {
    let api = ApiClient::new(running.url());
    output::print_note(&format!(
        "2/8  server on {} with an embedded database in {}",
        running.url(),
        out.display()
    ));
    // The ship of the trials must not be available as a source.
    api.delete(&format!("/v1/ships/{TRIAL_SHIP}")).await?;
    output::print_note(
        "3/8  creating the ship northern-star; SR108 is removed from the zoo, because it made the \
         trials",
    );
    api.post_yaml("/v1/ships", SHIP_YAML.to_owned()).await?;
    upload_trials(&api, trials).await?;
    let job = refine_model(&api, trials).await?;
    let champion = api.get(&format!("/v1/ships/{SHIP_NAME}/model")).await?;
    output::print_note(&format!("7/8  champion: {}", describe_champion(&champion)));
    let report =
        job["report"].as_str().ok_or_else(|| Failure::Refused("the job has no report".into()))?;
    let path = out.join("report.html");
    let html = api.get_text(&format!("/v1/reports/{report}"), "text/html").await?;
    std::fs::write(&path, html).map_err(|error| about_file(&path, error.to_string()))?;
    let held_out: HeldOut = serde_json::from_value(job["held_out"].clone())
        .map_err(|error| Failure::Refused(error.to_string()))?;
    output::print_note(&format!("8/8  report written to {}\n", path.display()));
    output::print_result(false, &job, || {
        format!(
            "Root mean square errors, {}\n{}",
            held_out.how,
            refine_text::format_errors(&held_out, false)
        )
    })
}

async fn upload_trials(api: &ApiClient, trials: &[Trial]) -> Result<(), Failure> {
    let files = example::trial_files(trials).map_err(Failure::Refused)?;
    // JSON is YAML.
    let manifest = example::trial_manifest(trials).to_string();
    let uploaded = api.upload_trials(manifest, files).await?;
    let rows: i64 = uploaded["trials"]
        .as_array()
        .into_iter()
        .flatten()
        .filter_map(|trial| trial["rows"].as_i64())
        .sum();
    output::print_note(&format!(
        "4/8  uploaded {} trials, {rows} samples, every check passed",
        trials.len()
    ));
    Ok(())
}

/// Requests a refinement and follows its job.
async fn refine_model(api: &ApiClient, trials: &[Trial]) -> Result<Value, Failure> {
    let held_out: Vec<&str> =
        // The last trials of the programme.
        trials[trials.len() - HELD_OUT_TRIALS..].iter().map(|trial| trial.name.as_str()).collect();
    let request =
        json!({ "ship": SHIP_NAME, "source": "auto", "settings": { "held_out": held_out } });
    let queued = api.post_json("/v1/refinements", &request).await?;
    let id = queued["id"].as_str().unwrap_or_default().to_owned();
    output::print_note(&format!(
        "5/8  refinement job {id}; held-out trials: {}",
        held_out.join(", ")
    ));
    // Each message of the job is printed once.
    let mut last = String::new();
    loop {
        let job = api.get(&format!("/v1/jobs/{id}")).await?;
        let message = job["message"].as_str().unwrap_or_default();
        if message != last {
            output::print_note(&format!(
                "     {:3.0} % {message}",
                100.0 * job["progress"].as_f64().unwrap_or(0.0)
            ));
            message.clone_into(&mut last);
        }
        match job["state"].as_str() {
            Some("succeeded") => return print_selection(&job["result"]),
            Some("failed" | "cancelled") => {
                return Err(Failure::Refused(format!("the job failed: {}", job["error"])));
            }
            _ => tokio::time::sleep(Duration::from_millis(100)).await,
        }
    }
}

/// Prints the selected source, and the reasons against the others.
fn print_selection(result: &Value) -> Result<Value, Failure> {
    let from = result["from"].as_str().unwrap_or_default();
    output::print_note(&format!("6/8  refined from {from}"));
    for ranked in result["ranking"]
        .as_array()
        .into_iter()
        .flatten()
        .filter(|ranked| ranked["model"].is_string())
    {
        let correlation =
            ranked["correlation"].as_f64().map_or("?".to_owned(), |r| format!("{r:+.3}"));
        let reasons: Vec<&str> =
            ranked["reasons"].as_array().into_iter().flatten().filter_map(Value::as_str).collect();
        let verdict = if ranked["eligible"] == true { "eligible" } else { "not eligible" };
        output::print_note(&format!(
            "     {:<12} {correlation} {verdict}: {}",
            ranked["ship"].as_str().unwrap_or("?"),
            reasons.join("; ")
        ));
    }
    Ok(result.clone())
}

fn describe_champion(champion: &Value) -> String {
    let version = &champion["version"];
    let text = |value: &Value| value.as_str().unwrap_or("?").to_owned();
    let coefficients =
        champion["model"]["coefficients"].as_object().map_or(0, serde_json::Map::len);
    let hash: String = text(&version["sha256"]).chars().take(12).collect();
    format!(
        "version {} of {}, law {}, {coefficients} coefficients, sha256 {hash}",
        version["number"],
        text(&version["model"]),
        text(&version["law"])
    )
}
