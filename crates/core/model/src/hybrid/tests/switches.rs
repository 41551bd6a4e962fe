//! Each rule is a switch.

use super::{declared, names, vectwin};
use crate::Law;
use crate::coefficient::Axis;

/// A single screw and rudder of second order.
fn single(rules: &str) -> super::LawDerivation {
    declared(&format!(
        "order: 2\nactuators: {{ n: {{ kind: propeller }}, delta: {{ kind: rudder }} }}\nrules: {{ \
         {rules} }}\n"
    ))
}

fn sizes(derivation: &super::LawDerivation) -> [usize; 3] {
    [Axis::X, Axis::Y, Axis::N].map(|axis| derivation.law.axes[&axis].terms.len())
}

#[test]
fn without_any_rule_the_whole_expansion_stays() {
    let all = single("constant: true, symmetry: none, trigonometric_powers: keep, squares: plain");
    assert_eq!(sizes(&all), [28, 28, 28]);
    assert!(
        names(&all, Axis::Y).contains("0") && names(&all, Axis::X).contains("sindeltasindelta")
    );
}

#[test]
fn each_rule_takes_what_is_its_own() {
    let has = |rules: &str, axis: Axis, name: &str| names(&single(rules), axis).contains(name);
    for (rules, axis, name) in [
        ("constant: true", Axis::X, "0"),
        ("symmetry: none", Axis::X, "v"),
        ("symmetry: none", Axis::Y, "uu"),
        ("zeroth_powers: true", Axis::Y, "n"),
        ("zeroth_powers: true", Axis::N, "ncosdelta"),
        ("signed_squares: true", Axis::Y, "v|v|"),
        ("signed_squares: true", Axis::N, "r|r|"),
        ("trigonometric_powers: keep", Axis::X, "sindeltasindelta"),
        (
            "trigonometric_exceptions: [{ factor: cosdelta, axes: [X] }]",
            Axis::X,
            "cosdelta|cosdelta|",
        ),
        ("squares: plain", Axis::X, "uu"),
    ] {
        let here = if rules == "symmetry: none" && name == "uu" { "u|u|" } else { name };
        assert!(has(rules, axis, here), "{rules}: {axis}_{here} is missing");
        assert!(!has("", axis, here), "{axis}_{here} is there without {rules}");
    }
}

#[test]
fn one_screw_and_one_rudder_at_second_order() {
    assert_eq!(sizes(&single("")), [13, 12, 12]);
    assert_eq!(sizes(&single("signed_squares: true")), [13, 14, 14]);
}

#[test]
fn actuators_meet_what_they_couple_with() {
    let with = |couples: &str| {
        declared(&format!(
            "order: 2\nactuators:\n  n: {{ kind: propeller }}\n  bow: {{ kind: tunnel_thruster, \
             axes: [Y, N], couples: {couples} }}\nrules: {{ signed_squares: true }}\n"
        ))
    };
    let of_bow = |couples: &str, axis| {
        let all = names(&with(couples), axis);
        all.into_iter().filter(|name| name.contains("bow")).collect::<Vec<_>>()
    };
    assert_eq!(of_bow("none", Axis::Y), ["bow", "bow|bow|"]);
    assert_eq!(of_bow("hull", Axis::Y), ["bow", "bow|bow|", "ubow"]);
    assert_eq!(of_bow("all", Axis::N), ["bow", "bow|bow|", "nbow", "ubow"]);
    assert!(of_bow("all", Axis::X).is_empty());
}

