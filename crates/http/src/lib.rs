//! What every endpoint needs of HTTP: the one form of errors, bodies, parameters, conditions,
//! negotiation, lists and answers. It knows no route.

pub mod accept;
pub mod conditions;
pub mod host;
pub mod large;
pub mod page;
pub mod params;
pub mod payload;
pub mod problem;
pub mod query;
pub mod reply;

pub use sistership_fields as field;
