//! Types of request fields that are checked when they are read, and described by the same limits:
//! the schema in the OpenAPI document and the check of [`Deserialize`](serde::Deserialize) cannot
//! differ.

mod number;
mod text;
mod whole;

pub use number::*;
pub use text::*;
pub use whole::*;

use utoipa::openapi::RefOr;
use utoipa::openapi::schema::{AdditionalProperties, ObjectBuilder, Schema, Type};

/// Returns the schema of a text that is one of several words.
pub fn one_of(words: impl IntoIterator<Item = &'static str>) -> RefOr<Schema> {
    ObjectBuilder::new().schema_type(Type::String).enum_values(Some(words)).build().into()
}

/// Returns the schema of an object with arbitrary keys.
pub fn any_object() -> RefOr<Schema> {
    ObjectBuilder::new()
        .schema_type(Type::Object)
        .additional_properties(Some(AdditionalProperties::FreeForm(true)))
        .build()
        .into()
}
