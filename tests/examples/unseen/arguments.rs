//! What is asked for.

use std::path::PathBuf;

use sistership_tests::truth::family::Hull;

/// Which ships.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Half {
    /// Those on which the diagnosis is worked.
    Work,
    /// Those on which it is judged.
    Judgement,
}

/// The command line.
pub struct Arguments {
    pub half: Half,
    /// Labels begin with one of these.
    pub only: Vec<String>,
    pub ship: Option<String>,
    pub seeds: u64,
    /// Shares of the size that is hidden.
    pub sizes: Vec<f64>,
    /// Shares of their detection limits at which effects are hidden instead.
    pub limits: Vec<f64>,
    /// Speeds of a steady wind with an anemometer, m/s, that are hidden instead.
    pub winds: Vec<f64>,
    /// Clean sets of drawn manoeuvres of each of twenty ships, which are diagnosed instead.
    pub clean_sets: u64,
    /// What begins within trials or between them is hidden instead.
    pub changes: bool,
    /// Numbers that draw ships, which take the place of those of the half.
    pub drawn: Vec<u64>,
    /// The kind of hull that they draw.
    pub hull: Hull,
    /// The program that is judged; this tree's where absent.
    pub program: Option<PathBuf>,
    /// Number of clean trials that a model is refined on.
    pub clean_trials: usize,
    /// Where refined models are kept.
    pub models: Option<PathBuf>,
    pub jobs: usize,
}

impl Arguments {
    /// Those of the process.
    ///
    /// # Panics
    /// Where they are wrong.
    pub fn given() -> Self {
        let mut given = std::env::args().skip(1);
        let half = match given.next().as_deref() {
            Some("work") => Half::Work,
            Some("judgement") => Half::Judgement,
            other => panic!("work or judgement, not {other:?}"),
        };
        let mut all = Self::of(half);
        while let Some(flag) = given.next() {
            let value = given.next().unwrap_or_else(|| panic!("{flag} needs a value"));
            all.set(&flag, &value);
        }
        all
    }

    fn of(half: Half) -> Self {
        Self {
            half,
            only: Vec::new(),
            ship: None,
            seeds: 1,
            sizes: vec![1.0],
            limits: Vec::new(),
            winds: Vec::new(),
            clean_sets: 0,
            changes: false,
            drawn: Vec::new(),
            hull: Hull::default(),
            program: None,
            clean_trials: 12,
            models: None,
            jobs: 1,
        }
    }

    fn set(&mut self, flag: &str, value: &str) {
        let listed = || value.split(',').map(str::to_owned).collect::<Vec<_>>();
        let share = |text: &String| text.parse::<f64>().expect("a number");
        let shares = || listed().iter().map(share).collect::<Vec<f64>>();
        match flag {
            "--only" => self.only = listed(),
            "--ship" => self.ship = Some(value.to_owned()),
            "--seeds" => self.seeds = value.parse().expect("a number of seeds"),
            "--sizes" => self.sizes = shares(),
            "--limits" => self.limits = shares(),
            "--winds" => self.winds = shares(),
            "--clean-sets" => self.clean_sets = value.parse().expect("a number of sets"),
            "--changes" => self.changes = value == "true",
            "--drawn" => {
                let number = |text: &String| text.parse().expect("a number that draws a ship");
                self.drawn = listed().iter().map(number).collect();
            }
            "--hull" => self.hull = Hull::named(value).unwrap_or_else(|error| panic!("{error}")),
            "--program" => self.program = Some(value.into()),
            "--clean-trials" => {
                self.clean_trials = value.parse().expect("a number of trials");
            }
            "--models" => self.models = Some(value.into()),
            "--jobs" => self.jobs = value.parse().expect("a number of jobs"),
            _ => panic!("no flag {flag}"),
        }
    }

    /// Whether a case is asked for.
    pub fn has(&self, label: &str) -> bool {
        self.only.is_empty() || self.only.iter().any(|begin| label.starts_with(begin.as_str()))
    }
}
