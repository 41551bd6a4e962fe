//! Schemas of types of other crates in the API document.

use utoipa::openapi::{Ref, RefOr, Schema};

/// Returns a reference to a type's schema, which the document has under its schemars name.
#[must_use]
pub fn schema_reference<T: schemars::JsonSchema>() -> RefOr<Schema> {
    Ref::from_schema_name(T::schema_name()).into()
}
