//! The command line.

use std::path::PathBuf;

use crate::attack::Attack;
use crate::place::Database;

/// What the battery is told.
pub struct Arguments {
    /// Minutes for each database, divided among the attacks.
    pub minutes: f64,
    /// The databases, one after the other.
    pub databases: Vec<Database>,
    /// What every random choice follows from.
    pub seed: u64,
    /// Another program than the one of this tree.
    pub program: Option<PathBuf>,
    /// The memory budget of requests, MB.
    pub requests_mb: u64,
    /// The memory budget of jobs, MB.
    pub jobs_mb: u64,
    only: Vec<String>,
}

const USAGE: &str = "[--minutes N] [--database sqlite|postgres|both] [--seed S] [--only \
    ATTACK,...] [--program PATH] [--requests-mb MB] [--jobs-mb MB]";

impl Arguments {
    /// Reads them.
    ///
    /// # Errors
    /// Says which is wrong.
    pub fn read(mut words: impl Iterator<Item = String>) -> Result<Self, String> {
        let mut read = Self {
            minutes: 1.0,
            databases: vec![Database::Sqlite, Database::Postgres],
            seed: 1,
            program: None,
            requests_mb: 256,
            jobs_mb: 256,
            only: Vec::new(),
        };
        while let Some(flag) = words.next() {
            let value =
                words.next().ok_or_else(|| format!("{flag} needs a value; there are {USAGE}"))?;
            read.set(&flag, &value)?;
        }
        Ok(read)
    }

    /// Whether an attack was asked for.
    pub fn takes(&self, attack: &dyn Attack) -> bool {
        match self.only.is_empty() {
            true => self.minutes >= attack.least_minutes(),
            false => self.only.iter().any(|name| name == attack.name()),
        }
    }

    fn set(&mut self, flag: &str, value: &str) -> Result<(), String> {
        let wrong = |what: &str| format!("{flag} {value}: {what}");
        let number = || value.parse().map_err(|_| wrong("give a whole number"));
        match flag {
            "--minutes" => {
                let minutes = value.parse().ok().filter(|minutes| (0.0..=1e4).contains(minutes));
                self.minutes = minutes.ok_or_else(|| wrong("give minutes, such as 0.5"))?;
            }
            "--database" => {
                self.databases =
                    databases(value).ok_or_else(|| wrong("there are sqlite, postgres, both"))?
            }
            "--seed" => self.seed = number()?,
            "--requests-mb" => self.requests_mb = number()?,
            "--jobs-mb" => self.jobs_mb = number()?,
            "--program" => self.program = Some(value.into()),
            "--only" => self.only = names(value)?,
            _ => return Err(format!("there is no {flag}; there are {USAGE}")),
        }
        Ok(())
    }
}

fn databases(value: &str) -> Option<Vec<Database>> {
    match value {
        "sqlite" => Some(vec![Database::Sqlite]),
        "postgres" => Some(vec![Database::Postgres]),
        "both" => Some(vec![Database::Sqlite, Database::Postgres]),
        _ => None,
    }
}

fn names(value: &str) -> Result<Vec<String>, String> {
    let known: Vec<_> = crate::attacks::all().iter().map(|attack| attack.name()).collect();
    let names: Vec<String> = value.split(',').map(str::to_owned).collect();
    match names.iter().find(|name| !known.contains(&name.as_str())) {
        Some(name) => {
            Err(format!("--only: there is no attack {name}; there are {}", known.join(", ")))
        }
        None => Ok(names),
    }
}
