//! Fields of requests that are checked as they are read, and described by the same figures:
//! whatever the document says of a name, a text, a count or a number is what
//! [`Deserialize`](serde::Deserialize) checks, so that neither drifts from the other.

mod number;
mod text;
mod whole;

pub use number::*;
pub use text::*;
pub use whole::*;

use utoipa::openapi::RefOr;
use utoipa::openapi::schema::{AdditionalProperties, ObjectBuilder, Schema, Type};

/// The schema of a text that is one of several words.
pub fn one_of(words: impl IntoIterator<Item = &'static str>) -> RefOr<Schema> {
    ObjectBuilder::new().schema_type(Type::String).enum_values(Some(words)).build().into()
}

/// The schema of an object of which the keys are not fixed here.
pub fn any_object() -> RefOr<Schema> {
    ObjectBuilder::new()
        .schema_type(Type::Object)
        .additional_properties(Some(AdditionalProperties::FreeForm(true)))
        .build()
        .into()
}
