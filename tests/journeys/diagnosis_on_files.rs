//! `sistership diagnose` on files: what scripts depend on, what a person reads, and how it refuses.

use std::path::PathBuf;
use std::process::Output;

use serde_json::Value;
use sistership_model::Trial;
use sistership_tests::binary;

use super::lacking::{EFFECT, OFFSET_DEG, further, manifest, sound, trials};
use super::sea_trials::csv;

/// A folder with trials and their manifest.
struct Folder(tempfile::TempDir);

impl Folder {
    fn with(trials: &[Trial]) -> Self {
        let folder = Self(tempfile::tempdir().expect("a temporary folder"));
        for trial in trials {
            folder.write(&trial.name, &csv(trial));
        }
        folder.write("trials.yaml", manifest(trials).as_bytes());
        folder
    }

    fn at(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn path(&self, name: &str) -> String {
        self.at(name).display().to_string()
    }

    fn write(&self, name: &str, bytes: &[u8]) {
        std::fs::write(self.at(name), bytes).expect("written");
    }

    fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.at(name)).expect("a file")
    }
}

/// What goes to standard error of a run with this status.
fn said(arguments: &[&str], status: i32) -> String {
    let Output { status: ended, stdout, stderr } = binary::run(arguments);
    let message = String::from_utf8_lossy(&stderr).into_owned();
    assert_eq!(ended.code(), Some(status), "{arguments:?}: {message}");
    assert!(status == 0 || stdout.is_empty(), "{arguments:?} prints although it refuses");
    message
}

#[test]
fn what_is_missing_is_named_and_added() {
    let folder = Folder::with(&trials());
    let (out, report) = (folder.path("with.yaml"), folder.path("diagnosis.html"));
    let arguments = [
        "diagnose",
        "--model",
        "mariner",
        "--trials",
        &folder.path("trials.yaml"),
        "--out",
        &out,
        "--report",
        &report,
        "--json",
    ];
    let found = binary::json(&arguments, 0);
    assert_eq!(found["verdict"], "effects", "{found}");
    let effect = &found["effects"][0];
    assert_eq!(effect["name"], EFFECT, "{found}");
    let offset = &effect["parameters"]["offset_deg"];
    let (value, se) = (
        offset["value"].as_f64().expect("a value"),
        offset["se"].as_f64().expect("a standard error"),
    );
    assert!((value - OFFSET_DEG).abs() < 0.3 && se > 0.0 && se < 0.3, "{offset}");
    keys(&found);
    let error = |which: &str| found[which]["psi"].as_f64().expect("an error");
    assert!(error("after") < 0.5 * error("before"), "{found}");
    let page = folder.read("diagnosis.html");
    assert!(
        page.contains("Your model lacks") && page.contains("<svg"),
        "the report says it and has plots"
    );
    assert!(!page.contains("<script src") && !page.contains("src="), "the report stands alone");
    better_on_further_trials(&out);
}

/// What scripts read.
fn keys(found: &Value) {
    for key in [
        "verdict",
        "effects",
        "unexplained",
        "before",
        "after",
        "hypotheses",
        "settings",
        "remarks",
        "out",
        "report",
    ] {
        assert!(!found[key].is_null(), "{key} is missing");
    }
    for key in ["name", "parameters", "evidence", "confounded_with"] {
        assert!(!found["effects"][0][key].is_null(), "effects[].{key} is missing");
    }
    for hypothesis in found["hypotheses"].as_array().expect("a list") {
        let reason = hypothesis["refused"].as_str().unwrap_or_default();
        assert_eq!(hypothesis["taken"] == true, reason.is_empty(), "{hypothesis}");
    }
    let fields = found.as_object().expect("an object");
    assert!(fields.contains_key("next_trial"), "null where there is none");
    assert!(
        !fields.contains_key("model") && !fields.contains_key("residuals"),
        "neither belongs on standard output"
    );
    for channel in ["u", "v", "r", "psi", "x", "y"] {
        assert!(
            ["before", "after"].iter().all(|which| found[which][channel].is_f64()),
            "{channel}"
        );
    }
}

/// The model that was written is a model like any other, and right where its trials have not been.
fn better_on_further_trials(model: &str) {
    let folder = Folder::with(&further());
    let error = |model: &str| -> f64 {
        let run = binary::json(
            &["simulate", "--model", model, "--trials", &folder.path("trials.yaml"), "--json"],
            0,
        );
        run["trials"]
            .as_array()
            .expect("trials")
            .iter()
            .map(|trial| trial["rmse"]["psi"].as_f64().expect("an error"))
            .sum()
    };
    assert!(error(model) < 0.3 * error("mariner"), "{} and {}", error(model), error("mariner"));
}

#[test]
fn a_model_that_lacks_nothing_is_complete() {
    let folder = Folder::with(&sound());
    let (trials, out) = (folder.path("trials.yaml"), folder.path("with.yaml"));
    let found = binary::json(
        &["diagnose", "--model", "mariner", "--trials", &trials, "--out", &out, "--json"],
        0,
    );
    assert_eq!(
        (found["verdict"].as_str(), found["effects"].as_array().map(Vec::len)),
        (Some("complete"), Some(0)),
        "{found}"
    );
    assert_eq!(found["before"], found["after"]);
    assert!(
        found["out"].is_null() && !folder.at("with.yaml").exists(),
        "there is no model to write"
    );
    let text = binary::run(&["diagnose", "--model", "mariner", "--trials", &trials]);
    let text = String::from_utf8_lossy(&text.stdout).into_owned();
    assert!(text.contains("COMPLETE") && text.contains("Root mean square errors"), "{text}");
}

