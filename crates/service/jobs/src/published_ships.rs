//! Names of the ships that the program brings.

use std::collections::BTreeSet;
use std::sync::LazyLock;

use sistership_model::Zoo;

/// Returns true if the program brings a ship of this name.
pub fn is_published(ship: &str) -> bool {
    static NAMES: LazyLock<BTreeSet<String>> = LazyLock::new(|| {
        let names = |zoo: Zoo| zoo.vessels().map(|vessel| vessel.name().to_owned()).collect();
        Zoo::load_embedded().map(names).unwrap_or_default()
    });
    NAMES.contains(ship)
}
