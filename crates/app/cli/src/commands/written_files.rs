//! Files that a command writes in addition to its output.

use std::path::{Path, PathBuf};

use serde::Serialize;
use sistership_model::{Model, Zoo};

use crate::failure::Failure;
use crate::files::OutputFile;
use crate::trials::{self, ReadTrial};

/// Files that were written.
#[derive(Clone, Copy, Serialize)]
pub struct WrittenFiles<'a> {
    /// The model.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub out: Option<&'a Path>,
    /// The report.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub report: Option<&'a Path>,
}

/// Prepares an output file, if one is requested.
///
/// # Errors
/// Returns an error if it cannot be written, or is one of `inputs`.
pub fn output_file(path: Option<&Path>, inputs: &[PathBuf]) -> Result<Option<OutputFile>, Failure> {
    path.map(|path| OutputFile::new(path, inputs)).transpose()
}

/// Checks that no output is an input: the files of a manifest are known only after it was read.
///
/// # Errors
/// Returns an error that names the file.
pub fn check_outputs(files: &WrittenFiles<'_>, read: &[ReadTrial]) -> Result<(), Failure> {
    let inputs = trials::input_paths(read, &[]);
    let mut files = files.out.into_iter().chain(files.report);
    files.try_for_each(|path| OutputFile::new(path, &inputs).map(|_| ()))
}

/// Returns the model as YAML, which is parsed once as a check; `how` describes its method.
///
/// # Errors
/// Returns an error if it cannot be parsed again.
pub fn model_file(zoo: &Zoo, model: &Model, how: &str) -> Result<String, Failure> {
    let text = serde_yaml::to_string(model)
        .map_err(|error| Failure::Refused(format!("the model cannot be written: {error}")))?;
    let text =
        format!("# {} by sistership {}, {how}\n{text}", model.name, env!("CARGO_PKG_VERSION"));
    Model::parse("the model to be written", &text, &|law| zoo.law(law).map(|law| (**law).clone()))?;
    Ok(text)
}
