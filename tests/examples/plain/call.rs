//! Calls of `sistership refine`, and the models that they make.

use std::path::{Path, PathBuf};

use sistership_model::{Model, Zoo};

use crate::data::DataSet;
use crate::judge::{Judged, judge};
use crate::program::Program;

/// The estimators that take seconds; `cma-es` takes as long as it is given.
pub const METHODS: [&str; 3] = ["published", "weak", "trajectory"];

/// The flags of a call; none for the plain one.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Call {
    /// `--source`.
    pub source: Option<String>,
    /// `--law`.
    pub law: Option<String>,
    /// `--method`.
    pub method: Option<String>,
    /// `--zoo`.
    pub zoo: Option<PathBuf>,
}

/// What became of a call.
pub struct Made {
    /// How the model does on unseen trials, or why there is none.
    pub judged: Result<Judged, String>,
    /// What it says of its source, law and method.
    pub chosen: String,
    /// Seconds.
    pub wall_s: f64,
    /// Highest memory, MB.
    pub peak_mb: f64,
}

impl Call {
    /// The flags as one writes them.
    pub fn words(&self) -> Vec<String> {
        let flags = [("--source", &self.source), ("--law", &self.law), ("--method", &self.method)];
        let given = flags.into_iter().filter_map(|(flag, value)| Some((flag, value.clone()?)));
        let zoo = self.zoo.iter().map(|path| ("--zoo", path.display().to_string()));
        given.chain(zoo).flat_map(|(flag, value)| [flag.to_owned(), value]).collect()
    }

    /// The call as a person reads it.
    pub fn name(&self) -> String {
        let words = self.words().join(" ");
        if words.is_empty() { "plain".to_owned() } else { words }
    }

    /// Runs it in a new folder; the model stands there as `model.yaml` until the folder is dropped.
    pub fn refine(&self, program: &Program, data: &DataSet) -> (Made, tempfile::TempDir) {
        let folder = tempfile::tempdir().expect("a folder");
        let out = folder.path().join(MODEL);
        let trials = data.trials.display().to_string();
        let mut words: Vec<String> =
            ["refine", "--ship", &data.ship, "--trials", &trials].map(str::to_owned).to_vec();
        words.extend(["--out".to_owned(), out.display().to_string(), "--json".to_owned()]);
        words.extend(self.words());
        let ended = program.run(&words, folder.path());
        let chosen = ended.answer.as_ref().map(chosen).unwrap_or_default();
        let made = ended.answer.and_then(|_| read_model(&data.zoo, &out));
        let judged = made.and_then(|model| {
            let own = data.is_own(&chosen);
            if own { Err("took the ship's own model".into()) } else { judge(&model, data) }
        });
        (Made { judged, chosen, wall_s: ended.wall_s, peak_mb: ended.peak_mb }, folder)
    }
}

/// The file of a call's model.
pub const MODEL: &str = "model.yaml";

fn chosen(answer: &serde_json::Value) -> String {
    let of = |name: &str| answer[name].as_str().unwrap_or("-").to_owned();
    let law = answer["model"]["law"].as_str().unwrap_or("-");
    format!("{} {law} {}", of("source"), of("method"))
}

/// The model in a file.
///
/// # Errors
/// It is not there or does not read.
pub fn read_model(zoo: &Zoo, path: &Path) -> Result<Model, String> {
    let text = std::fs::read_to_string(path).map_err(|error| format!("no model: {error}"))?;
    let law = |name: &str| zoo.law(name).map(|law| (**law).clone());
    Model::parse(MODEL, &text, &law).map_err(|error| error.to_string())
}
