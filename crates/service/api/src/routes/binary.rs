//! Files in the OpenAPI document.

/// A file, byte for byte.
#[derive(utoipa::ToSchema)]
#[schema(value_type = String, format = Binary)]
#[allow(dead_code, reason = "it only describes a body")]
pub(super) struct Binary(Vec<u8>);
