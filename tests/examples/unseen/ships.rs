//! The ships, their clean trials and the models that plain calls make of these.

use std::path::{Path, PathBuf};

use sistership_model::Trial;
use sistership_tests::truth::container::container;
use sistership_tests::truth::family;
use sistership_tests::truth::ferry::ferry;
use sistership_tests::truth::files::{write_trials, write_vessel};
use sistership_tests::truth::instruments::Instruments;
use sistership_tests::truth::manoeuvre::PROGRAMME;
use sistership_tests::truth::model_tanker::model_tanker;
use sistership_tests::truth::motion::Truth;
use sistership_tests::truth::tanker::tanker;
use sistership_tests::truth::trials;

use crate::arguments::{Arguments, Half};
use crate::program::Program;

/// Clean trials of each ship.
const CLEAN: usize = 12;

/// A ship of the truth.
pub struct TrueShip {
    pub truth: Box<dyn Truth + Send + Sync>,
    /// Of its instruments.
    pub seed: u64,
}

/// A model that a plain call made, and where it lies.
pub struct Refined {
    pub path: PathBuf,
    /// Keeps the files.
    _folder: Option<tempfile::TempDir>,
}

/// The ships of a half: a container ship that rolls and a ship drawn at random for work; a tanker
/// that is straight-line unstable, a ferry with two propellers and a tanker model of 3 m for
/// judgement.
pub fn of(arguments: &Arguments) -> Vec<TrueShip> {
    let drawn = |number: &u64| TrueShip { truth: arguments.hull.ship(*number), seed: *number };
    if !arguments.drawn.is_empty() {
        return arguments.drawn.iter().map(drawn).collect();
    }
    let all: Vec<TrueShip> = match arguments.half {
        Half::Work => vec![
            TrueShip { truth: Box::new(container()), seed: 11 },
            TrueShip { truth: Box::new(family::single_screw(7)), seed: 13 },
        ],
        Half::Judgement => vec![
            TrueShip { truth: Box::new(tanker()), seed: 1011 },
            TrueShip { truth: Box::new(ferry()), seed: 1012 },
            TrueShip { truth: Box::new(model_tanker()), seed: 1013 },
        ],
    };
    let named = |ship: &TrueShip| arguments.ship.as_ref().is_none_or(|name| *name == ship.name());
    all.into_iter().filter(named).collect()
}

impl TrueShip {
    pub fn name(&self) -> String {
        self.truth.dimensions().name.clone()
    }

    /// Those of a ship of its size, one sample a second at full scale.
    pub fn instruments(&self) -> Instruments {
        let own = Instruments::of(&*self.truth);
        Instruments { interval_s: 2.0 * own.interval_s, ..own }
    }

    /// `sistership refine` on the clean trials.
    ///
    /// # Panics
    /// It makes no model.
    pub fn refined(&self, program: &Program) -> Refined {
        let kept = program.models.as_ref().map(|folder| folder.join(self.name()));
        let folder = kept.is_none().then(|| tempfile::tempdir().expect("a folder"));
        let path = kept.clone().or_else(|| folder.as_ref().map(|f| f.path().to_path_buf()));
        let path = path.expect("a folder");
        let (model, note) = (path.join("model.yaml"), path.join("chosen.txt"));
        if !model.exists() {
            std::fs::create_dir_all(&path).expect("a folder");
            let said = self.refine(program, &path, &model);
            std::fs::write(&note, said).expect("a note");
        }
        let chosen = std::fs::read_to_string(note).expect("what was chosen");
        println!("{}: {chosen}", self.name());
        Refined { path: model, _folder: folder }
    }

    fn refine(&self, program: &Program, folder: &Path, out: &Path) -> String {
        let truth = &*self.truth;
        let clean = trials(truth, &PROGRAMME[..CLEAN], &self.instruments(), self.seed);
        let ship = write_vessel(folder, truth.dimensions());
        let files = write_trials(folder, &self.name(), &clean.iter().collect::<Vec<&Trial>>());
        let words = [ship, files, out.to_path_buf()].map(|path| path.display().to_string());
        let [ship, files, out] = &words;
        let (answer, wall_s) =
            program.asked(&["refine", "--ship", ship, "--trials", files, "--out", out]);
        let answer = answer.unwrap_or_else(|error| panic!("{}: {error}", self.name()));
        let of = |name: &str| answer[name].as_str().unwrap_or("-").to_owned();
        let law = answer["model"]["law"].as_str().unwrap_or("-");
        format!("{} {law} {} in {wall_s:.1} s", of("source"), of("method"))
    }
}
