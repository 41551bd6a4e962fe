//! The commands of the program: those that take a model, with how they are called, and the others
//! with the reason.

use std::sync::OnceLock;

use sistership_tests::binary;

use super::kinds::Kind;
use super::place::Place;

/// A command that takes a model.
pub struct ModelCommand {
    /// Its name.
    pub name: &'static str,
    /// Calls with a model file; each should succeed after those before it.
    pub calls: fn(&Place, &str, &Kind) -> Vec<Vec<String>>,
}

/// Every command that takes a model file; those that make further models first.
pub const MODEL: &[ModelCommand] = &[
    ModelCommand { name: "diagnose", calls: diagnose },
    ModelCommand { name: "branch", calls: branch },
    ModelCommand { name: "simulate", calls: simulate },
    ModelCommand {
        name: "plan",
        calls: |_, model, _| {
            vec![words(&["plan", "--ship", model, "--budget-min", "40", "--json"])]
        },
    },
    ModelCommand {
        name: "compare",
        calls: |place, model, kind| {
            let later = place.later(kind.has_roll);
            vec![words(&["compare", model, "mariner", "--trials", &later, "--json"])]
        },
    },
    ModelCommand { name: "predict", calls: predict },
    ModelCommand {
        name: "manoeuvre",
        calls: |_, model, _| {
            vec![words(&["manoeuvre", "--model", model, "--turn", "20", "--json"])]
        },
    },
    ModelCommand {
        name: "validate",
        calls: |place, model, kind| {
            let (ship, later) = (place.path("ship.yaml"), place.later(kind.has_roll));
            let call = ["validate", "--model", model, "--ship", &ship, "--trials", &later];
            vec![words(&[&call[..], &["--draws", "4", "--json"]].concat())]
        },
    },
    ModelCommand { name: "refine", calls: refine },
    ModelCommand { name: "export", calls: export },
];

/// Commands that take no model file, and where they are run instead or what they take.
pub const ELSEWHERE: &[(&str, &str)] = &[
    ("similar", "takes a ship"),
    ("init", "takes particulars"),
    ("check", "takes trials"),
    ("import", "takes trials, or a bundle: `served`"),
    ("derive", "takes actuators"),
    ("estimate", "takes a ship, and makes a kind of model: `kinds`"),
    ("zoo", "takes ships that are published"),
    ("demo", "takes nothing"),
    ("serve", "takes a store: `served`"),
    ("health", "takes a server"),
    ("completions", "takes a shell"),
    ("manual", "takes a folder"),
    ("work", "takes a store: `families`"),
    ("ships", "takes a store"),
    ("verify", "takes a version of a store: `served`"),
    ("family", "takes a store: `served`"),
    ("users", "takes a store"),
    ("keys", "takes a store"),
    ("fsck", "takes a store: `served`"),
    ("gc", "takes a store"),
    ("backup", "takes a store"),
    ("restore", "takes a store"),
];

fn words(arguments: &[&str]) -> Vec<String> {
    arguments.iter().map(|word| (*word).to_owned()).collect()
}

/// The model, and those that a diagnosis and a training made of it, as far as they are there.
fn all(model: &str) -> Vec<String> {
    let made = ["-found.yaml", "-branch.yaml"].map(|ending| beside(model, ending));
    let there = made.into_iter().filter(|file| std::path::Path::new(file).is_file());
    std::iter::once(model.to_owned()).chain(there).collect()
}

/// A file that belongs to a model.
fn beside(model: &str, ending: &str) -> String {
    model.replace(".yaml", ending)
}

fn simulate(place: &Place, model: &str, kind: &Kind) -> Vec<Vec<String>> {
    let later = place.later(kind.has_roll);
    let call = ["--trials", &later, "--restart-s", "60", "--json"];
    let one = |model: &String| words(&[&["simulate", "--model", model][..], &call].concat());
    all(model).iter().map(one).collect()
}

/// What a diagnosis finds is a model for the others, too.
fn diagnose(place: &Place, model: &str, kind: &Kind) -> Vec<Vec<String>> {
    let later = place.later(kind.has_roll);
    let (out, report) = (beside(model, "-found.yaml"), beside(model, "-found.html"));
    let call = ["diagnose", "--model", model, "--trials", &later, "--out", &out];
    vec![words(&[&call[..], &["--report", &report, "--json"]].concat())]
}

/// With a band where a refinement has left a posterior.
fn predict(_: &Place, model: &str, _: &Kind) -> Vec<Vec<String>> {
    let text = std::fs::read_to_string(model).unwrap_or_default();
    let call = ["predict", "--model", model, "--duration-s", "60", "--rudder-deg", "10", "--json"];
    let mut calls = vec![words(&call)];
    if text.contains("\nposterior:") {
        calls.push(words(&[&call[..], &["--draws", "8"]].concat()));
    }
    calls
}

/// A correction beside it, from few trials.
fn branch(place: &Place, model: &str, kind: &Kind) -> Vec<Vec<String>> {
    let (out, later) = (beside(model, "-branch.yaml"), place.later(kind.has_roll));
    let call = ["branch", "--model", model, "--trials", &later, "--out", &out];
    vec![words(&[&call[..], &["--kind", "boosted", "--json"]].concat())]
}

/// It is a source like any other.
fn refine(place: &Place, model: &str, kind: &Kind) -> Vec<Vec<String>> {
    let (ship, trials) = (place.path("ship.yaml"), place.seen(2, kind.has_roll));
    let call = ["refine", "--ship", &ship, "--source", model, "--trials", &trials];
    let settings = place.quick();
    let quick = ["--settings", &settings, "--method", "published", "--json"];
    vec![words(&[&call[..], &quick].concat())]
}

fn export(_: &Place, model: &str, _: &Kind) -> Vec<Vec<String>> {
    let one = |model: &String, format: &String| {
        let out = beside(model, &format!(".{format}"));
        words(&["export", model, "--format", format, "--out", &out])
    };
    let of = |model: &String| formats().iter().map(|format| one(model, format)).collect::<Vec<_>>();
    all(model).iter().flat_map(of).collect()
}

/// Every format that the program has for a model, as its refusal of another lists them.
fn formats() -> &'static [String] {
    static FORMATS: OnceLock<Vec<String>> = OnceLock::new();
    FORMATS.get_or_init(|| {
        let refused = binary::run(&["export", "mariner", "--format", "none", "--out", "none"]);
        let text = String::from_utf8_lossy(&refused.stderr).into_owned();
        let listed = text.split("choose one of").nth(1).unwrap_or_else(|| panic!("{text}"));
        let quoted = listed.split('`').skip(1).step_by(2).map(str::to_owned);
        let formats: Vec<String> = quoted.filter(|name| name != "bundle").collect();
        assert!(formats.len() >= 6, "{formats:?}");
        formats
    })
}
