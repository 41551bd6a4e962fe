//! Exports of a refined model say how far a motion is outside of what its trials covered.
#![allow(clippy::unwrap_used)]

mod shared;

use std::process::Command;

use sistership_model::validity::Region;
use sistership_model::{Model, Zoo};

use shared::plan;
use shared::programs::{compiled, run};
use shared::units::{LINUX, reference, unpack};

/// A model whose trials ran from 5 to 8 m/s at 1.4 to 1.6 revolutions a second.
fn model(zoo: &Zoo) -> Model {
    let columns = [
        ("u", vec![5.0, 8.0, 5.0, 8.0]),
        ("n", vec![1.4, 1.4, 1.6, 1.6]),
        ("delta", vec![-0.6, 0.6, 0.6, -0.6]),
    ];
    let columns = columns.map(|(name, column)| (name.to_owned(), column)).into();
    Model { validity: Region::from_samples(&columns), ..zoo.find_model("kvlcc2").unwrap() }
}

fn written(zoo: &Zoo, format: &str) -> Vec<u8> {
    shared::written(zoo, &model(zoo), format)
}

/// Speeds and revolutions, and how far outside they are.
const POINTS: [([f64; 2], f64); 4] =
    [([7.0, 1.5], 0.0), ([8.001, 1.5], 0.0), ([11.0, 1.5], 2.0), ([6.0, 0.0], 14.0)];

fn check(printed: &str) {
    let found: Vec<f64> = printed.lines().map(|line| line.parse().unwrap()).collect();
    assert_eq!(found.len(), POINTS.len(), "{printed}");
    for (found, (at, expected)) in found.iter().zip(POINTS) {
        assert!((found - expected).abs() < 1e-9, "{at:?}: {found}, not {expected}");
    }
}

#[test]
fn c_says_how_far_outside_it_is() {
    let (zoo, folder) = (Zoo::load_embedded().unwrap(), tempfile::tempdir().unwrap());
    let name = plan(&zoo, &model(&zoo), "c").identifier;
    let points: String = POINTS
        .iter()
        .map(|([u, n], _)| format!("    s.u = {u:?}; in.n = {n:?};\n    say();\n"))
        .collect();
    let main = format!(
        "\n#include <stdio.h>\nint main(void)\n{{\n    \
         {name}_state s = {name}_approach_state();\n    \
         {name}_inputs in = {name}_approach_inputs();\n#define say() printf(\"%.17g\\n\", \
         {name}_outside_range(&s, &in))\n{points}    return 0;\n}}\n"
    );
    let code = String::from_utf8(written(&zoo, "c")).unwrap();
    let code = code.replace("#ifdef SISTERSHIP_EXAMPLE", "#ifdef SISTERSHIP_NO_EXAMPLE");
    std::fs::write(folder.path().join("model.c"), code + &main).unwrap();
    check(&compiled(folder.path(), "model.c", &[]));
}

#[test]
fn python_says_how_far_outside_it_is() {
    let there = Command::new("python3").arg("--version").output().is_ok_and(|o| o.status.success());
    if !there {
        eprintln!("skipped: no python3");
        return;
    }
    let (zoo, folder) = (Zoo::load_embedded().unwrap(), tempfile::tempdir().unwrap());
    std::fs::write(folder.path().join("ship.py"), written(&zoo, "python")).unwrap();
    let say = |([u, n], _): &([f64; 2], f64)| {
        format!("print(ship.outside_range([{u:?}] + [0.0]*8, {{**ship.INPUTS, 'n': {n:?}}}))\n")
    };
    let script = format!("import ship\n{}", POINTS.iter().map(say).collect::<String>());
    check(&run(Command::new("python3").current_dir(folder.path()).args(["-c", &script])));
}

#[test]
fn texts_name_the_output_where_a_range_is_known() {
    let zoo = Zoo::load_embedded().unwrap();
    let text = |format: &str| String::from_utf8(written(&zoo, format)).unwrap();
    assert!(text("matlab").contains("function [xdot, U, model, outside_range] = kvlcc2"));
    let modelica = text("modelica");
    assert!(modelica.contains("  output Real outside_range(unit = \"1\")"));
    assert_eq!(modelica.matches("\n  outside_range = ").count(), 1);
    let published = zoo.find_model("kvlcc2").unwrap();
    let modelica = shared::written(&zoo, &published, "modelica");
    assert!(!String::from_utf8(modelica).unwrap().contains("outside_range"));
}

#[test]
fn fmus_have_it_as_an_output() {
    let (zoo, folder) = (Zoo::load_embedded().unwrap(), tempfile::tempdir().unwrap());
    for format in ["fmu2", "fmu3"] {
        let place = folder.path().join(format);
        unpack(&written(&zoo, format), &place);
        let description = std::fs::read_to_string(place.join("modelDescription.xml")).unwrap();
        let line =
            description.lines().find(|line| line.contains("name=\"outside_range\"")).unwrap();
        assert!(line.contains("causality=\"output\""), "{line}");
        let references = ["u", "n", "outside_range"].map(|name| reference(&place, name));
        let option = format!("-D{}", format.to_uppercase());
        let program = LINUX.importer("outside_range", folder.path(), &[&option]);
        let mut command = LINUX.command(&program, &format.replace("fmu", "fmi"), &place);
        command.arg("0".repeat(64)).args(references);
        let points = POINTS.iter().flat_map(|(at, _)| at.map(|value| format!("{value:?}")));
        check(&run(command.args(points)));
    }
}
