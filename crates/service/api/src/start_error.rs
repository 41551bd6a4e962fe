//! Why a server does not start.

use std::net::SocketAddr;
use std::path::PathBuf;

use sistership_jobs::seed::SeedError;

/// Why a server does not start.
#[derive(Debug, thiserror::Error)]
pub enum StartError {
    /// Anyone on the network could change what it holds.
    #[error(
        "refusing to listen on {0} without an API key: set one (--api-key or SISTERSHIP_API_KEY), \
         or listen on 127.0.0.1"
    )]
    OpenWithoutKey(SocketAddr),
    /// A key that no header can carry.
    #[error("the API key must be one or more printable ASCII characters without spaces")]
    Key,
    /// Every job would be taken over while it runs.
    #[error("the beat of a worker must be shorter than its lease")]
    Leases,
    /// An address that could have no connection, or more than there are.
    #[error("connections_per_address must be from 1 to the number of connections")]
    Connections,
    /// The address is taken or not ours.
    #[error("cannot listen on {listen}: {error}")]
    Listen {
        /// The address.
        listen: SocketAddr,
        /// What the system said.
        error: std::io::Error,
    },
    /// The data folder cannot be used.
    #[error("cannot use the data folder {folder}: {error}")]
    Folder {
        /// The folder.
        folder: PathBuf,
        /// What the system said.
        error: std::io::Error,
    },
    /// The database or the object store cannot be used.
    #[error("cannot open the store: {0}")]
    Store(#[from] sistership_store::StoreError),
    /// People who have signed in at a provider would be asked for a key.
    #[error("oidc issuer: people sign in only where accounts are asked for; set --accounts, too")]
    OpenIdWithoutAccounts,
    /// The system gives no random numbers.
    #[error("oidc: {0}")]
    OpenId(#[from] sistership_auth::openid::Failure),
    /// The zoo that the program carries does not read.
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
