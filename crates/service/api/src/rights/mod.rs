//! Caller and access: the decisions of `sistership_auth` for the routes of this server.

mod decide;
mod table;

pub(crate) use decide::{Asked, allowed, on_ship, readable_trial, visible};
pub(crate) use sistership_web_support::acting::{Acting, Kind, carried, current};
#[cfg(test)]
pub(crate) use table::{ANYONE, TABLE};
pub(crate) use table::{HEALTH, OPEN, SECOND_PERSON};
