//! Files in the OpenAPI document.

/// A file, byte for byte.
#[derive(utoipa::ToSchema)]
#[schema(value_type = String, format = Binary)]
#[allow(dead_code, reason = "describes a body only")]
pub(super) struct Binary(Vec<u8>);
