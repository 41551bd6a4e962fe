//! What is asked for.

use std::path::PathBuf;

use sistership_tests::truth::family::Hull;

/// The first seed that is kept for judgement.
const JUDGEMENT: u64 = 1000;

/// A part of the benchmark.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// The plain call against every explicit one.
    Choice,
    /// Esso Osaka by the plain call alone, every file judged by a model made without it.
    ByFile,
    /// Errors over the number of trials.
    Learning,
    /// Errors with random candidates added.
    Candidates,
    /// Bands against the truth.
    Coverage,
}

impl Part {
    const ALL: [(&'static str, Self); 5] = [
        ("choice", Self::Choice),
        ("by-file", Self::ByFile),
        ("learning", Self::Learning),
        ("candidates", Self::Candidates),
        ("coverage", Self::Coverage),
    ];
}

/// The command line.
pub struct Arguments {
    part: Option<Part>,
    /// Synthetic ships.
    pub ships: u64,
    /// The first of their seeds, which also seeds the instruments.
    pub seed: u64,
    /// Their kind.
    pub hull: Hull,
    /// One data set of `choice`.
    pub data: Option<String>,
    /// The program that is judged; this tree's where absent.
    pub program: Option<PathBuf>,
    /// Calls at once, where no time is measured.
    pub jobs: usize,
    /// Whether `learning` leaves the fixed choices out.
    pub alone: bool,
    /// After which a call is given up, s.
    pub limit_s: f64,
}

impl Arguments {
    /// Those of the process.
    ///
    /// # Panics
    /// Where they are wrong.
    pub fn given() -> Self {
        let mut arguments = Self::default();
        let mut given = std::env::args().skip(1);
        while let Some(word) = given.next() {
            if !word.starts_with("--") {
                arguments.part = part(&word);
                continue;
            }
            let value = given.next().unwrap_or_else(|| panic!("{word} needs a value"));
            arguments.set(&word, value);
        }
        arguments
    }

    fn set(&mut self, flag: &str, value: String) {
        let number = || -> f64 {
            value.parse().unwrap_or_else(|_| panic!("{flag} needs a number, not {value}"))
        };
        match flag {
            "--ships" => self.ships = number() as u64,
            "--seed" => self.seed = number() as u64,
            "--jobs" => self.jobs = number() as usize,
            "--calls" => self.alone = value == "plain",
            "--limit" => self.limit_s = number(),
            "--hull" => self.hull = Hull::named(&value).unwrap_or_else(|error| panic!("{error}")),
            "--data" => self.data = Some(value),
            "--program" => self.program = Some(value.into()),
            _ => panic!(
                "there are --ships, --seed, --hull, --data, --calls, --program, --jobs and --limit, \
                 not {flag}"
            ),
        }
    }

    /// The parts that are run.
    pub fn parts(&self) -> Vec<Part> {
        let all = || Part::ALL.map(|(_, part)| part).to_vec();
        self.part.map_or_else(all, |part| vec![part])
    }

    /// The seeds of the synthetic ships.
    pub fn seeds(&self) -> Vec<u64> {
        (self.seed..self.seed + self.ships).collect()
    }

    /// One line about the half of the cases that is used.
    pub fn said(&self) -> String {
        let last = self.seed + self.ships.max(1) - 1;
        let half = match (self.seed < JUDGEMENT, last < JUDGEMENT) {
            (true, true) => "cases for work (seeds below 1000)",
            (false, _) => "cases for judgement (seeds from 1000 on)",
            (true, false) => "cases for work and for judgement MIXED: no judgement",
        };
        format!("seeds {} to {last}: {half}", self.seed)
    }
}

impl Default for Arguments {
    fn default() -> Self {
        Self {
            part: None,
            ships: 50,
            seed: JUDGEMENT,
            hull: Hull::default(),
            data: None,
            program: None,
            jobs: 1,
            alone: false,
            limit_s: 300.0,
        }
    }
}

/// Nothing for `all`.
fn part(word: &str) -> Option<Part> {
    let named = Part::ALL.iter().find(|(name, _)| *name == word).map(|(_, part)| *part);
    assert!(
        named.is_some() || word == "all",
        "{word}: there are choice, learning, candidates, coverage, all"
    );
    named
}
