//! One refinement by the default call, and the judgement of its model.

use std::path::Path;

use serde_json::Value;

use super::case::CraftFiles;
use super::documents::{Chosen, Speeds, errors, tactical_diameter};
use crate::program::{Ended, Program};

/// Judgement of one refinement.
pub struct Verdict {
    /// What was chosen, or why there is no model.
    pub chosen: Result<Chosen, String>,
    /// Wall time of the refinement, s.
    pub wall_s: f64,
    /// Judgement of the model, where there is one.
    pub judged: Option<Judged>,
}

/// Judgement of a model.
pub struct Judged {
    /// Standardised mean squared error on unseen manoeuvres with restarts; absent where a
    /// simulation left the physical range.
    pub error: Option<f64>,
    /// The same and the heading error, deg, of whole runs.
    pub whole: Option<[f64; 2]>,
    /// Tactical diameters to starboard and port by those of the craft.
    pub diameters: [Option<f64>; 2],
    /// Speeds with the propeller stopped and reversed.
    pub propulsion: Propulsion,
    /// Whether a diagnosis of one trial more is given, or why not.
    pub diagnosis: Result<(), String>,
}

/// Speeds by that of the approach; absent where the simulation left the physical range.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Propulsion {
    /// With the propeller stopped, when the craft has lost nine tenths.
    pub stopped: Option<f64>,
    /// With it reversed, when the craft is at rest.
    pub at_rest: Option<f64>,
    /// With it reversed, at the end.
    pub astern: Option<f64>,
    /// The same of the craft.
    pub true_astern: f64,
}

impl Verdict {
    /// Refines on the first trials of a craft and judges the model.
    ///
    /// # Panics
    /// A folder cannot be made.
    pub fn new(program: &Program, files: &CraftFiles, count: usize) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let model = folder.path().join("model.yaml").display().to_string();
        let (vessel, trials) = (words(&files.vessel), words(&files.trials(count)));
        let call = ["refine", "--ship", &vessel, "--trials", &trials, "--out", &model, "--json"];
        let ended = run(program, &call, folder.path());
        let chosen = ended.answer.as_ref().map(Chosen::from_document).map_err(String::clone);
        let judge = Judge { program, files, model: &model, folder: folder.path() };
        let judged = chosen.is_ok().then(|| judge.judged());
        Self { chosen, wall_s: ended.wall_s, judged }
    }
}

fn run(program: &Program, call: &[&str], folder: &Path) -> Ended {
    let call: Vec<String> = call.iter().map(|word| (*word).to_owned()).collect();
    program.run(&call, folder)
}

fn words(path: &Path) -> String {
    path.display().to_string()
}

/// A model before its judgement.
struct Judge<'a> {
    program: &'a Program,
    files: &'a CraftFiles,
    model: &'a str,
    folder: &'a Path,
}

impl Judge<'_> {
    fn judged(&self) -> Judged {
        let restart = self.files.restart_s.to_string();
        Judged {
            error: self.errors(&["--restart-s", &restart]).map(|[error, _]| error),
            whole: self.errors(&[]),
            diameters: self.diameters(),
            propulsion: self.propulsion(),
            diagnosis: self.diagnosis(),
        }
    }

    fn simulate(&self, trials: &Path, further: &[&str]) -> Option<Value> {
        let trials = words(trials);
        let mut call = vec!["simulate", "--model", self.model, "--trials", &trials, "--json"];
        call.extend(further);
        run(self.program, &call, self.folder).printed
    }

    fn errors(&self, further: &[&str]) -> Option<[f64; 2]> {
        errors(&self.simulate(&self.files.unseen, further)?)
    }

    fn diameters(&self) -> [Option<f64>; 2] {
        let call = ["manoeuvre", "--model", self.model, "--json"];
        let Some(document) = run(self.program, &call, self.folder).printed else {
            return [None; 2];
        };
        let [starboard, port] = self.files.diameters_m;
        [(35.0, starboard), (-35.0, port)].map(|(angle_deg, true_m)| {
            tactical_diameter(&document, angle_deg).map(|metres| metres / true_m)
        })
    }

    fn propulsion(&self) -> Propulsion {
        let ends = &self.files.ends;
        let by_approach = |speed: f64| speed / ends.approach_m_s;
        let [stopped, reversed] =
            [0, 1].map(|index| self.speeds(&self.files.coasting[index], index));
        let (stopped, reversed) = (stopped.as_ref(), reversed.as_ref());
        let at_rest = reversed.zip(ends.rest_s).and_then(|(speeds, rest_s)| speeds.at(rest_s));
        Propulsion {
            stopped: stopped.and_then(Speeds::last).map(by_approach),
            at_rest: at_rest.map(by_approach),
            astern: reversed.and_then(Speeds::last).map(by_approach),
            true_astern: by_approach(ends.last_m_s[1]),
        }
    }

    /// Simulated speeds of a run; absent where the simulation left the physical range.
    fn speeds(&self, trials: &Path, index: usize) -> Option<Speeds> {
        let folder = self.folder.join(format!("coasting-{index}"));
        let document = self.simulate(trials, &["--out", &words(&folder)])?;
        if document["trials"][0]["diverged"] == true {
            return None;
        }
        Speeds::read(&folder)
    }

    fn diagnosis(&self) -> Result<(), String> {
        let trials = words(&self.files.further);
        let call = ["diagnose", "--model", self.model, "--trials", &trials, "--json"];
        let ended = run(self.program, &call, self.folder);
        match (ended.printed, ended.answer) {
            (Some(_), _) => Ok(()),
            (None, answer) => answer.map(drop),
        }
    }
}
