//! Sessions: a simulation that is continued step by step under orders.
//!
//! `request` has the requests, `start` creates a session, `under_way` simulates, `sample` is the
//! state at an instant, `answer` is its JSON, and `table` holds the sessions of a server.

mod json;
mod request;
mod sample;
mod simulation;
mod start;
mod table;

pub use request::{CurrentRequest, OrdersRequest, SessionRequest, StepsRequest, WindRequest};
pub use simulation::PredictionSession;
pub use table::{SessionHandle, SessionLimits, SessionTable};

#[cfg(test)]
mod tests;
