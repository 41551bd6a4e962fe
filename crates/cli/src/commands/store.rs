//! Where the store is: flags and environment that `serve` and `verify` share.

use std::path::{Path, PathBuf};

use clap::Args;
use sistership_server::Archive;

use crate::failure::Failure;

/// Where the store is.
#[derive(Debug, Args)]
pub struct StoreArguments {
    /// `sqlite://path/file.db` or `postgres://...`; the file sistership.db in the data folder where absent.
    #[arg(long, value_name = "URL", env = "SISTERSHIP_DATABASE_URL", hide_env_values = true)]
    pub database_url: Option<String>,
    /// Folder of trial samples, and of the embedded database.
    #[arg(long, value_name = "DIR", env = "SISTERSHIP_DATA_DIR", default_value = "sistership-data")]
    pub data_dir: PathBuf,
}

impl StoreArguments {
    /// The database's URL.
    pub fn url(&self) -> String {
        self.database_url.clone().unwrap_or_else(|| sistership_server::sqlite_url(&self.data_dir))
    }

    /// Makes sure that there is a store: opening one that is not there would make it.
    ///
    /// # Errors
    /// Names the file or folder that is missing.
    pub fn must_exist(&self) -> Result<(), Failure> {
        let url = self.url();
        if let Some(file) = sqlite_file(&url).filter(|file| !file.is_file()) {
            return Err(Failure::Refused(format!(
                "there is no database {}; name it with --database-url or --data-dir",
                file.display()
            )));
        }
        if self.data_dir.is_dir() {
            return Ok(());
        }
        Err(Failure::Refused(format!("there is no data folder {}; name it with --data-dir", self.data_dir.display())))
    }
}

/// The file of an SQLite URL; none for another database.
fn sqlite_file(url: &str) -> Option<&Path> {
    let rest = url.strip_prefix("sqlite:")?;
    let path = rest.strip_prefix("//").unwrap_or(rest);
    Some(Path::new(path.split_once('?').map_or(path, |(path, _)| path)))
}

/// Does something with a store that is there, and closes it.
///
/// # Errors
/// The store is not there or cannot be opened, or what is done with it fails.
pub fn with_archive<T, E: std::fmt::Display>(
    store: &StoreArguments,
    work: impl AsyncFnOnce(&Archive) -> Result<T, E>,
) -> Result<T, Failure> {
    store.must_exist()?;
    block_on(async {
        let archive = Archive::open(&store.url(), &store.data_dir).await;
        let archive = archive.map_err(|error| Failure::Refused(format!("cannot open the store: {error}")))?;
        let done = work(&archive).await;
        archive.store.close().await;
        done.map_err(|error| Failure::Refused(error.to_string()))
    })
}

/// Runs asynchronous work to its end.
///
/// # Errors
/// The work's own, or that no threads can be had.
pub fn block_on<T>(work: impl Future<Output = Result<T, Failure>>) -> Result<T, Failure> {
    let runtime = tokio::runtime::Builder::new_multi_thread().enable_all().build();
    runtime.map_err(|error| Failure::Refused(format!("no threads: {error}")))?.block_on(work)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_file_of_a_url_is_found() {
        let file = |url| sqlite_file(url).map(|path| path.display().to_string());
        assert_eq!(file("sqlite:///var/a.db?mode=rwc").as_deref(), Some("/var/a.db"));
        assert_eq!(file("sqlite:a.db").as_deref(), Some("a.db"));
        assert_eq!(file("postgres://host/a"), None);
    }

    #[test]
    fn a_store_that_is_not_there_is_not_made() {
        let arguments = StoreArguments { database_url: None, data_dir: "/nowhere/at/all".into() };
        assert!(
            arguments.must_exist().is_err_and(|failure| failure.message().is_some_and(|m| m.contains("there is no database")))
        );
        assert!(!Path::new("/nowhere").exists());
    }
}
