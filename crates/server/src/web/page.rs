//! Lists, a page at a time.

use serde::Serialize;
use sistership_store::{List, Page};
use utoipa::ToSchema;

/// How many items a page has where nobody says.
const LIMIT: i64 = 100;

/// One page of a list.
#[derive(Debug, Serialize, ToSchema)]
pub(crate) struct Listing<T> {
    /// The items, in the list's order.
    pub items: Vec<T>,
    /// What to give as `after` for the next page; null on the last one.
    pub next: Option<String>,
}

impl<T> Listing<T> {
    pub(crate) fn of<R, K: ToString>(list: List<R, K>, view: impl FnMut(R) -> T) -> Self {
        Self { items: list.items.into_iter().map(view).collect(), next: list.next.map(|key| key.to_string()) }
    }
}

/// The page that a query asks for.
pub(crate) fn page<K>(limit: Option<i64>, after: Option<K>) -> Page<K> {
    Page { after, limit: limit.unwrap_or(LIMIT) }
}
