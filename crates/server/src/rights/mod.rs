//! Who asks, and whether they may: what `sistership_access` decides, for the routes of this server.

mod acting;
mod decide;
mod identify;
pub(crate) mod known;
mod table;

pub(crate) use acting::{Acting, Kind, carried, current};
pub(crate) use decide::{Asked, allowed, on_ship};
pub(crate) use identify::{COOKIE, Refusal, identify};
#[cfg(test)]
pub(crate) use table::{ANYONE, TABLE};
pub(crate) use table::{HEALTH, OPEN, SECOND_PERSON};
