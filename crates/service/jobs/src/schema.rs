//! Types of other crates in the REST document.

use utoipa::openapi::{Ref, RefOr, Schema};

/// A reference to a type's schema, which the document has by the name that schemars gives it.
#[must_use]
pub fn described<T: schemars::JsonSchema>() -> RefOr<Schema> {
    Ref::from_schema_name(T::schema_name()).into()
}
