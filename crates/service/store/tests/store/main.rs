//! The same suite on SQLite and on PostgreSQL.
#![allow(clippy::unwrap_used)]

#[macro_use]
mod support;

mod access;
mod aliases;
mod backup;
mod concurrency;
mod current;
mod diagnoses;
mod fleets;
mod idempotency;
mod jobs;
mod laws;
mod objects;
mod queue;
mod refinements;
mod refusals;
mod reports;
mod scale;
mod schema;
mod search;
mod ships;
mod silent;
mod standings;
mod templates;
mod trials;
mod versions;
mod webhooks;
