//! What is asked for.

use std::path::PathBuf;

use sistership_tests::truth::family::Hull;
use sistership_tests::truth::foreign::{JUDGEMENT, Kind};

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
    /// Ships that are foreign to the zoo, by the default call alone.
    Foreign,
    /// Bands against the truth of such ships.
    ForeignCoverage,
}

impl Part {
    const ALL: [(&'static str, Self); 7] = [
        ("choice", Self::Choice),
        ("by-file", Self::ByFile),
        ("learning", Self::Learning),
        ("candidates", Self::Candidates),
        ("coverage", Self::Coverage),
        ("foreign", Self::Foreign),
        ("foreign-coverage", Self::ForeignCoverage),
    ];

    /// Whether it asks for the cases of `foreign`.
    fn is_foreign(self) -> bool {
        matches!(self, Self::Foreign | Self::ForeignCoverage)
    }
}

/// Cases of `foreign`.
pub struct ForeignCases {
    /// Kinds of craft.
    pub kinds: Vec<Kind>,
    /// Seeds, the last excluded.
    pub seeds: std::ops::Range<u64>,
    /// Numbers of trials.
    pub counts: Vec<usize>,
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
    /// Cases of `foreign`.
    pub foreign: ForeignCases,
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
            "--kinds" => self.foreign.kinds = listed(&value, Kind::from_name),
            "--seeds" => self.foreign.seeds = range(&value),
            "--trials" => self.foreign.counts = listed(&value, count),
            _ => panic!(
                "there are --ships, --seed, --hull, --data, --calls, --program, --jobs, --limit, \
                 and for foreign --kinds, --seeds and --trials, not {flag}"
            ),
        }
    }

    /// The parts that are run.
    pub fn parts(&self) -> Vec<Part> {
        let plain = |part: &Part| !part.is_foreign();
        let all = || Part::ALL.map(|(_, part)| part).into_iter().filter(plain).collect();
        self.part.map_or_else(all, |part| vec![part])
    }

    /// The seeds of the synthetic ships.
    pub fn seeds(&self) -> Vec<u64> {
        (self.seed..self.seed + self.ships).collect()
    }

    /// One line about the half of the cases that is used.
    pub fn said(&self) -> String {
        let plain = self.seed..self.seed + self.ships;
        let seeds = if self.part.is_some_and(|part| part.is_foreign()) {
            &self.foreign.seeds
        } else {
            &plain
        };
        let (first, last) = (seeds.start, seeds.end.max(seeds.start + 1) - 1);
        let half = match (first < JUDGEMENT, last < JUDGEMENT) {
            (true, true) => "cases for work (seeds below 1000)",
            (false, _) => "cases for judgement (seeds from 1000 on)",
            (true, false) => "cases for work and for judgement MIXED: no judgement",
        };
        format!("seeds {first} to {last}: {half}")
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
            foreign: ForeignCases {
                kinds: Kind::ALL.to_vec(),
                seeds: 1..3,
                counts: vec![1, 2, 4, 8, 12],
            },
        }
    }
}

/// Nothing for `all`.
fn part(word: &str) -> Option<Part> {
    let named = Part::ALL.iter().find(|(name, _)| *name == word).map(|(_, part)| *part);
    assert!(
        named.is_some() || word == "all",
        "{word}: there are choice, by-file, learning, candidates, coverage, foreign, foreign-coverage, \
         all"
    );
    named
}

fn listed<T>(words: &str, read: impl Fn(&str) -> Result<T, String>) -> Vec<T> {
    words.split(',').map(|word| read(word).unwrap_or_else(|error| panic!("{error}"))).collect()
}

fn count(word: &str) -> Result<usize, String> {
    let number = word.parse().ok().filter(|count| (1..=12).contains(count));
    number.ok_or_else(|| format!("--trials needs numbers from 1 to 12, not {word}"))
}

fn range(words: &str) -> std::ops::Range<u64> {
    let limits = words.split_once("..");
    let read = |(first, end): (&str, &str)| Some(first.parse().ok()?..end.parse().ok()?);
    limits.and_then(read).unwrap_or_else(|| panic!("--seeds needs A..B, not {words}"))
}
