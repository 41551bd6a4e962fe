//! The ships, their clean trials and the models that plain calls make of these.

use std::path::{Path, PathBuf};

use sistership_model::Trial;
use sistership_tests::truth::causes::{self, Course, Hidden};
use sistership_tests::truth::container::container;
use sistership_tests::truth::family;
use sistership_tests::truth::ferry::ferry;
use sistership_tests::truth::files::{write_trials, write_vessel};
use sistership_tests::truth::foreign::record::{self, Instruments as CraftInstruments};
use sistership_tests::truth::foreign::size::Size;
use sistership_tests::truth::foreign::{JUDGEMENT, Kind};
use sistership_tests::truth::instruments::Instruments;
use sistership_tests::truth::manoeuvre::{Manoeuvre, PROGRAMME};
use sistership_tests::truth::model_tanker::model_tanker;
use sistership_tests::truth::motion::Truth;
use sistership_tests::truth::tanker::tanker;
use sistership_tests::truth::trials;

use crate::arguments::{Arguments, Half};
use crate::program::Program;

/// Ships of the sets of clean trials.
const FLEET: usize = 20;

/// A ship of the truth.
pub struct TrueShip {
    pub truth: Box<dyn Truth + Send + Sync>,
    /// Of its instruments.
    pub seed: u64,
    /// Particulars and instruments of a craft of another form.
    foreign: Option<(Size, Instruments)>,
}

/// A model that a plain call made, and where it lies.
pub struct Refined {
    pub path: PathBuf,
    /// Keeps the files.
    _folder: Option<tempfile::TempDir>,
}

/// The ships of a half: a container ship that rolls and a ship drawn at random for work; a tanker
/// that is straight-line unstable, a ferry with two propellers and a tanker model of 3 m for
/// judgement; for each a car carrier and an outboard boat of foreign form.
pub fn of(arguments: &Arguments) -> Vec<TrueShip> {
    let drawn = |number: &u64| TrueShip::new(arguments.hull.ship(*number), *number);
    if !arguments.drawn.is_empty() {
        return arguments.drawn.iter().map(drawn).collect();
    }
    let all = if arguments.clean_sets > 0 { fleet(arguments.half) } else { few(arguments.half) };
    let named = |ship: &TrueShip| arguments.ship.as_ref().is_none_or(|name| *name == ship.name());
    all.into_iter().filter(named).collect()
}

fn few(half: Half) -> Vec<TrueShip> {
    match half {
        Half::Work => vec![
            TrueShip::new(Box::new(container()), 11),
            TrueShip::new(Box::new(family::single_screw(7)), 13),
            TrueShip::foreign(Kind::CarCarrier, 1),
            TrueShip::foreign(Kind::Outboard, 1),
        ],
        Half::Judgement => vec![
            TrueShip::new(Box::new(tanker()), 1011),
            TrueShip::new(Box::new(ferry()), 1012),
            TrueShip::new(Box::new(model_tanker()), 1013),
            TrueShip::foreign(Kind::CarCarrier, JUDGEMENT),
            TrueShip::foreign(Kind::Outboard, JUDGEMENT),
        ],
    }
}

/// Twenty ships: those of the half, others that are drawn, and all kinds of foreign craft that an
/// angle steers.
fn fleet(half: Half) -> Vec<TrueShip> {
    // The halves have no drawn ship and no foreign one in common.
    let (first, drawn) = match half {
        Half::Work => (1, 401..404),
        Half::Judgement => (JUDGEMENT, 1401..1404),
    };
    let mut all = few(half);
    let drawn: Vec<u64> = drawn.collect();
    all.extend(
        drawn.iter().map(|seed| TrueShip::new(Box::new(family::single_screw(*seed)), *seed)),
    );
    all.extend(drawn.iter().map(|seed| TrueShip::new(Box::new(family::twin_screw(*seed)), *seed)));
    let kinds =
        [Kind::Azimuth, Kind::TwinScrew, Kind::Pods, Kind::WaterJet, Kind::Cargo].into_iter();
    let kinds = kinds.chain([Kind::CarCarrier, Kind::Outboard]);
    let others = kinds.flat_map(|kind| [(kind, first), (kind, first + 1)]);
    let known = |(kind, seed): &(Kind, u64)| {
        !(*seed == first && matches!(kind, Kind::CarCarrier | Kind::Outboard))
    };
    all.extend(others.filter(known).map(|(kind, seed)| TrueShip::foreign(kind, seed)));
    all.truncate(FLEET);
    all
}

impl TrueShip {
    fn new(truth: Box<dyn Truth + Send + Sync>, seed: u64) -> Self {
        Self { truth, seed, foreign: None }
    }

    fn foreign(kind: Kind, seed: u64) -> Self {
        let craft = kind.craft(seed);
        let foreign = Some((craft.size().clone(), CraftInstruments::of(&craft).recorder()));
        // Each kind has random numbers of its own.
        Self { truth: Box::new(craft), seed: 2000 + 10 * seed + kind as u64, foreign }
    }

    pub fn name(&self) -> String {
        self.truth.dimensions().name.clone()
    }

    /// Those of a ship of its size, one sample a second at full scale.
    pub fn instruments(&self) -> Instruments {
        if let Some((_, instruments)) = self.foreign {
            return instruments;
        }
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

    fn clean_trials(&self, count: usize) -> Vec<Trial> {
        let (truth, manoeuvres) = (&*self.truth, &PROGRAMME[..count]);
        match self.foreign {
            // The engine of a foreign craft has a law of its own.
            Some(_) => {
                let course =
                    |manoeuvre: &Manoeuvre| Course { manoeuvre: *manoeuvre, heading_deg: 0.0 };
                let courses: Vec<Course> = manoeuvres.iter().map(course).collect();
                let nothing = Hidden::default();
                causes::trials(truth, &nothing, &courses, &self.instruments(), self.seed)
            }
            None => trials(truth, manoeuvres, &self.instruments(), self.seed),
        }
    }

    fn refine(&self, program: &Program, folder: &Path, out: &Path) -> String {
        let clean = self.clean_trials(program.clean_trials);
        let ship = match &self.foreign {
            Some((size, _)) => record::write_vessel(folder, size),
            None => write_vessel(folder, self.truth.dimensions()),
        };
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
