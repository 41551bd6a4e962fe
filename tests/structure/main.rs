//! Dependencies run one way: manifests and modules are read, and an edge that `ARCHITECTURE.md` does not allow fails, as does a
//! circle between the modules of a crate.

mod circles;
mod modules;

use std::collections::BTreeMap;
use std::path::PathBuf;

/// Which of our crates each crate may use, and the outside crate that it alone may name.
const ALLOWED: [(&str, &[&str]); 10] = [
    ("model", &[]),
    ("dynamics", &["model"]),
    ("trials", &["model"]),
    ("regression", &[]),
    ("estimate", &["model", "dynamics", "regression"]),
    ("diagnose", &["model", "dynamics", "regression", "estimate"]),
    ("fleet", &["model", "dynamics", "regression", "estimate"]),
    ("store", &[]),
    ("server", &["model", "dynamics", "trials", "regression", "estimate", "diagnose", "fleet", "store"]),
    ("cli", &["model", "dynamics", "trials", "regression", "estimate", "diagnose", "fleet", "store", "server"]),
];
const ALONE: [(&str, &str); 2] = [("sqlx", "store"), ("axum", "server")];

/// The folder of a crate.
fn folder(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../crates").join(name)
}

/// The names in `[dependencies]` of each crate.
fn dependencies() -> BTreeMap<&'static str, Vec<String>> {
    let of = |name: &str| {
        let path = folder(name).join("Cargo.toml");
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

#[test]
fn no_modules_of_a_crate_refer_to_each_other_in_a_circle() {
    let mut found = Vec::new();
    for (name, _) in ALLOWED {
        let references = modules::references(&folder(name).join("src"));
        for circle in circles::circles(&references) {
            let mut edges = Vec::new();
            for module in &circle {
                let inside = references[module].iter().filter(|target| circle.contains(target));
                edges.extend(inside.map(|target| format!("    {} -> {}", module.join("::"), target.join("::"))));
            }
            found.push(format!("crates/{name}:\n{}", edges.join("\n")));
        }
    }
    assert!(found.is_empty(), "modules in circles:\n{}", found.join("\n"));
}
