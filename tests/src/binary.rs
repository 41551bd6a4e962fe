//! The program itself, built once for all tests of a process.

use std::path::PathBuf;
use std::process::{Command, Output, Stdio};
use std::sync::OnceLock;

/// The path of the `sistership` program: the one that `SISTERSHIP_PROGRAM` names, such as a
/// release, else that of this tree, built in the profile of the tests.
///
/// # Panics
/// Where it does not build.
pub fn path() -> &'static PathBuf {
    static PATH: OnceLock<PathBuf> = OnceLock::new();
    PATH.get_or_init(|| std::env::var_os("SISTERSHIP_PROGRAM").map_or_else(build, PathBuf::from))
}

/// Cargo does not build another package's program for a test, so it is asked to build a test of
/// that package, which brings the program. Asked for the whole workspace it takes the features that
/// the tests were built with, and has nothing left to do.
fn build() -> PathBuf {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(cargo);
    command.args([
        "test",
        "--no-run",
        "--workspace",
        "--test",
        "program",
        "--message-format",
        "json",
    ]);
    if !cfg!(debug_assertions) {
        command.arg("--release");
    }
    // Build scripts watch what cargo tells a test about its own package, and would run again
    // because of it.
    let of_this_test =
        |name: &str| name.starts_with("CARGO_PKG_") || name.starts_with("CARGO_MANIFEST_");
    for (name, _) in std::env::vars().filter(|(name, _)| of_this_test(name)) {
        command.env_remove(name);
    }
    let built = command
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .stderr(Stdio::inherit())
        .output()
        .expect("cargo runs");
    assert!(built.status.success(), "the program does not build");
    let messages = String::from_utf8_lossy(&built.stdout);
    let executables =
        messages.lines().filter_map(|line| serde_json::from_str::<serde_json::Value>(line).ok());
    let programs = executables.filter(|message| message["target"]["kind"][0] == "bin");
    let path = programs
        .filter_map(|message| message["executable"].as_str().map(PathBuf::from))
        .next_back();
    path.expect("cargo names the program it built")
}

/// Runs the program to its end.
///
/// # Panics
/// Where it cannot be started.
pub fn run(arguments: &[&str]) -> Output {
    run_with(arguments, &[])
}

/// Runs the program to its end, with more in its environment.
///
/// # Panics
/// Where it cannot be started.
pub fn run_with(arguments: &[&str], environment: &[(&str, &str)]) -> Output {
    let mut command = Command::new(path());
    command.args(arguments).env_remove("SISTERSHIP_ZOO").envs(environment.iter().copied());
    command.output().expect("the program runs")
}

/// Runs it with `--json` in mind: asserts the exit status and reads standard output as one JSON
/// document.
///
/// # Panics
/// Where the exit status is another, or the output is not one JSON document.
pub fn json(arguments: &[&str], status: i32) -> serde_json::Value {
    json_with(arguments, &[], status)
}

/// The same with more in its environment.
///
/// # Panics
/// As [`json`].
pub fn json_with(
    arguments: &[&str],
    environment: &[(&str, &str)],
    status: i32,
) -> serde_json::Value {
    let output = run_with(arguments, environment);
    let (out, err) =
        (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert_eq!(output.status.code(), Some(status), "{arguments:?}: {err}");
    serde_json::from_str(&out).unwrap_or_else(|error| panic!("{arguments:?}: {error}: {out}"))
}
