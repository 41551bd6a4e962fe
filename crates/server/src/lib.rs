//! The REST server of Sistership: endpoints, jobs, pages and reports over the store.
//!
//! [`Server::start`] runs it within the program that calls it; [`Workers::start`] works on its jobs without serving.
//! [`derive`](mod@derive) and [`verify`](mod@verify) make versions again from their recipes, for the server's jobs and for
//! the command line alike.

mod answers;
mod app;
mod archive;
mod catalogue;
mod config;
pub mod derive;
mod descriptors;
pub mod fleet;
mod jobs;
#[cfg(test)]
mod journey;
pub mod library;
mod listen;
mod memory;
mod metrics;
mod predict;
mod problem;
mod process;
mod publish;
mod routes;
pub mod search;
mod seed;
mod server;
mod start_error;
mod stopping;
mod tidy;
pub mod upkeep;
mod upload;
pub mod verify;
pub mod version;
mod web;
mod workers;

pub use archive::Archive;
pub use config::{Config, DEFAULT_LISTEN, Leases, Limits, sqlite_url};
pub use routes::openapi;
pub use server::{Running, Server};
pub use sistership_store::{ObjectsPlace, S3Place};
pub use start_error::StartError;
pub use workers::Workers;
