//! What was corrected once is kept as a template, and used for the next file.

use std::process::Command;

use serde_json::Value;
use sistership_tests::binary;

/// Names that say nothing, and a rudder in per cent of its largest angle.
fn file(shift: f64) -> String {
    let row = |k: i32| {
        let t = f64::from(k) * 0.5;
        let wave = (0.02 * t + shift).sin();
        format!("{t},{:.4},{:.4},{:.2}\n", 5.0 - 0.1 * wave, 30.0 * wave, 40.0 * wave)
    };
    let rows: String = (0..400).map(row).collect();
    format!("c1,c2,c3,c4\n{rows}")
}

fn channel<'a>(answer: &'a Value, column: &str) -> &'a Value {
    let guesses = answer["guesses"].as_array().expect("guesses");
    guesses.iter().find(|guess| guess["column"] == column).expect("a column")
}

#[test]
fn a_correction_is_kept_and_offered_for_the_next_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let import = |name: &str, shift: f64, flags: &[&str]| -> Value {
        let path = folder.path().join(name);
        std::fs::write(&path, file(shift)).expect("written");
        let out = folder.path().join(format!("{name}.yaml"));
        let mut command = Command::new(binary::path());
        command.env("SISTERSHIP_TEMPLATES", folder.path().join("templates"));
        command.arg("import").arg(&path).arg("--out").arg(&out).arg("--json").args(flags);
        let output = command.output().expect("the program runs");
        serde_json::from_slice(&output.stdout)
            .unwrap_or_else(|error| panic!("{error}: {}", String::from_utf8_lossy(&output.stderr)))
    };
    let settled = ["--column", "c1=t:s", "--column", "c2=u:m/s", "--column", "c3=psi:deg"];
    let rudder = ["--column", "c4=delta:deg:reversed", "--save-template", "yard-x"];
    let first = import("first.csv", 0.0, &[&settled[..], &rudder].concat());
    assert_eq!(channel(&first, "c4")["channel"], "delta", "{first}");
    let offered = import("second.csv", 1.0, &[]);
    assert!(offered["notes"].to_string().contains("use --template yard-x"), "{offered}");
    let second = import("third.csv", 2.0, &["--template", "yard-x"]);
    for column in ["c1", "c2", "c3", "c4"] {
        for key in ["channel", "unit", "reversed"] {
            assert_eq!(channel(&second, column)[key], channel(&first, column)[key], "{column}");
        }
    }
    assert!(second["notes"].is_null(), "{second}");
}