#[test]
fn every_kind_of_actuator_has_its_variables() {
    let ship = declared(
        "order: 1\nactuators:\n  pod: { kind: azimuth, pair: true }\n  delta: { kind: rudder, \
         angle: plain }\n  flap: { kind: rudder, angle: sine_versine }\nrules: { symmetry: none \
         }\n",
    );
    let factors: Vec<&str> = ship.law.factors.keys().map(String::as_str).collect();
    assert_eq!(
        factors,
        [
            "u", "v", "r", "delta", "n_pod_s", "sinpod_s", "cospod_s", "n_pod_p", "sinpod_p",
            "cospod_p", "sinflap", "cosflap"
        ]
    );
    assert_eq!(ship.law_file.values["cosflap"], "1 - cos(flap)");
    let inputs: Vec<&str> = ship.law.inputs.keys().map(String::as_str).collect();
    assert_eq!(inputs, ["n_pod_s", "pod_s", "n_pod_p", "pod_p", "delta", "flap"]);
}

#[test]
fn the_scaling_decides_whether_coefficients_carry_units() {
    let unit = |derivation: &super::LawDerivation| {
        ["X_u|u|", "Y_vn", "N_rcosdelta_s"]
            .map(|name| derivation.law.coefficient_dimension(name).unwrap().to_string())
    };
    assert_eq!(unit(&vectwin(2, "")), ["kg m^-1", "kg", "kg m^2 s^-1"]);
    let scaled =
        declared("order: 2\nactuators: { n: { kind: propeller }, delta: { kind: vectwin } }\n");
    assert_eq!(unit(&scaled), ["1", "1", "1"]);
}

#[test]
fn the_rudder_turns_the_signs_of_its_sines() {
    let law = vectwin(3, "submodels: ahead_astern\n").law;
    for (name, odd) in [
        ("Y_sindelta_s", true),
        ("Y_sindelta_p@astern", true),
        ("X_sindelta_ssindelta_p", false),
        ("X_ucosdelta_s", false),
    ] {
        assert_eq!(law.is_odd_in_rudder(name), odd, "{name}");
    }
}

#[test]
fn submodels_are_those_of_the_algorithms() {
    let when = |scheme: &str| {
        let law = vectwin(1, &format!("submodels: {scheme}\n")).law_file;
        law.submodels
            .into_iter()
            .map(|(name, submodel)| format!("{name}: {}", submodel.when.join(" and ")))
            .collect::<Vec<_>>()
    };
    let stalled = "max(abs(delta_s) - 50*pi/180, abs(delta_p) - 55*pi/180)";
    assert_eq!(when("ahead_astern"), ["astern: u < 0"]);
    assert_eq!(
        when("ahead_stalled_astern"),
        [format!("stalled: u >= 0 and {stalled} >= 0"), "astern: u < 0".into()]
    );
    let four = when("ahead_astern_stalled");
    assert_eq!(
        four[1..],
        [
            format!("astern: u < 0 and {stalled} < 0"),
            format!("astern-stalled: u < 0 and {stalled} >= 0")
        ]
    );
    assert_eq!(
        when("quadrants"),
        [
            "crash-astern: u >= 0 and n < 0",
            "backing: u < 0 and n < 0",
            "crash-ahead: u < 0 and n >= 0"
        ]
    );
    assert!(when("one").is_empty());
}

#[test]
fn deviations_carry_their_shrinkage() {
    let law = vectwin(1, "submodels: ahead_astern\nshrinkage: 9.0\n").law;
    assert_eq!(law.deviation_submodel("X_u@astern").map(|submodel| submodel.shrinkage), Some(9.0));
    assert!(law.deviation_submodel("X_u").is_none());
}

#[test]
fn a_derived_law_is_a_file_like_any_other() {
    let derived = vectwin(3, "submodels: ahead_astern_stalled\n");
    let again = Law::parse("again.yaml", &derived.text).unwrap();
    assert_eq!(again, derived.law);
    let file: crate::law::LawFile = serde_yaml::from_str(&derived.text).unwrap();
    assert_eq!(
        serde_yaml::to_string(&file).unwrap(),
        serde_yaml::to_string(&derived.law_file).unwrap()
    );
    assert_eq!(
        vectwin(3, "submodels: ahead_astern_stalled\n").text,
        derived.text,
        "the same bytes every time"
    );
}
