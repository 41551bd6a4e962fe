//! What wraps every endpoint of this server; what each needs of HTTP stands in `sistership_http`.

pub(crate) mod envelope;
pub(crate) mod form;
pub(crate) mod guard;
pub(crate) mod idempotency;

pub(crate) use idempotency::Key;
pub(crate) use sistership_http::conditions::Conditions;
pub(crate) use sistership_http::field::{Id, ModelName, Name, Number, Word};
pub(crate) use sistership_http::page::{Listing, Paged};
pub(crate) use sistership_http::params::{Params, Place};
pub(crate) use sistership_http::payload::Payload;
pub(crate) use sistership_http::reply::Reply;
pub(crate) use sistership_http::{accept, conditions, field, page, payload, query};
