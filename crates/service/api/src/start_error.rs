//! Reasons for which a server does not start.

use std::net::SocketAddr;
use std::path::PathBuf;

use sistership_jobs::seed::SeedError;

/// Reason for which a server does not start.
#[derive(Debug, thiserror::Error)]
pub enum StartError {
    /// An address other than loopback has no key: anyone on the network could change the data.
    #[error(
        "refusing to listen on {0} without an API key: set one (--api-key or SISTERSHIP_API_KEY), \
         or listen on 127.0.0.1"
    )]
    OpenWithoutKey(SocketAddr),
    /// The key has characters that no header can carry.
    #[error("the API key must be one or more printable ASCII characters without spaces")]
    Key,
    /// Workers prolong their leases too rarely: every job would be taken over while it runs.
    #[error("the heartbeat interval of a worker must be shorter than its lease")]
    Leases,
    /// The limit of connections per address is zero or above the total.
    #[error("connections_per_address must be from 1 to the number of connections")]
    Connections,
    /// The address is in use or not available on this machine.
    #[error("cannot listen on {listen}: {error}")]
    Listen {
        /// The address.
        listen: SocketAddr,
        /// Error of the operating system.
        error: std::io::Error,
    },
    /// The data folder cannot be used.
    #[error("cannot use the data folder {folder}: {error}")]
    Folder {
        /// The folder.
        folder: PathBuf,
        /// Error of the operating system.
        error: std::io::Error,
    },
    /// The database or the object store cannot be used.
    #[error("cannot open the store: {0}")]
    Store(#[from] sistership_store::StoreError),
    /// An OpenID provider is set, but people do not sign in.
    #[error("oidc issuer: sign-in needs accounts; set --accounts as well")]
    OpenIdWithoutAccounts,
    /// The client of the OpenID provider cannot be set up.
    #[error("oidc: {0}")]
    OpenId(#[from] sistership_auth::openid::SignInFailure),
    /// Mail cannot be sent with these settings.
    #[error("{0}")]
    Mail(String),
    /// The zoo that is embedded in the program cannot be parsed.
    #[error("the zoo is damaged: {0}")]
    Zoo(#[from] sistership_model::FileError),
}

impl From<SeedError> for StartError {
    fn from(error: SeedError) -> Self {
        match error {
            SeedError::Store(error) => Self::Store(error),
            SeedError::Zoo(error) => Self::Zoo(error),
        }
    }
}
