//! What a server is told before it starts.

use std::fmt;
use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use std::time::Duration;

use sistership_auth::openid::Settings as OpenIdSettings;
pub use sistership_jobs::leases::Leases;
use sistership_jobs::predictions::session::SessionLimits;
use sistership_listener::TrustedProxies;
use sistership_store::ObjectsPlace;

use crate::start_error::StartError;

/// Where the server listens when nobody says otherwise.
pub const DEFAULT_LISTEN: SocketAddr =
    SocketAddr::new(std::net::IpAddr::V4(std::net::Ipv4Addr::LOCALHOST), 8080);

/// What closing the store may take.
const CLOSING: Duration = Duration::from_secs(5);

/// What a server is told before it starts.
#[derive(Clone)]
pub struct Config {
    /// Address and port; port 0 takes a free one. Another address than loopback needs an API key,
    /// or accounts.
    pub listen: SocketAddr,
    /// `sqlite://path/file.db` or `postgres://...`.
    pub database_url: String,
    /// Folder of uploads under way; made if it is not there.
    pub data_dir: PathBuf,
    /// Where the samples are; in the data folder unless set.
    pub objects: ObjectsPlace,
    /// What every request must present as `Authorization: Bearer KEY`, if one is set.
    pub api_key: Option<String>,
    /// Whether people sign in by name and password, and nobody is let in without that or a key.
    pub accounts: bool,
    /// The OpenID provider at which people may sign in, too.
    pub openid: Option<OpenIdSettings>,
    /// The proxies whose word for a client's address is taken.
    pub proxies: TrustedProxies,
    /// Bounds on what is sent.
    pub limits: Limits,
    /// How workers hold their jobs.
    pub leases: Leases,
    /// Jobs that this process works on at a time; none leaves them to other processes.
    pub workers: usize,
}

/// Bounds on what is sent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limits {
    /// A JSON or YAML document, bytes.
    pub document_bytes: usize,
    /// An upload of trials, bytes.
    pub upload_bytes: usize,
    /// Files in one upload.
    pub upload_files: usize,
    /// Until a request's head has been read.
    pub header_time: Duration,
    /// Until a request has been answered.
    pub request_time: Duration,
    /// The same for uploads and for deriving a version again.
    pub long_request_time: Duration,
    /// Connections at a time; where they are all at work, further ones are refused.
    pub connections: usize,
    /// Connections of one address at a time (of IPv6: of a network of 64 bits).
    pub connections_per_address: usize,
    /// Bytes a second, on average, that a request's body must bring and a reader of an answer must
    /// take. Long below any link in use: a satellite terminal for ships has 2400 bit/s and more.
    pub least_rate: usize,
    /// Without a byte of a body until it is given up; what comes faster than it must earns more, up
    /// to a minute.
    pub body_grace: Duration,
    /// The same for answers. Longer, as the system tells of reading by tens of kilobytes.
    pub answer_grace: Duration,
    /// Samples of a predicted track.
    pub prediction_samples: usize,
    /// Ships under way.
    pub sessions: SessionLimits,
    /// Trials of one refinement.
    pub refinement_trials: usize,
    /// How long a server that is told to stop waits for what is under way.
    pub stop_time: Duration,
    /// A YAML document, bytes: its tree is near a hundred times as large, see
    /// `sistership_web_support::payload`.
    pub yaml_bytes: usize,
    /// Memory that requests take together, bytes.
    pub request_memory: u64,
    /// Memory that jobs take together, bytes.
    pub job_memory: u64,
    /// How long a request waits for memory that others have.
    pub memory_wait: Duration,
    /// Whether webhooks may lead into private networks, and speak plain http.
    pub webhooks_private: bool,
}

impl Config {
    /// A server on the loopback interface with an SQLite database in `data_dir`.
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
            proxies: TrustedProxies::default(),
            limits: Limits::default(),
            leases: Leases::default(),
            workers: 1,
        }
    }

    /// Checks what can be checked without starting.
    ///
    /// # Errors
    /// Says which setting cannot be, and what to do.
    pub fn check(&self) -> Result<(), StartError> {
        match &self.api_key {
            None if !self.accounts && !self.listen.ip().is_loopback() => {
                Err(StartError::OpenWithoutKey(self.listen))
            }
            Some(key) if key.is_empty() || !key.bytes().all(|byte| byte.is_ascii_graphic()) => {
                Err(StartError::Key)
            }
            _ if self.openid.is_some() && !self.accounts => Err(StartError::OpenIdWithoutAccounts),
            _ if self.leases.beat >= self.leases.lease => Err(StartError::Leases),
            _ if !(1..=self.limits.connections).contains(&self.limits.connections_per_address) => {
                Err(StartError::Connections)
            }
            _ => Ok(()),
        }
    }

    /// The time within which a process that is told to stop has ended, whatever it does: what jobs
    /// have, what they and requests have to break off, and some to close the store.
    pub fn stop_bound(&self) -> Duration {
        self.leases.drain + self.limits.stop_time + CLOSING
    }
}

/// The embedded database of a data folder.
pub fn sqlite_url(data_dir: &Path) -> String {
    format!("sqlite://{}", data_dir.join("sistership.db").display())
}

impl fmt::Debug for Config {
    /// Leaves out the key, and the database's URL, which may hold a password.
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
    /// Those of connections.
    pub(crate) fn of_connections(&self) -> sistership_listener::Limits {
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
        sistership_listener::Limits {
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
        let connections = sistership_listener::Limits::default();
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
