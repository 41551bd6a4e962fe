//! Sessions: a simulation that is continued step by step under orders.
//!
//! `request` has the requests, `start` creates a session, `under_way` simulates, `sample` is the
//! state at an instant, `answer` is its JSON, and `table` holds the sessions of a server.

mod answer;
mod request;
mod sample;
mod start;
mod table;
mod under_way;

pub use request::{CurrentRequest, OrdersRequest, SessionRequest, StepsRequest, WindRequest};
pub use table::{SessionHandle, SessionLimits, SessionTable};
pub use under_way::PredictionSession;

#[cfg(test)]
mod tests;
