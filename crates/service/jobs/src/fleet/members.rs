//! Members of a family.

use sistership_store::{MAX_LIMIT, PageRequest, Store, StoreError};

/// Reads the names of all members.
pub(super) async fn member_names(
    store: &Store,
    family: &str,
) -> std::result::Result<Vec<String>, StoreError> {
    let (mut all, mut page) = (Vec::new(), PageRequest::first_page(MAX_LIMIT));
    loop {
        let list = store.families().list_members(family, &page).await?;
        all.extend(list.items.into_iter().map(|member| member.ship));
        let Some(next) = list.next else { return Ok(all) };
        page = PageRequest::after_key(next, MAX_LIMIT);
    }
}
