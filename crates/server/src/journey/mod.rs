//! Through the real server, on SQLite and on PostgreSQL where this machine has it.

#![allow(clippy::unwrap_used)]

mod access;
mod contract;
mod documents;
mod harness;
mod keys;
mod loops;
mod network;
mod observed;
mod openid;
mod refusals;
mod registry;
mod search;
mod sessions;
mod under_way;
mod uploads;
mod webhooks;
