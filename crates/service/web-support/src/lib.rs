//! HTTP support for all endpoints: the common form of errors, bodies, parameters, conditions,
//! negotiation, lists and answers, the principal of a request, and metrics. It knows no route.

pub mod accept;
pub mod acting;
pub mod answers;
pub mod api_key;
pub mod conditions;
pub mod credential_cache;
pub mod drafts;
pub mod host;
pub mod large;
pub mod metrics;
pub mod operations;
pub mod page;
pub mod params;
pub mod payload;
pub mod problem;
pub mod query;
pub mod reply;
pub mod roles;
pub mod ship_search;
pub mod spool;
mod spool_folder;
pub mod tidy;
pub mod trace_context;
pub mod upload;

pub use sistership_request_types as field;
