//! Configuration of a server.

use std::fmt;
use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use std::time::Duration;

use sistership_auth::openid::ProviderSettings as OpenIdSettings;
pub use sistership_jobs::leases::LeaseSettings;
use sistership_jobs::predictions::session::SessionLimits;
pub use sistership_jobs::webhooks::MailSettings;
use sistership_listener::TrustedProxies;
use sistership_store::ObjectsPlace;

use crate::start_error::StartError;

/// Default address and port.
pub const DEFAULT_LISTEN: SocketAddr =
    SocketAddr::new(std::net::IpAddr::V4(std::net::Ipv4Addr::LOCALHOST), 8080);

/// Time allowed for closing the store.
const CLOSE_TIME: Duration = Duration::from_secs(5);

/// Configuration of a server.
#[derive(Clone)]
pub struct Config {
    /// Address and port; port 0 takes a free one. An address other than loopback needs an API key
    /// or accounts.
    pub listen: SocketAddr,
    /// `sqlite://path/file.db` or `postgres://...`.
    pub database_url: String,
    /// Folder of uploads in progress; created if it does not exist.
    pub data_dir: PathBuf,
    /// Location of the samples; by default in the data folder.
    pub objects: ObjectsPlace,
    /// Key that every request must present as `Authorization: Bearer KEY`, if one is set.
    pub api_key: Option<String>,
    /// True if people sign in by name and password; every request then needs a session or a key.
    pub accounts: bool,
    /// OpenID provider at which people may sign in as well.
    pub openid: Option<OpenIdSettings>,
    /// SMTP server by which events are mailed.
    pub mail: Option<MailSettings>,
    /// Proxies whose statement of a client's address is trusted.
    pub proxies: TrustedProxies,
    /// Limits on requests and on resources.
    pub limits: Limits,
    /// Timing of the leases by which workers hold jobs.
    pub leases: LeaseSettings,
    /// Number of jobs that this process runs at a time, and one small one besides; 0 leaves them to
    /// other processes.
    pub workers: usize,
}

/// Limits on requests and on resources.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limits {
    /// Size of a JSON or YAML document, bytes.
    pub document_bytes: usize,
    /// Size of an upload of trials, bytes.
    pub upload_bytes: usize,
    /// Number of files in one upload.
    pub upload_files: usize,
    /// Time until the head of a request must have been read.
    pub header_time: Duration,
    /// Time until a request must have been answered.
    pub request_time: Duration,
    /// Time until an upload, or a derivation of a version again, must have been answered.
    pub long_request_time: Duration,
    /// Number of connections at a time; if all of them are in use, further ones are refused.
    pub connections: usize,
    /// Number of connections of one address at a time (for IPv6: of a network of 64 bits).
    pub connections_per_address: usize,
    /// Bytes a second, on average, that a request's body must bring and a reader of an answer must
    /// take. Far below any link in use: a satellite terminal for ships has 2400 bit/s and more.
    pub least_rate: usize,
    /// Time without a byte of a body after which it is given up; a body that comes faster than it
    /// must earns more time, up to a minute.
    pub body_grace: Duration,
    /// The same time for answers. Longer, as the system reports what was read in steps of tens of
    /// kilobytes.
    pub answer_grace: Duration,
    /// Number of samples of a predicted track.
    pub prediction_samples: usize,
    /// Limits on simulation sessions.
    pub sessions: SessionLimits,
    /// Number of trials of one refinement.
    pub refinement_trials: usize,
    /// Number of jobs of one person that wait or run at a time.
    pub jobs_per_person: u32,
    /// Time that a stopping server waits for work in progress.
    pub stop_time: Duration,
    /// Size of a YAML document, bytes: its tree is nearly a hundred times as large, see
    /// `sistership_web_support::payload`.
    pub yaml_bytes: usize,
    /// Memory of all requests together, bytes.
    pub request_memory: u64,
    /// Memory of all jobs together, bytes.
    pub job_memory: u64,
    /// Time that a request waits for memory that others hold.
    pub memory_wait: Duration,
    /// True if webhooks may lead into private networks and use plain http.
    pub webhooks_private: bool,
}

