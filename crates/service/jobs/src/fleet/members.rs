//! Members of a family.

use sistership_store::{Result, Store, read_all_pages};

/// Reads the names of all members.
pub(super) async fn member_names(store: &Store, family: &str) -> Result<Vec<String>> {
    let families = store.families();
    let members = |page| async move { families.list_members(family, &page).await };
    Ok(read_all_pages(members).await?.into_iter().map(|member| member.ship).collect())
}
