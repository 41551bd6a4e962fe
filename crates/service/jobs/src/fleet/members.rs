//! Members of a family.

use sistership_store::{MAX_LIMIT, Page, Store, StoreError};

/// Reads the names of all members.
pub(super) async fn members(
    store: &Store,
    family: &str,
) -> std::result::Result<Vec<String>, StoreError> {
    let (mut all, mut page) = (Vec::new(), Page::first(MAX_LIMIT));
    loop {
        let list = store.families().members(family, &page).await?;
        all.extend(list.items.into_iter().map(|member| member.ship));
        let Some(next) = list.next else { return Ok(all) };
        page = Page::after(next, MAX_LIMIT);
    }
}
