//! Location of the store: flags and environment variables.

use std::path::{Path, PathBuf};

use clap::Args;
use sistership_jobs::Archive;
use sistership_store::{Actor, ObjectsPlace};

use super::config_file::{self, ConfigFile};
use crate::failure::Failure;

/// Default data folder.
const DATA_DIR: &str = "sistership-data";

/// Location of the store, from flags and environment.
#[derive(Debug, Default, Args)]
pub struct StoreArguments {
    /// YAML file of settings with the names of the flags; flags and environment variables override
    /// it.
    #[arg(long, global = true, value_name = "FILE", env = "SISTERSHIP_CONFIG")]
    config: Option<PathBuf>,
    /// Database URL, `sqlite://path/file.db` or `postgres://...`; by default sistership.db in the
    /// data folder.
    #[arg(
        long,
        global = true,
        value_name = "URL",
        env = "SISTERSHIP_DATABASE_URL",
        hide_env_values = true
    )]
    database_url: Option<String>,
    /// Folder of trial samples, unfinished uploads and the embedded database [default:
    /// sistership-data].
    #[arg(long, global = true, value_name = "DIR", env = "SISTERSHIP_DATA_DIR")]
    data_dir: Option<PathBuf>,
    /// Store trial samples in a bucket, `s3://bucket/prefix`, with the credentials in
    /// AWS_ACCESS_KEY_ID and AWS_SECRET_ACCESS_KEY or of the role of the machine.
    #[arg(long, global = true, value_name = "URL", env = "SISTERSHIP_OBJECTS_URL")]
    objects_url: Option<String>,
    /// URL of the S3-compatible server, such as http://host:9000; by default Amazon S3.
    #[arg(long, global = true, value_name = "URL", env = "SISTERSHIP_OBJECTS_ENDPOINT")]
    objects_endpoint: Option<String>,
    /// Region of the bucket [default: AWS_REGION, else us-east-1].
    #[arg(long, global = true, value_name = "NAME", env = "SISTERSHIP_OBJECTS_REGION")]
    objects_region: Option<String>,
}

/// Location of the store.
#[derive(Debug)]
pub struct StorePlace {
    /// The database's URL.
    pub database_url: String,
    /// Folder of unfinished uploads, and of files without another place.
    pub data_dir: PathBuf,
    /// Place of the samples.
    pub objects: ObjectsPlace,
}

impl StoreArguments {
    /// Reads the configuration file; empty if none is named.
    ///
    /// # Errors
    /// Returns an error if the file cannot be parsed.
    pub fn read_config(&self) -> Result<ConfigFile, Failure> {
        config_file::read_config(self.config.as_deref())
    }

    /// Returns the location of the store by the flags and the file.
    ///
    /// # Errors
    /// Returns an error if the place of the samples is not valid.
    pub fn resolve_place(&self, file: &ConfigFile) -> Result<StorePlace, Failure> {
        let data_dir = self
            .data_dir
            .as_ref()
            .or(file.data_dir.as_ref())
            .map_or(Path::new(DATA_DIR), PathBuf::as_path);
        let url = self.database_url.as_ref().or(file.database_url.as_ref());
        let database_url = url.cloned().unwrap_or_else(|| sistership_api::sqlite_url(data_dir));
        Ok(StorePlace {
            database_url,
            objects: self.objects_place(file, data_dir)?,
            data_dir: data_dir.to_path_buf(),
        })
    }

    fn objects_place(&self, file: &ConfigFile, data_dir: &Path) -> Result<ObjectsPlace, Failure> {
        let endpoint = self.objects_endpoint.clone().or_else(|| file.objects_endpoint.clone());
        let region = self.objects_region.clone().or_else(|| file.objects_region.clone());
        match self.objects_url.as_ref().or(file.objects_url.as_ref()) {
            Some(url) => ObjectsPlace::parse_s3(url, endpoint, region)
                .map_err(|error| Failure::Call(error.to_string())),
            None if endpoint.is_some() => Err(Failure::Call(
                "objects_endpoint: the bucket is missing; add objects_url".into(),
            )),
            None => Ok(ObjectsPlace::Folder(data_dir.to_path_buf())),
        }
    }
}

impl StoreArguments {
    /// True if a store is named, or if one exists at the default place.
    pub fn exists(&self) -> bool {
        let place = self.read_config().and_then(|file| self.resolve_place(&file));
        self.is_named() || place.is_ok_and(|place| place.check_exists().is_ok())
    }

