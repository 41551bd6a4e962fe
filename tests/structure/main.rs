//! Structure of the workspace, read from manifests and sources: the five wings and the direction of
//! their dependencies, circles between the modules of a crate, and the language of the sources.

mod circles;
mod language;
mod modules;

use std::path::{Path, PathBuf};

/// Each wing, and the wings that its crates may depend on beside their own.
const WINGS: [(&str, &[&str]); 5] = [
    ("core", &[]),
    ("data", &["core"]),
    ("analysis", &["core"]),
    ("service", &["core", "data", "analysis"]),
    ("app", &["core", "data", "analysis", "service"]),
];

/// Outside crates, each with the only crates that may depend on it.
const RESTRICTED: [(&str, &[&str]); 2] =
    [("sqlx", &["store"]), ("axum", &["api", "web-support", "listener"])];

/// Outside crates that wait, which `core`, `data` and `analysis` may not depend on.
const ASYNC: [&str; 4] = ["tokio", "futures", "reqwest", "hyper"];

/// A crate of the workspace: where it stands and what it depends on.
struct Crate {
    wing: &'static str,
    name: String,
    folder: PathBuf,
    dependencies: Vec<String>,
}

fn crates() -> Vec<Crate> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates");
    let in_wing = |(wing, _): &(&'static str, &[&str])| {
        let wing = *wing;
        let mut folders: Vec<PathBuf> = std::fs::read_dir(root.join(wing))
            .unwrap_or_else(|error| panic!("crates/{wing}: {error}"))
            .map(|entry| entry.expect("a listed folder").path())
            .filter(|folder| folder.join("Cargo.toml").is_file())
            .collect();
        folders.sort();
        folders.into_iter().map(move |folder| read_crate(wing, folder))
    };
    WINGS.iter().flat_map(in_wing).collect()
}

fn read_crate(wing: &'static str, folder: PathBuf) -> Crate {
    let path = folder.join("Cargo.toml");
    let text = std::fs::read_to_string(&path)
        .unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let section =
        text.split("\n[").find(|part| part.starts_with("dependencies]")).unwrap_or_default();
    let named = |line: &str| line.split(['.', ' ', '=']).next().map(str::to_owned);
    Crate {
        wing,
        name: folder.file_name().expect("a folder").to_string_lossy().into_owned(),
        dependencies: section.lines().skip(1).filter_map(named).collect(),
        folder,
    }
}

#[test]
fn every_crate_stands_in_a_wing() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates");
    for entry in std::fs::read_dir(root).expect("the folder of crates") {
        let name = entry.expect("a listed folder").file_name().to_string_lossy().into_owned();
        assert!(
            WINGS.iter().any(|(wing, _)| *wing == name),
            "crates/{name} is no wing: move it into one of those of ARCHITECTURE.md"
        );
    }
}

#[test]
fn wings_depend_in_one_direction() {
    let crates = crates();
    let wing_of = |name: &str| crates.iter().find(|one| one.name == name).map(|one| one.wing);
    for one in &crates {
        let (_, allowed) = WINGS.iter().find(|(wing, _)| *wing == one.wing).expect("its wing");
        let own = one.dependencies.iter().filter_map(|name| name.strip_prefix("sistership-"));
        for (other, wing) in own.filter_map(|other| Some((other, wing_of(other)?))) {
            assert!(
                wing == one.wing || allowed.contains(&wing),
                "{} ({}) may not depend on {other} ({wing}): move what it needs into a wing below \
                 both, or let the caller pass it (ARCHITECTURE.md, \"Five wings\")",
                one.name,
                one.wing
            );
        }
    }
}

#[test]
fn the_database_and_the_web_are_confined() {
    for one in crates() {
        for (outside, only) in RESTRICTED {
            assert!(
                only.contains(&one.name.as_str()) || !one.dependencies.iter().any(|d| d == outside),
                "{} may not depend on {outside}: do it in one of {only:?}, which may",
                one.name
            );
        }
    }
}

#[test]
fn core_data_and_analysis_do_not_wait() {
    for one in crates().iter().filter(|one| !["service", "app"].contains(&one.wing)) {
        let waits = one.dependencies.iter().find(|name| ASYNC.contains(&name.as_str()));
        assert!(
            waits.is_none(),
            "{} may not depend on {waits:?}: do what waits in the service wing, and pass its result",
            one.name
        );
    }
}

#[test]
fn no_modules_of_a_crate_refer_to_each_other_in_a_circle() {
    let mut found = Vec::new();
    for Crate { name, folder, .. } in crates() {
        let references = modules::references(&folder.join("src"));
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
    assert!(
        found.is_empty(),
        "modules in circles; move what both sides use into a module of its own:\n{}",
        found.join("\n")
    );
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
    let mut found = Vec::new();
    let numerics = crates().into_iter().filter(|one| ["core", "analysis"].contains(&one.wing));
    for (path, text) in numerics.flat_map(|one| modules::texts(&one.folder.join("src"))) {
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
    for one in crates() {
        for (path, text) in modules::texts(&one.folder.join("src")) {
            assert!(!text.lines().any(fenced), "{}: move the code into a test", path.display());
        }
    }
}

#[test]
fn the_language_does_not_get_worse() {
    let mut language = language::Language::default();
    for one in crates() {
        for (path, text) in modules::texts(&one.folder.join("src")) {
            language.add(&path, &text);
        }
    }
    let rows = language.rows();
    for (name, value, bound) in rows {
        println!("{name:<48} {value:8.2} of at most {bound}");
    }
    let worse: Vec<_> = rows.iter().filter(|(_, value, bound)| value > bound).collect();
    assert!(
        worse.is_empty(),
        "{worse:?} (name, value, bound): see \"Style\" in CONTRIBUTING.md for what was added"
    );
}