impl Config {
    /// Returns the configuration of a server on the loopback interface with an SQLite database in
    /// `data_dir`.
    pub fn new(data_dir: impl Into<PathBuf>) -> Self {
        let data_dir = data_dir.into();
        Self {
            listen: DEFAULT_LISTEN,
            database_url: sqlite_url(&data_dir),
            objects: ObjectsPlace::Folder(data_dir.clone()),
            data_dir,
            api_key: None,
            accounts: false,
            openid: None,
            mail: None,
            proxies: TrustedProxies::default(),
            limits: Limits::default(),
            leases: LeaseSettings::default(),
            workers: 1,
        }
    }

    /// Checks the settings that can be checked without starting.
    ///
    /// # Errors
    /// Returns an error that names the wrong setting and how to correct it.
    pub fn check(&self) -> Result<(), StartError> {
        // Without key or accounts, anyone who reaches the address may change what the server holds.
        match &self.api_key {
            None if !self.accounts && !self.listen.ip().is_loopback() => {
                Err(StartError::OpenWithoutKey(self.listen))
            }
            Some(key) if key.is_empty() || !key.bytes().all(|byte| byte.is_ascii_graphic()) => {
                Err(StartError::Key)
            }
            _ if self.openid.is_some() && !self.accounts => Err(StartError::OpenIdWithoutAccounts),
            // A heartbeat that comes later than the lease ends would lose every job.
            _ if self.leases.beat >= self.leases.lease => Err(StartError::Leases),
            // The limit of one address is at most that of all.
            _ if !(1..=self.limits.connections).contains(&self.limits.connections_per_address) => {
                Err(StartError::Connections)
            }
            _ => Ok(()),
        }
    }

    /// Time within which a stopping process has ended in any case: the time for jobs to finish, the
    /// time for jobs and requests to break off, and the time to close the store.
    pub fn stop_deadline(&self) -> Duration {
        self.leases.drain + self.limits.stop_time + CLOSE_TIME
    }
}

/// Returns the URL of the SQLite database of a data folder.
pub fn sqlite_url(data_dir: &Path) -> String {
    format!("sqlite://{}", data_dir.join("sistership.db").display())
}

impl fmt::Debug for Config {
    /// Omits the key, and the database's URL, which may hold a password.
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let key = self.api_key.as_ref().map(|_| "set");
        out.debug_struct("Config")
            .field("listen", &self.listen)
            .field("data_dir", &self.data_dir)
            .field("api_key", &key)
            .field("limits", &self.limits)
            .finish_non_exhaustive()
    }
}

impl Limits {
    /// Limits of the connections.
    pub(crate) fn connection_limits(&self) -> sistership_listener::ConnectionLimits {
        let Self {
            header_time,
            connections,
            connections_per_address,
            least_rate,
            body_grace,
            answer_grace,
            stop_time,
            ..
        } = *self;
        sistership_listener::ConnectionLimits {
            header_time,
            connections,
            connections_per_address,
            least_rate,
            body_grace,
            answer_grace,
            stop_time,
        }
    }
}

impl Default for Limits {
    fn default() -> Self {
        // One source for the defaults of the listener.
        let connections = sistership_listener::ConnectionLimits::default();
        Self {
            document_bytes: 4 << 20,
            upload_bytes: 256 << 20,
            upload_files: 1000,
            header_time: connections.header_time,
            request_time: Duration::from_secs(60),
            long_request_time: Duration::from_secs(600),
            connections: connections.connections,
            connections_per_address: connections.connections_per_address,
            least_rate: connections.least_rate,
            body_grace: connections.body_grace,
            answer_grace: connections.answer_grace,
            prediction_samples: 200_000,
            sessions: SessionLimits::default(),
            refinement_trials: 1000,
            jobs_per_person: 1000,
            stop_time: connections.stop_time,
            yaml_bytes: 1 << 20,
            request_memory: 256 << 20,
            job_memory: 1 << 30,
            memory_wait: Duration::from_secs(5),
            webhooks_private: false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn another_address_needs_a_key() {
        let mut config = Config::new("data");
        assert!(config.check().is_ok());
        config.listen.set_ip([0, 0, 0, 0].into());
        let message = config.check().err().map(|error| error.to_string()).unwrap_or_default();
        assert!(message.contains("API key") && message.contains("127.0.0.1"), "{message}");
        config.api_key = Some("secret".into());
        assert!(config.check().is_ok());
        assert!(!format!("{config:?}").contains("secret"));
        config.api_key = Some("two words".into());
        assert!(matches!(config.check(), Err(StartError::Key)));
    }
}
