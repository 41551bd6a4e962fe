//! Pages of lists by key: each page starts after the last key of the one before, so that its cost
//! does not depend on its position, and rows added meanwhile are neither repeated nor skipped.

use crate::error::{Result, StoreError};

/// Maximum number of items of a page.
pub const MAX_LIMIT: i64 = 1000;

/// Request for one page of a list.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PageRequest<K = String> {
    /// Last key of the previous page; none for the first page.
    pub after: Option<K>,
    /// Maximum number of items to return, from 1 to [`MAX_LIMIT`].
    pub limit: i64,
}

impl<K> PageRequest<K> {
    /// Requests the first page.
    pub fn first_page(limit: i64) -> Self {
        Self { after: None, limit }
    }

    /// Requests the page after `key`.
    pub fn after_key(key: impl Into<K>, limit: i64) -> Self {
        Self { after: Some(key.into()), limit }
    }

    /// Checks that the limit is from 1 to [`MAX_LIMIT`].
    ///
    /// # Errors
    /// Returns an error that names the limit.
    pub fn check_limit(&self) -> Result<()> {
        self.fetch_limit().map(drop)
    }

    /// Returns the number of rows to read: one more than requested, which shows if there is a next
    /// page.
    pub(crate) fn fetch_limit(&self) -> Result<i64> {
        match (1..=MAX_LIMIT).contains(&self.limit) {
            true => Ok(self.limit + 1),
            false => Err(StoreError::invalid(
                "limit",
                format!("must be from 1 to {MAX_LIMIT}, not {}", self.limit),
            )),
        }
    }

    /// Returns the page made of the rows after [`Page::after`]; a row beyond the limit is cut off
    /// and shows that there is a next page.
    pub fn build_page<T>(&self, mut items: Vec<T>, key: impl Fn(&T) -> K) -> ListPage<T, K> {
        let limit = usize::try_from(self.limit).unwrap_or(0);
        let more = items.len() > limit;
        items.truncate(limit);
        let next = if more { items.last().map(key) } else { None };
        ListPage { items, next }
    }
}

/// One page of a list.
#[derive(Debug, Clone, PartialEq)]
pub struct ListPage<T, K = String> {
    /// The rows, in the list's order.
    pub items: Vec<T>,
    /// Value of [`Page::after`] for the next page; none on the last one.
    pub next: Option<K>,
}

/// Reads all pages of a list. `list` reads one page.
///
/// # Errors
/// Returns the first error of `list`.
pub async fn read_all_pages<T, K, E, F>(
    list: impl FnMut(PageRequest<K>) -> F,
) -> std::result::Result<Vec<T>, E>
where
    F: Future<Output = std::result::Result<ListPage<T, K>, E>>,
{
    let mut all = Vec::new();
    visit_pages(list, |items| {
        all.extend(items);
        Ok(())
    })
    .await?;
    Ok(all)
}

/// Passes the items of each page of a list to `visit`, from the first page to the last.
///
/// # Errors
/// Returns the first error of `list` or `visit`, which ends the walk.
pub async fn visit_pages<T, K, E, F>(
    mut list: impl FnMut(PageRequest<K>) -> F,
    mut visit: impl FnMut(Vec<T>) -> std::result::Result<(), E>,
) -> std::result::Result<(), E>
where
    F: Future<Output = std::result::Result<ListPage<T, K>, E>>,
{
    let mut page = PageRequest::first_page(MAX_LIMIT);
    loop {
        let ListPage { items, next } = list(page).await?;
        visit(items)?;
        let Some(key) = next else { return Ok(()) };
        page = PageRequest::after_key(key, MAX_LIMIT);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a page of the numbers from 1 to 2500.
    async fn list_numbers(page: PageRequest<i64>) -> Result<ListPage<i64, i64>> {
        let (from, limit) = (page.after.unwrap_or(0) + 1, page.fetch_limit()?);
        Ok(page.build_page((from..=2500).take(limit as usize).collect(), |number| *number))
    }

    #[tokio::test]
    async fn every_item_of_a_list_is_read_once() {
        let all = read_all_pages(list_numbers).await.unwrap_or_default();
        assert_eq!(all, (1..=2500).collect::<Vec<_>>());
    }

    #[tokio::test]
    async fn an_error_ends_the_walk() {
        let mut seen = 0;
        let visited = visit_pages(list_numbers, |items| {
            seen += items.len();
            Err(StoreError::invalid("items", "enough"))
        });
        assert!(visited.await.is_err());
        assert_eq!(seen, 1000);
    }
}