#[test]
fn a_person_reads_what_is_missing() {
    let folder = Folder::with(&trials());
    let shown =
        binary::run(&["diagnose", "--model", "mariner", "--trials", &folder.path("trials.yaml")]);
    let text = String::from_utf8_lossy(&shown.stdout).into_owned();
    for part in
        ["EFFECTS", EFFECT, "offset_deg", "standard error", "before", "after", "--out MODEL.yaml"]
    {
        assert!(text.contains(part), "{part}: {text}");
    }
    assert!(
        String::from_utf8_lossy(&shown.stderr).contains('%'),
        "progress goes to standard error"
    );
}

#[test]
fn an_effect_of_a_folder_is_known() {
    let folder = Folder::with(&trials());
    let library = tempfile::tempdir().expect("a temporary folder");
    std::fs::create_dir(library.path().join("effects")).expect("a folder");
    let broken = "kind: effect\nname: broken\ntitle: x\nacts_on: nowhere\n";
    std::fs::write(library.path().join("effects/broken.yaml"), broken).expect("written");
    let (zoo, trials) = (library.path().display().to_string(), folder.path("trials.yaml"));
    let diagnose = |status: i32| {
        said(
            &["diagnose", "--zoo", &zoo, "--model", "mariner", "--trials", &trials, "--json"],
            status,
        )
    };
    let message = diagnose(1);
    assert!(message.contains("effects/broken.yaml") && message.contains("nowhere"), "{message}");
    std::fs::remove_file(library.path().join("effects/broken.yaml")).expect("removed");
    let zoo_itself =
        sistership_model::Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"));
    let twin = zoo_itself
        .effect_text(EFFECT)
        .expect("in the library")
        .replace("name: rudder-offset", "name: rudder-twin");
    std::fs::write(library.path().join("effects/twin.yaml"), twin).expect("written");
    let found = binary::json(
        &["diagnose", "--zoo", &zoo, "--model", "mariner", "--trials", &trials, "--json"],
        0,
    );
    let tried: Vec<&Value> =
        found["hypotheses"].as_array().expect("a list").iter().map(|one| &one["effects"]).collect();
    assert!(tried.contains(&&serde_json::json!(["rudder-twin/constant"])), "{tried:?}");
}

#[test]
fn what_is_wrong_is_named() {
    let folder = Folder::with(&sound());
    let trials = folder.path("trials.yaml");
    let diagnose = |rest: &[&str], status: i32| said(&[&["diagnose"], rest].concat(), status);
    let call = |rest: &[&str], status: i32| {
        diagnose(&[&["--model", "mariner", "--trials", &trials], rest].concat(), status)
    };
    assert!(diagnose(&["--model", "mariner"], 2).contains("--trials"));
    assert!(call(&["--slack", "0"], 2).contains("--slack"));
    assert!(call(&["--slack", "3"], 2).contains("at most 1"));
    assert!(call(&["--most-effects", "9"], 2).contains("--most-effects"));
    assert!(call(&["--least-evidence", "-1"], 2).contains("--least-evidence"));
    assert!(call(&["--least-step-s", "0"], 2).contains("--least-step-s"));
    assert!(call(&["--restart-s", "soon"], 2).contains("soon"));
    assert!(call(&["--out", &trials], 1).contains("will not be overwritten"));
    assert!(
        diagnose(&["--model", "marriner", "--trials", &trials], 1).contains("mariner"),
        "a close name is suggested"
    );
    assert!(
        diagnose(&["--model", "mariner", "--trials", &folder.path("none.csv")], 1)
            .contains("none.csv")
    );
    let good = String::from_utf8(csv(&sound()[0])).expect("text");
    folder.write("bad.csv", spoiled(&good).as_bytes());
    let message = diagnose(&["--model", "mariner", "--trials", &folder.path("bad.csv")], 1);
    assert!(
        message.contains("bad.csv") && message.contains("12") && message.contains("u_m_s"),
        "{message}"
    );
    folder.write("short.csv", b"t_s,psi_rad\n0,0\n1,0\n2,0\n3,0\n");
    let message = diagnose(&["--model", "mariner", "--trials", &folder.path("short.csv")], 1);
    assert!(message.contains("short"), "the trial and what it lacks: {message}");
    for left_over in ["with.yaml", "diagnosis.html"] {
        assert!(!folder.at(left_over).exists());
    }
}

/// A recording whose row 12 has a word for a number in the column `u_m_s`.
fn spoiled(good: &str) -> String {
    let place = good.split([',', '\n']).position(|name| name == "u_m_s").expect("a column");
    let spoil = |row: &str| {
        let cells = row
            .split(',')
            .enumerate()
            .map(|(column, cell)| if column == place { "fast" } else { cell });
        cells.collect::<Vec<_>>().join(",")
    };
    let rows = good
        .lines()
        .enumerate()
        .map(|(index, row)| if index == 11 { spoil(row) } else { row.to_owned() });
    rows.collect::<Vec<_>>().join("\n")
}
