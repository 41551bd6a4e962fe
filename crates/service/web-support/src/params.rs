//! Extractors of path and query parameters whose rejections are problems.

use axum::extract::{FromRequestParts, Path, Query};

use crate::problem::Problem;

/// Parameters of the path.
#[derive(Debug, FromRequestParts)]
#[from_request(via(Path), rejection(Problem))]
pub struct PathParams<T>(pub T);

/// Parameters of the query.
#[derive(Debug, FromRequestParts)]
#[from_request(via(Query), rejection(Problem))]
pub struct QueryParams<T>(pub T);
