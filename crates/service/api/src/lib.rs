//! The REST server of Sistership: endpoints, jobs, pages and reports over the store.
//!
//! [`Server::start`] runs it within the calling program; [`Workers::start`] works on its jobs
//! without serving requests. The work of the jobs is in `sistership_jobs`, which the command line
//! uses as well.

mod accounts;
mod app;
mod compute_pool;
mod config;
mod jobs;
#[cfg(test)]
mod journey;
use sistership_web_support::{metrics, problem};
mod process;
mod rights;
mod routes;
mod search_index;
mod server;
mod start_error;
mod tidy;
mod upload;
mod web;
mod workers;

pub use config::{Config, DEFAULT_LISTEN, LeaseSettings, Limits, MailSettings, sqlite_url};
pub use routes::openapi;
pub use server::{RunningServer, Server};
pub use sistership_auth::openid::ProviderSettings as OpenIdSettings;
pub use sistership_listener::{ForwardedHeader, TrustedProxies};
pub use sistership_store::{ObjectsPlace, S3Place};
pub use start_error::StartError;
pub use workers::Workers;
