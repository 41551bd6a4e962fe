//! The program as a process.

use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::time::Instant;

use serde_json::Value;
use sistership_tests::binary;

use crate::arguments::Arguments;

/// The program that is judged.
pub struct Program {
    path: PathBuf,
    /// Number of clean trials that a model is refined on.
    pub clean_trials: usize,
    /// Where refined models are kept.
    pub models: Option<PathBuf>,
}

impl Program {
    /// The named one, or that of this tree.
    pub fn new(arguments: &Arguments) -> Self {
        let path = arguments.program.clone().unwrap_or_else(|| binary::path().clone());
        let (clean_trials, models) = (arguments.clean_trials, arguments.models.clone());
        Self { path, clean_trials, models }
    }

    /// Its JSON document, and how long it took, s.
    ///
    /// # Errors
    /// The last line that it said.
    pub fn asked(&self, words: &[&str]) -> (Result<Value, String>, f64) {
        let begun = Instant::now();
        let mut command = Command::new(&self.path);
        command.args(words).arg("--json").env_remove("SISTERSHIP_ZOO").stdin(Stdio::null());
        let output = command.output().expect("the program runs");
        let said = String::from_utf8_lossy(&output.stderr);
        let answer = match output.status.success() {
            true => serde_json::from_slice(&output.stdout).map_err(|error| error.to_string()),
            false => Err(said.lines().last().unwrap_or_default().to_owned()),
        };
        (answer, begun.elapsed().as_secs_f64())
    }
}
