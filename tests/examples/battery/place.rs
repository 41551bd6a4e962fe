//! A store to be attacked: a database, a folder, and the program's commands on both.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde_json::Value;
use sistership_store::testing::TestDatabase;

use crate::attack::Failure;
use crate::faults::{Control, Faults};
use crate::process::{Server, Start};
use crate::tally::Tally;

/// A kind of database.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Database {
    /// In a file.
    Sqlite,
    /// On a private server.
    Postgres,
}

impl Database {
    /// Its name in the table.
    pub fn name(self) -> &'static str {
        match self {
            Self::Sqlite => "sqlite",
            Self::Postgres => "postgres",
        }
    }

    /// An empty one.
    ///
    /// # Errors
    /// PostgreSQL is not installed.
    pub async fn empty(self) -> Result<TestDatabase, Failure> {
        match self {
            Self::Sqlite => Ok(TestDatabase::new_sqlite()),
            Self::Postgres => {
                Ok(TestDatabase::new_postgres().await.ok_or("PostgreSQL is not installed")?)
            }
        }
    }
}

/// A store to be attacked.
pub struct Place {
    /// Its database and its own folder.
    pub database: TestDatabase,
    /// The data folder.
    pub data: PathBuf,
    /// Where it counts.
    pub tally: Arc<Tally>,
    /// The URL of the database: its own, or that of a gate before it.
    pub url: String,
    /// Arguments that name a bucket; empty for objects in the data folder.
    pub objects: Vec<OsString>,
    /// The environment of every process.
    pub environment: Vec<(&'static str, &'static str)>,
}

/// What a command of the program came to.
pub struct Outcome {
    /// Its exit status; none where a signal ended it.
    pub status: Option<i32>,
    /// Its output, where that is JSON.
    pub json: Value,
    /// Its errors.
    pub errors: String,
}

impl Place {
    /// An empty store.
    ///
    /// # Errors
    /// There is no such database here.
    pub async fn new(database: Database, tally: Arc<Tally>) -> Result<Self, Failure> {
        Ok(Self::of(database.empty().await?, tally))
    }

    /// A store on a database, with its data in the database's folder.
    pub fn of(database: TestDatabase, tally: Arc<Tally>) -> Self {
        let data = database.folder.path().join("data");
        let url = database.url.clone();
        Self { database, data, tally, url, objects: Vec::new(), environment: Vec::new() }
    }

    /// A folder that goes with the store.
    pub fn folder(&self) -> &Path {
        self.database.folder.path()
    }

    /// How a server of it is started.
    pub fn start(&self) -> Start {
        Start::new(self.store_arguments(), self.folder().to_owned(), Arc::clone(&self.tally))
            .environment(self.environment.iter().copied())
    }

    /// A server of it that leaves jobs alone.
    ///
    /// # Errors
    /// It does not start.
    pub async fn serve(&self) -> Result<Server, Failure> {
        self.start().argument("--no-worker").server().await
    }

    /// A server that leaves jobs alone, under faults that strike nothing yet.
    ///
    /// # Errors
    /// It does not start.
    pub async fn serve_under(&self, faults: &Faults, control: &Control) -> Result<Server, Failure> {
        self.start().argument("--no-worker").environment(control.environment(faults)).server().await
    }

    /// Arguments by which any command opens it.
    pub fn store_arguments(&self) -> Vec<OsString> {
        let url = self.url.clone().into();
        let store = ["--database-url".into(), url, "--data-dir".into(), self.data.clone().into()];
        store.into_iter().chain(self.objects.iter().cloned()).collect()
    }

    /// Runs a command on it to its end.
    ///
    /// # Errors
    /// It cannot be started.
    pub async fn command(&self, words: &[&str]) -> Result<Outcome, Failure> {
        let mut command = tokio::process::Command::new(crate::process::program());
        command.args(words).arg("--json").args(self.store_arguments()).env_remove("SISTERSHIP_ZOO");
        command.envs(self.environment.iter().copied());
        let output = command.kill_on_drop(true).output().await?;
        let json = serde_json::from_slice(&output.stdout).unwrap_or(Value::Null);
        let errors = String::from_utf8_lossy(&output.stderr).trim().to_owned();
        if output.status.code().is_none() {
            self.tally.aborted(format!(
                "sistership {}: {}: {errors}",
                words.join(" "),
                output.status
            ));
        }
        Ok(Outcome { status: output.status.code(), json, errors })
    }

    /// Counts every fault that `fsck` finds as wrong. Leftovers of kills, of which it says that
    /// `gc` removes them, are none.
    ///
    /// # Errors
    /// It cannot be started.
    pub async fn check(&self, when: &str) -> Result<(), Failure> {
        let found = self.command(&["fsck"]).await?;
        if found.status != Some(0) {
            let faults = found.json["faults"].to_string();
            self.tally.wrong(format!(
                "fsck {when}: status {:?}: {faults} {}",
                found.status, found.errors
            ));
        }
        Ok(())
    }

    /// Files of uploads under way: there are none where no server runs, but for those of a kill.
    pub fn uploads_under_way(&self) -> Vec<PathBuf> {
        // Each process has a folder of its own among them.
        let entries = |folder: PathBuf| {
            std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path())
        };
        entries(self.data.join("uploads")).flat_map(entries).collect()
    }
}
