//! Exports of a refined model say how far a motion is outside of what its trials covered.
#![allow(clippy::unwrap_used)]

mod shared;

use std::io::Read;
use std::path::Path;
use std::process::Command;

use sistership_export::by_name;
use sistership_model::validity::Region;
use sistership_model::{Model, Zoo};

use shared::plan;
use shared::programs::{compiled, run};

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
    by_name(format).unwrap().write(&plan(zoo, &model(zoo))).unwrap()
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
    let name = plan(&zoo, &model(&zoo)).identifier;
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
    let modelica = by_name("modelica").unwrap().write(&plan(&zoo, &published)).unwrap();
    assert!(!String::from_utf8(modelica).unwrap().contains("outside_range"));
}

fn unpacked(bytes: &[u8], folder: &Path) {
    let mut archive = zip::ZipArchive::new(std::io::Cursor::new(bytes)).unwrap();
    for index in 0..archive.len() {
        let mut file = archive.by_index(index).unwrap();
        let place = folder.join(file.enclosed_name().unwrap());
        std::fs::create_dir_all(place.parent().unwrap()).unwrap();
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).unwrap();
        std::fs::write(place, bytes).unwrap();
    }
}

/// The value reference of a variable in a description.
fn reference(description: &str, name: &str) -> u32 {
    let variable = description.lines().find(|line| line.contains(&format!("name=\"{name}\"")));
    let after = variable.unwrap().split("valueReference=\"").nth(1).unwrap();
    after.split('"').next().unwrap().parse().unwrap()
}

#[test]
fn fmus_have_it_as_an_output() {
    let (zoo, folder) = (Zoo::load_embedded().unwrap(), tempfile::tempdir().unwrap());
    for format in ["fmu2", "fmu3"] {
        let place = folder.path().join(format);
        unpacked(&written(&zoo, format), &place);
        let description = std::fs::read_to_string(place.join("modelDescription.xml")).unwrap();
        let line =
            description.lines().find(|line| line.contains("name=\"outside_range\"")).unwrap();
        assert!(line.contains("causality=\"output\""), "{line}");
        let [u, n, distance] =
            ["u", "n", "outside_range"].map(|name| reference(&description, name).to_string());
        let library = if format == "fmu2" { "linux64" } else { "x86_64-linux" };
        let library = place.join("binaries").join(library).join("kvlcc2_mmg.so");
        if !library.exists() {
            eprintln!("skipped: FMUs made on this machine carry no library");
            return;
        }
        let program = importer(folder.path(), format);
        let mut command = Command::new(program);
        command.arg(library).arg(&place).args(["0".repeat(64), u, n, distance]);
        let points = POINTS.iter().flat_map(|(at, _)| at.map(|value| format!("{value:?}")));
        check(&run(command.args(points)));
    }
}

fn importer(folder: &Path, format: &str) -> std::path::PathBuf {
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR"));
    let program = folder.join(format!("importer-{format}"));
    let output = Command::new("cc")
        .args(["-std=gnu99", "-Wall", "-Wextra", "-Werror", "-O1", "-I"])
        .arg(manifest.join("runtime"))
        .arg(format!("-D{}", format.to_uppercase()))
        .arg(manifest.join("tests/importer/outside_range.c"))
        .args([Path::new("-o"), &program, Path::new("-ldl")])
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    program
}
