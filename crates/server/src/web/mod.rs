//! What every endpoint needs of HTTP: bodies, parameters, conditions, negotiation, answers, and
//! what wraps them.

pub(crate) mod accept;
pub(crate) mod api_key;
pub(crate) mod conditions;
pub(crate) mod envelope;
pub(crate) mod form;
pub(crate) mod guard;
pub(crate) mod host;
pub(crate) mod idempotency;
pub(crate) mod large;
pub(crate) mod page;
pub(crate) mod params;
pub(crate) mod payload;
pub(crate) mod query;
pub(crate) mod reply;

pub(crate) use conditions::Conditions;
pub(crate) use idempotency::Key;
pub(crate) use page::{Listing, Paged};
pub(crate) use params::{Params, Place};
pub(crate) use payload::Payload;
pub(crate) use reply::Reply;
pub(crate) use sistership_fields as field;
pub(crate) use sistership_fields::{Id, ModelName, Name, Number, Word};
