//! Layers around every endpoint of this server; the HTTP parts that endpoints share are in
//! `sistership_web_support`.

pub(crate) mod envelope;
pub(crate) mod form;
pub(crate) mod guard;
pub(crate) mod idempotency;

pub(crate) use idempotency::Key;
pub(crate) use sistership_web_support::conditions::Conditions;
pub(crate) use sistership_web_support::field::{Id, ModelName, Name, Number, Word};
pub(crate) use sistership_web_support::page::{Listing, Paged};
pub(crate) use sistership_web_support::params::{Params, Place};
pub(crate) use sistership_web_support::payload::Payload;
pub(crate) use sistership_web_support::reply::Reply;
pub(crate) use sistership_web_support::{accept, conditions, field, page, payload, query};
