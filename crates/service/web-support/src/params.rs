//! Path and query, refused as problems.

use axum::extract::{FromRequestParts, Path, Query};

use crate::problem::Problem;

/// The parameters of the path.
#[derive(Debug, FromRequestParts)]
#[from_request(via(Path), rejection(Problem))]
pub struct Place<T>(pub T);

/// The parameters of the query.
#[derive(Debug, FromRequestParts)]
#[from_request(via(Query), rejection(Problem))]
pub struct Params<T>(pub T);