    /// True if a store is named.
    pub fn is_named(&self) -> bool {
        self.database_url.is_some() || self.data_dir.is_some() || self.config.is_some()
    }
}

impl StorePlace {
    /// Checks that the store exists: opening a missing one would create it.
    ///
    /// # Errors
    /// Returns an error that names the missing file or folder.
    pub fn check_exists(&self) -> Result<(), Failure> {
        if let Some(file) = sqlite_file(&self.database_url).filter(|file| !file.is_file()) {
            return Err(Failure::Refused(format!(
                "there is no database {}; give its place with --database-url or --data-dir",
                file.display()
            )));
        }
        match self.objects.folder_path().filter(|folder| !folder.is_dir()) {
            Some(folder) => Err(Failure::Refused(format!(
                "there is no data folder {}; give its place with --data-dir",
                folder.display()
            ))),
            None => Ok(()),
        }
    }
}

/// Returns the file of an SQLite URL; `None` for another database.
fn sqlite_file(url: &str) -> Option<&Path> {
    let rest = url.strip_prefix("sqlite:")?;
    let path = rest.strip_prefix("//").unwrap_or(rest);
    Some(Path::new(path.split_once('?').map_or(path, |(path, _)| path)))
}

/// Runs `work` on an existing store, and closes it.
///
/// # Errors
/// Returns an error if the store does not exist or cannot be opened, or the error of `work`.
pub fn with_archive<T, E: std::fmt::Display>(
    store: &StoreArguments,
    work: impl AsyncFnOnce(&Archive) -> Result<T, E>,
) -> Result<T, Failure> {
    let place = store.resolve_place(&store.read_config()?)?;
    place.check_exists()?;
    block_on(async {
        let archive = Archive::open_at(&place.database_url, &place.objects).await;
        let archive =
            archive.map_err(|error| Failure::Refused(format!("cannot open the store: {error}")))?;
        // Every change is entered into the audit in the name of the command line.
        let done = Actor::command_line().run_scoped(work(&archive)).await;
        // Also after an error, so that the store is left closed.
        archive.store.close().await;
        done.map_err(|error| Failure::Refused(error.to_string()))
    })
}

/// Runs asynchronous work to its end.
///
/// # Errors
/// Returns the error of the work, or an error if no threads can be started.
pub fn block_on<T>(work: impl Future<Output = Result<T, Failure>>) -> Result<T, Failure> {
    new_runtime()?.block_on(work)
}

/// Creates the threads of asynchronous work.
///
/// # Errors
/// Returns an error if no threads can be started.
pub fn new_runtime() -> Result<tokio::runtime::Runtime, Failure> {
    let runtime = tokio::runtime::Builder::new_multi_thread().enable_all().build();
    runtime.map_err(|error| Failure::Refused(format!("threads cannot be started: {error}")))
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
        let arguments = StoreArguments {
            data_dir: Some("/nowhere/at/all".into()),
            ..StoreArguments::default()
        };
        let Ok(place) = arguments.resolve_place(&ConfigFile::default()) else { panic!("a place") };
        assert!(place.check_exists().is_err_and(|failure| {
            failure.message().is_some_and(|m| m.contains("there is no database"))
        }));
        assert!(!Path::new("/nowhere").exists());
    }

    #[test]
    fn samples_may_be_in_a_bucket() {
        let place = |url: Option<&str>, endpoint: Option<&str>| {
            let file = ConfigFile { objects_url: url.map(str::to_owned), ..ConfigFile::default() };
            let arguments = StoreArguments {
                objects_endpoint: endpoint.map(str::to_owned),
                ..StoreArguments::default()
            };
            arguments.resolve_place(&file).map(|place| place.objects.to_string())
        };
        assert_eq!(place(None, None), Ok("sistership-data".to_owned()));
        assert_eq!(
            place(Some("s3://samples/fleet"), Some("http://localhost:9000")),
            Ok("s3://samples/fleet".to_owned())
        );
        for (url, endpoint, field) in
            [(Some("samples"), None, "objects_url"), (None, Some("http://a"), "objects_endpoint")]
        {
            assert!(
                place(url, endpoint)
                    .is_err_and(|failure| failure.message().is_some_and(|m| m.starts_with(field)))
            );
        }
    }
}
