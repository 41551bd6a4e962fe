//! Lists, a page at a time: each page starts after the last key of the one before, so that it costs
//! the same however far in, and neither repeats nor skips a row when others are added.

use crate::error::{Result, StoreError};

/// The most items that one page may have.
pub const MAX_LIMIT: i64 = 1000;

/// Which page of a list.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Page<K = String> {
    /// The last key of the page before; none for the first page.
    pub after: Option<K>,
    /// The most items to return, at least 1 and at most [`MAX_LIMIT`].
    pub limit: i64,
}

impl<K> Page<K> {
    /// The first page.
    pub fn first(limit: i64) -> Self {
        Self { after: None, limit }
    }

    /// The page after `key`.
    pub fn after(key: impl Into<K>, limit: i64) -> Self {
        Self { after: Some(key.into()), limit }
    }

    /// Refuses a page that is too large or has no items.
    ///
    /// # Errors
    /// Names the limit.
    pub fn check(&self) -> Result<()> {
        self.fetch().map(drop)
    }

    /// How many rows to ask for: one more than wanted, which tells whether there is a next page.
    pub(crate) fn fetch(&self) -> Result<i64> {
        match (1..=MAX_LIMIT).contains(&self.limit) {
            true => Ok(self.limit + 1),
            false => Err(StoreError::invalid(
                "limit",
                format!("must be from 1 to {MAX_LIMIT}, is {}", self.limit),
            )),
        }
    }

    /// The page made of items that come after [`Page::after`], of which there may be more than one
    /// page.
    pub fn of<T>(&self, mut items: Vec<T>, key: impl Fn(&T) -> K) -> List<T, K> {
        let limit = usize::try_from(self.limit).unwrap_or(0);
        let more = items.len() > limit;
        items.truncate(limit);
        let next = if more { items.last().map(key) } else { None };
        List { items, next }
    }
}

/// One page of a list.
#[derive(Debug, Clone, PartialEq)]
pub struct List<T, K = String> {
    /// The rows, in the list's order.
    pub items: Vec<T>,
    /// What to pass as [`Page::after`] for the next page; none on the last one.
    pub next: Option<K>,
}
