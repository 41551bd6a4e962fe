//! Dependencies run one way: the manifests are read, and an edge that `ARCHITECTURE.md` does not allow fails.

use std::collections::BTreeMap;
use std::path::PathBuf;

/// Which of our crates each crate may use, and the outside crate that it alone may name.
const ALLOWED: [(&str, &[&str]); 7] = [
    ("model", &[]),
    ("dynamics", &["model"]),
    ("trials", &["model"]),
    ("identify", &["model", "dynamics"]),
    ("store", &[]),
    ("server", &["model", "dynamics", "identify", "trials", "store"]),
    ("cli", &["model", "dynamics", "identify", "trials", "store", "server"]),
];
const ALONE: [(&str, &str); 2] = [("sqlx", "store"), ("axum", "server")];

/// The names in `[dependencies]` of each crate.
fn dependencies() -> BTreeMap<&'static str, Vec<String>> {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../crates");
    let of = |name: &str| {
        let path = root.join(name).join("Cargo.toml");
        let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let section = text.split("\n[").find(|part| part.starts_with("dependencies]")).unwrap_or_default().to_owned();
        section.lines().skip(1).filter_map(|line| line.split(['.', ' ', '=']).next()).map(str::to_owned).collect::<Vec<_>>()
    };
    ALLOWED.iter().map(|(name, _)| (*name, of(name))).collect()
}

#[test]
fn dependencies_run_one_way() {
    let found = dependencies();
    for (name, allowed) in ALLOWED {
        for other in found[name].iter().filter_map(|dependency| dependency.strip_prefix("sistership-")) {
            assert!(allowed.contains(&other), "crates/{name} may not use crates/{other}");
        }
    }
}

#[test]
fn the_database_and_the_web_are_named_in_one_crate_each() {
    for (name, dependencies) in dependencies() {
        for (outside, only) in ALONE {
            assert!(name == only || !dependencies.iter().any(|d| d == outside), "crates/{name} names {outside}");
        }
    }
}
