//! Dependencies run one way: manifests and modules are read, and an edge that `ARCHITECTURE.md`
//! does not allow fails, as does a circle between the modules of a crate.

mod circles;
mod modules;

use std::collections::BTreeMap;
use std::path::PathBuf;

/// Which of our crates each crate may use, and the outside crates that only some may name.
const ALLOWED: &[(&str, &[&str])] = &[
    ("formula", &[]),
    ("model", &["formula"]),
    ("dynamics", &["formula", "model"]),
    ("stretches", &[]),
    ("containers", &[]),
    ("columns", &[]),
    ("trials", &["formula", "model", "containers", "columns"]),
    ("regression", &[]),
    ("branches", &["formula", "model", "dynamics"]),
    ("bands", &["model", "dynamics"]),
    ("export", &["formula", "model", "dynamics"]),
    ("validation", &["model", "dynamics"]),
    ("empirical", &["formula", "model", "dynamics", "bands"]),
    ("sources", &["formula", "model", "dynamics", "empirical"]),
    ("constraints", &["model", "dynamics"]),
    ("propulsion", &["model", "dynamics"]),
    (
        "estimate",
        &[
            "formula",
            "model",
            "dynamics",
            "bands",
            "regression",
            "empirical",
            "sources",
            "constraints",
            "propulsion",
        ],
    ),
    ("choice", &["model", "dynamics", "branches", "bands", "sources", "estimate"]),
    ("residual", &["formula", "model", "dynamics", "estimate"]),
    (
        "diagnose",
        &[
            "formula",
            "model",
            "dynamics",
            "branches",
            "regression",
            "sources",
            "estimate",
            "residual",
        ],
    ),
    ("plan", &["model", "dynamics", "bands", "estimate", "residual", "diagnose"]),
    ("fleet", &["model", "dynamics", "regression", "propulsion", "estimate"]),
    ("store", &[]),
    ("access", &[]),
    ("openid", &["access"]),
    ("webhooks", &["access", "store"]),
    (
        "report",
        &[
            "model",
            "dynamics",
            "branches",
            "bands",
            "validation",
            "sources",
            "estimate",
            "choice",
            "diagnose",
        ],
    ),
    (
        "pipeline",
        &[
            "model",
            "dynamics",
            "branches",
            "trials",
            "bands",
            "validation",
            "export",
            "sources",
            "estimate",
            "choice",
            "diagnose",
            "fleet",
            "store",
        ],
    ),
    ("pages", &["model", "dynamics", "trials", "sources", "store", "report", "pipeline"]),
    ("listen", &[]),
    ("fields", &["store"]),
    ("predict", &["model", "dynamics", "bands", "fields", "pipeline"]),
    (
        "http",
        &[
            "access", "model", "trials", "sources", "estimate", "store", "pipeline", "pages",
            "fields", "predict",
        ],
    ),
    ("accounts", &["access", "openid", "http", "pipeline", "store"]),
    (
        "server",
        &[
            "model", "dynamics", "branches", "trials", "bands", "sources", "estimate", "choice",
            "diagnose", "fleet", "store", "report", "pipeline", "pages", "listen", "fields",
            "predict", "http", "access", "openid", "accounts", "webhooks",
        ],
    ),
    (
        "cli",
        &[
            "model",
            "dynamics",
            "branches",
            "stretches",
            "trials",
            "bands",
            "validation",
            "empirical",
            "sources",
            "estimate",
            "choice",
            "diagnose",
            "plan",
            "store",
            "report",
            "pipeline",
            "predict",
            "openid",
            "server",
            "export",
            "access",
        ],
    ),
    ("program", &["cli"]),
];
const ALONE: [(&str, &[&str]); 2] = [("sqlx", &["store"]), ("axum", &["server", "http", "listen"])];

/// The folder of a crate.
fn folder(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../crates").join(name)
}

/// The names in `[dependencies]` of each crate.
fn dependencies() -> BTreeMap<&'static str, Vec<String>> {
    let of = |name: &str| {
        let path = folder(name).join("Cargo.toml");
        let text = std::fs::read_to_string(&path)
            .unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let section = text
            .split("\n[")
            .find(|part| part.starts_with("dependencies]"))
            .unwrap_or_default()
            .to_owned();
        section
            .lines()
            .skip(1)
            .filter_map(|line| line.split(['.', ' ', '=']).next())
            .map(str::to_owned)
            .collect::<Vec<_>>()
    };
    ALLOWED.iter().map(|(name, _)| (*name, of(name))).collect()
}

#[test]
fn dependencies_run_one_way() {
    let found = dependencies();
    for (name, allowed) in ALLOWED {
        for other in
            found[name].iter().filter_map(|dependency| dependency.strip_prefix("sistership-"))
        {
            assert!(allowed.contains(&other), "crates/{name} may not use crates/{other}");
        }
    }
}

#[test]
fn the_database_and_the_web_are_named_where_they_are_at_home() {
    for (name, dependencies) in dependencies() {
        for (outside, only) in ALONE {
            assert!(
                only.contains(&name) || !dependencies.iter().any(|d| d == outside),
                "crates/{name} names {outside}"
            );
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
                edges.extend(
                    inside.map(|target| {
                        format!("    {} -> {}", module.join("::"), target.join("::"))
                    }),
                );
            }
            found.push(format!("crates/{name}:\n{}", edges.join("\n")));
        }
    }
    assert!(found.is_empty(), "modules in circles:\n{}", found.join("\n"));
}

/// Words that say nothing to a naval architect, and what to say in their place
/// (`docs/notation.md`).
const FORBIDDEN: [(&str, &str); 7] = [
    ("taught", "calibrated, or learned"),
    ("feigned", "false-alarm level"),
    ("habit", "systematic error of an instrument"),
    ("righted", "corrected record"),
    ("glimpse", "iterate"),
    ("bend", "trajectory fit"),
    ("trying", "candidate"),
];

#[test]
fn the_fields_own_words_are_used() {
    let numerics = ["model", "dynamics", "regression", "estimate", "residual", "diagnose"];
    let mut found = Vec::new();
    for (path, text) in numerics.iter().flat_map(|name| modules::texts(&folder(name).join("src"))) {
        for (number, line) in
            text.lines().enumerate().filter(|(_, line)| !line.contains("serde(rename"))
        {
            let words = line.split(|c: char| !c.is_ascii_alphabetic()).map(str::to_ascii_lowercase);
            let wrong = words.filter_map(|word| {
                FORBIDDEN.iter().find(|(forbidden, _)| word.trim_end_matches('s') == *forbidden)
            });
            found.extend(wrong.map(|(word, better)| {
                format!("{}:{}: `{word}`: say {better}", path.display(), number + 1)
            }));
        }
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

/// A build for tests leaves out those of doc comments, which takes a minute of `rustdoc` for none.
#[test]
fn doc_comments_have_no_code_that_nobody_runs() {
    let fenced = |line: &str| line.trim_start().starts_with("//") && line.contains("```");
    for (name, _) in ALLOWED {
        for (path, text) in modules::texts(&folder(name).join("src")) {
            assert!(!text.lines().any(fenced), "{}: move the code into a test", path.display());
        }
    }
}

/// The largest crate, without its tests: beyond this a room does several things.
const LINES_OF_A_CRATE: usize = 9500;

#[test]
fn no_crate_is_too_large() {
    for (name, _) in ALLOWED {
        let lines: usize = modules::texts(&folder(name).join("src"))
            .iter()
            .map(|(_, text)| text.lines().count())
            .sum();
        assert!(lines <= LINES_OF_A_CRATE, "crates/{name} has {lines} lines without its tests");
    }
}
