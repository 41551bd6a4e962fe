//! Packages of SSP: their parts agree, and FMPy and the Open Simulation Platform sail them with
//! values varied as we do, where a Python with these is installed.
#![allow(clippy::unwrap_used)]

mod shared;

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

use sistership_model::Zoo;

use shared::programs::run;
use shared::units::unpack;
use shared::{Circle, Track, exported, largest, own, sailed, ship};

/// Attribute of the elements of a kind, by their names.
fn attributes(text: &str, element: &str, attribute: &str) -> BTreeMap<String, String> {
    let value = |line: &str, name: &str| -> Option<String> {
        line.split(&format!(" {name}=\"")).nth(1)?.split('"').next().map(str::to_owned)
    };
    let lines = text.lines().filter(|line| line.trim_start().starts_with(element));
    lines.filter_map(|line| Some((value(line, "name")?, value(line, attribute)?))).collect()
}

#[test]
fn values_are_those_of_the_unit() {
    let (zoo, folder) = (Zoo::load_embedded().unwrap(), tempfile::tempdir().unwrap());
    unpack(&exported(&zoo, "kvlcc2", "ssp"), folder.path());
    let read = |place: &str| std::fs::read_to_string(folder.path().join(place)).unwrap();
    let unit = std::fs::read(folder.path().join("resources/kvlcc2_mmg.fmu")).unwrap();
    unpack(&unit, &folder.path().join("unit"));
    let description = read("unit/modelDescription.xml");
    let causality = attributes(&description, "<ScalarVariable", "causality");
    let start = attributes(&description, "<ScalarVariable", "start");
    let values = attributes(&read("resources/parameters.ssv"), "<ssv:Parameter ", "value");
    let settable = |name: &String| matches!(causality[name].as_str(), "parameter" | "input");
    let expected: BTreeMap<_, _> = start.into_iter().filter(|(name, _)| settable(name)).collect();
    assert_eq!(values, expected);
    assert!(["N_r", "t_P", "lpp_m", "rudder_rate", "n"].iter().all(|n| values.contains_key(*n)));
    let kinds = attributes(&read("SystemStructure.ssd"), "<ssd:Connector ", "kind");
    let inner: BTreeMap<_, _> = causality.into_iter().filter(|(_, kind)| kind != "local").collect();
    assert_eq!(kinds, inner);
}

#[test]
fn public_tools_sail_what_is_varied() {
    let Ok(python) = std::env::var("SISTERSHIP_FMPY") else {
        eprintln!("skipped: SISTERSHIP_FMPY names no Python with FMPy");
        return;
    };
    let (zoo, folder) = (Zoo::load_embedded().unwrap(), tempfile::tempdir().unwrap());
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/importer/by_ssp.py");
    let file = folder.path().join("kvlcc2.ssp");
    std::fs::write(&file, exported(&zoo, "kvlcc2", "ssp")).unwrap();
    let circle = Circle::of(&zoo, "kvlcc2", 10.0);
    let mut model = zoo.find_model("kvlcc2").unwrap();
    model.coefficients.get_mut("N_r").unwrap().value *= 1.1;
    let varied = format!("N_r={:?}", model.coefficients["N_r"].value);
    let expected = sailed(&ship(&zoo, &model), &circle);
    let unvaried = own(&zoo, "kvlcc2", &circle);
    for tool in ["fmpy", "osp"] {
        let there = Command::new(&python).args(["-c", "import libcosimpy"]).status().unwrap();
        if tool == "osp" && !there.success() {
            eprintln!("skipped: no libcosimpy");
            continue;
        }
        let mut command = Command::new(&python);
        command.arg(&script).arg(tool).arg(&file).args(circle.arguments()).arg(&varied);
        let found = Track::read(&run(&mut command));
        let difference = largest(&circle, &found, &expected);
        println!("{tool}: {difference:.1e}");
        assert!(difference < 1e-6, "{tool}: {difference:e}");
        assert!(largest(&circle, &found, &unvaried) > 1e-3, "{tool} varied the coefficient");
    }
}
