//! Configuration file, which can replace the flags of `serve`, `work` and the commands on a store.

use std::net::SocketAddr;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use sistership_auth::openid::OpenIdArguments;

use super::log_format::LogFormat;
use crate::failure::{Failure, about_file};
use crate::zoo::read_text_file;

/// Settings of a file; each has the name and the meaning of a flag.
#[derive(Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ConfigFile {
    /// `--listen`
    pub listen: Option<SocketAddr>,
    /// `--database-url`
    pub database_url: Option<String>,
    /// `--data-dir`
    pub data_dir: Option<PathBuf>,
    /// `--objects-url`
    pub objects_url: Option<String>,
    /// `--objects-endpoint`
    pub objects_endpoint: Option<String>,
    /// `--objects-region`
    pub objects_region: Option<String>,
    /// `--api-key-file`
    pub api_key_file: Option<PathBuf>,
    /// `--accounts`
    pub accounts: Option<bool>,
    /// `--oidc-...`, without `oidc-`
    #[serde(default)]
    pub oidc: OpenIdArguments,
    /// `--smtp-url-file`
    pub smtp_url_file: Option<PathBuf>,
    /// `--mail-from`
    pub mail_from: Option<String>,
    /// `--workers`
    pub workers: Option<u16>,
    /// `--jobs-per-person`
    pub jobs_per_person: Option<u32>,
    /// `--connections`
    pub connections: Option<u32>,
    /// `--connections-per-address`
    pub connections_per_address: Option<u32>,
    /// `--trusted-proxy`, all of them
    pub trusted_proxies: Option<Vec<String>>,
    /// `--forwarded-header`
    pub forwarded_header: Option<String>,
    /// `--lease-s`
    pub lease_s: Option<f64>,
    /// `--drain-s`
    pub drain_s: Option<f64>,
    /// `--request-memory-mb`
    pub request_memory_mb: Option<u64>,
    /// `--job-memory-mb`
    pub job_memory_mb: Option<u64>,
    /// `--log`
    pub log: Option<String>,
    /// `--log-format`
    pub log_format: Option<LogFormat>,
    /// `--otlp-endpoint`
    pub otlp_endpoint: Option<String>,
}

/// Reads a file, if one is named. Relative paths in it start at its folder.
///
/// # Errors
/// Returns an error that names file, line and setting.
pub fn read_config(path: Option<&Path>) -> Result<ConfigFile, Failure> {
    let Some(path) = path else { return Ok(ConfigFile::default()) };
    let text = read_text_file(path)?;
    // A file of comments only is valid, but no YAML mapping.
    if text.lines().all(|line| line.trim().is_empty() || line.trim_start().starts_with('#')) {
        return Ok(ConfigFile::default());
    }
    let mut file: ConfigFile =
        sistership_model::yaml::read_document(&text).map_err(|error| about_file(path, error))?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let secrets =
        [&mut file.api_key_file, &mut file.smtp_url_file, &mut file.oidc.client_secret_file];
    for relative in secrets.into_iter().chain([&mut file.data_dir]).flatten() {
        *relative = folder.join(&*relative);
    }
    Ok(file)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn read_text(text: &str) -> Result<ConfigFile, Failure> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("sistership.yaml");
        std::fs::write(&path, text).unwrap();
        read_config(Some(&path)).map(|mut file| {
            file.data_dir = file
                .data_dir
                .map(|data| data.strip_prefix(folder.path()).unwrap_or(&data).to_path_buf());
            file
        })
    }

    fn refusal(text: &str) -> String {
        read_text(text).unwrap_err().message().unwrap_or_default().to_owned()
    }

    #[test]
    fn settings_are_read_and_paths_start_at_the_file() {
        let file =
            read_text("listen: 127.0.0.1:9000\ndata_dir: data\nlease_s: 2\nlog_format: json\n")
                .unwrap();
        assert_eq!((file.listen.unwrap().port(), file.lease_s), (9000, Some(2.0)));
        assert_eq!(file.data_dir.unwrap(), Path::new("data"));
        assert_eq!(
            read_text("data_dir: /var/lib/x\n").unwrap().data_dir.unwrap(),
            Path::new("/var/lib/x")
        );
        assert_eq!(read_text("# nothing yet\n").unwrap(), ConfigFile::default());
    }

    #[test]
    fn what_is_wrong_is_named() {
        assert!(refusal("lisen: 127.0.0.1:9000\n").contains("lisen"));
        assert!(refusal("workers: 1\nlisten: nowhere\n").contains("line 2"));
        assert!(refusal("workers: 1\nworkers: 2\n").contains("workers"));
        assert!(read_config(Some(Path::new("/nowhere.yaml"))).is_err());
    }
}
