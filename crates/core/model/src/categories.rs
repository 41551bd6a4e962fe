//! Categories of ships that are compared with each other, from the data of the zoo.

use std::collections::BTreeSet;
use std::sync::LazyLock;

use serde::Deserialize;

const CATEGORIES_TEXT: &str = include_str!("../../../../models/categories.yaml");

static GROUPS: LazyLock<Vec<CategoryGroup>> = LazyLock::new(|| {
    // The file is embedded; if it could not be read, there would be no groups.
    serde_yaml::from_str::<CategoriesFile>(CATEGORIES_TEXT)
        .map(|file| file.groups)
        .unwrap_or_default()
});

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct CategoriesFile {
    #[serde(rename = "kind")]
    _kind: CategoriesKind,
    groups: Vec<CategoryGroup>,
}

#[derive(Deserialize)]
#[serde(rename_all = "lowercase")]
enum CategoriesKind {
    Categories,
}

/// Categories that are compared with each other.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CategoryGroup {
    /// Name of what they have in common.
    pub name: String,
    /// The categories.
    pub categories: BTreeSet<String>,
}

/// Returns the group of a category; `None` for a category without a group.
pub fn category_group(category: &str) -> Option<&'static CategoryGroup> {
    GROUPS.iter().find(|group| group.categories.contains(category))
}

/// Returns true if ships of two categories are compared with each other.
pub fn are_comparable(one: &str, other: &str) -> bool {
    one == other || category_group(one).is_some_and(|group| group.categories.contains(other))
}

/// Returns every category that belongs to a group.
pub fn known_categories() -> Vec<&'static str> {
    GROUPS.iter().flat_map(|group| &group.categories).map(String::as_str).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::Zoo;

    #[test]
    fn full_form_ships_are_compared_with_each_other() {
        assert!(are_comparable("tanker", "bulk-carrier"));
        assert!(are_comparable("hovercraft", "hovercraft"));
        assert!(!are_comparable("tanker", "dry-cargo"));
        assert!(!are_comparable("hovercraft", "tanker"));
    }

    #[test]
    fn a_category_stands_in_one_group_and_the_zoo_has_no_other() {
        let known = known_categories();
        assert_eq!(known.len(), known.iter().collect::<BTreeSet<_>>().len());
        for vessel in Zoo::load_embedded().unwrap().vessels() {
            assert!(category_group(&vessel.file.category).is_some(), "{}", vessel.name());
        }
    }
}
