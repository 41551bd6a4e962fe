//! Where the store is: flags and environment that `serve` and `verify` share.

use std::path::{Path, PathBuf};

use clap::Args;
use sistership_server::Archive;

use super::config_file::{self, ConfigFile};
use crate::failure::Failure;

/// The data folder when nobody says otherwise.
const DATA_DIR: &str = "sistership-data";

/// Where the store is, as it is told.
#[derive(Debug, Args)]
pub struct StoreArguments {
    /// YAML file of settings, named as the flags are; flags and environment win over it.
    #[arg(long, value_name = "FILE", env = "SISTERSHIP_CONFIG")]
    config: Option<PathBuf>,
    /// `sqlite://path/file.db` or `postgres://...`; the file sistership.db in the data folder where absent.
    #[arg(long, value_name = "URL", env = "SISTERSHIP_DATABASE_URL", hide_env_values = true)]
    database_url: Option<String>,
    /// Folder of trial samples, and of the embedded database [default: sistership-data].
    #[arg(long, value_name = "DIR", env = "SISTERSHIP_DATA_DIR")]
    data_dir: Option<PathBuf>,
}

/// Where the store is.
#[derive(Debug)]
pub struct StorePlace {
    /// The database's URL.
    pub database_url: String,
    /// The folder of samples.
    pub data_dir: PathBuf,
}

impl StoreArguments {
    /// The configuration file, or an empty one where none is named.
    ///
    /// # Errors
    /// It does not read.
    pub fn file(&self) -> Result<ConfigFile, Failure> {
        config_file::read(self.config.as_deref())
    }

    /// Where they and the file say that the store is.
    pub fn place(&self, file: &ConfigFile) -> StorePlace {
        let data_dir = self.data_dir.as_ref().or(file.data_dir.as_ref()).map_or(Path::new(DATA_DIR), PathBuf::as_path);
        let url = self.database_url.as_ref().or(file.database_url.as_ref());
        let database_url = url.cloned().unwrap_or_else(|| sistership_server::sqlite_url(data_dir));
        StorePlace { database_url, data_dir: data_dir.to_path_buf() }
    }
}

impl StorePlace {
    /// Makes sure that there is a store: opening one that is not there would make it.
    ///
    /// # Errors
    /// Names the file or folder that is missing.
    pub fn must_exist(&self) -> Result<(), Failure> {
        if let Some(file) = sqlite_file(&self.database_url).filter(|file| !file.is_file()) {
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
    let place = store.place(&store.file()?);
    place.must_exist()?;
    block_on(async {
        let archive = Archive::open(&place.database_url, &place.data_dir).await;
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
        let arguments = StoreArguments { config: None, database_url: None, data_dir: Some("/nowhere/at/all".into()) };
        let place = arguments.place(&ConfigFile::default());
        assert!(place.must_exist().is_err_and(|failure| failure.message().is_some_and(|m| m.contains("there is no database"))));
        assert!(!Path::new("/nowhere").exists());
    }
}
