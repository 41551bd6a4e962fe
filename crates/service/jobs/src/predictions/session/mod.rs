//! A ship under way: it sails on as orders come, and is asked where it is.
//!
//! `request` reads, `under_way` sails, `sample` is where it is at an instant, `answer` says so,
//! `table` keeps those who sail for others than who asks first.

mod answer;
mod request;
mod sample;
mod start;
mod table;
mod under_way;

pub use request::{CurrentRequest, OrdersRequest, SessionRequest, StepsRequest, WindRequest};
pub use table::{Handle, SessionLimits, Sessions};
pub use under_way::Session;

#[cfg(test)]
mod tests;
