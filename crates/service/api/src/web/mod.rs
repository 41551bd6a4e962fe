//! Layers around every endpoint of this server; the HTTP parts that endpoints share are in
//! `sistership_web_support`.

pub(crate) mod envelope;
pub(crate) mod form;
pub(crate) mod guard;
pub(crate) mod idempotency;
pub(crate) mod language;
pub(crate) mod unit;

pub(crate) use idempotency::IdempotencyKey;
pub(crate) use sistership_web_support::conditions::RequestConditions;
pub(crate) use sistership_web_support::field::{Id, ModelName, Name, Number, Word};
pub(crate) use sistership_web_support::page::{Listing, PageQuery};
pub(crate) use sistership_web_support::params::{PathParams, QueryParams};
pub(crate) use sistership_web_support::payload::DocumentBody;
pub(crate) use sistership_web_support::reply::StoredReply;
pub(crate) use sistership_web_support::{accept, conditions, field, page, payload, query};
