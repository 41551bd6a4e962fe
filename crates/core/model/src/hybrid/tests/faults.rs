//! Bad declarations are refused with file, line and field.

use super::super::derive_law;
use super::with_head;

const GOOD: &str = "order: 2
actuators:
  n: { kind: propeller }
  delta: { kind: rudder, stall_deg: 35 }
  bow: { kind: tunnel_thruster, couples: none, axes: [Y, N] }
rules: { symmetry: parity }
submodels: ahead_stalled_astern
";

fn refused(from: &str, to: &str) -> String {
    assert!(GOOD.contains(from), "{from}");
    derive_law("bad.yaml", &with_head(&GOOD.replace(from, to))).unwrap_err().to_string()
}

#[test]
fn the_fault_is_named_with_its_place() {
    let cases = [
        ("order: 2", "order: 9", "bad.yaml:4: order: must be from 1 to 4"),
        ("order: 2", "order: 2\nshrinkage: 0", "shrinkage: must be above 0"),
        ("n: { kind: propeller }", "n: { kind: rudder }", "the input `n` is in rps everywhere"),
        (
            "n: { kind: propeller }",
            "u: { kind: propeller }",
            "bad.yaml:6: actuators.u: `u` has another meaning",
        ),
        (
            "n: { kind: propeller }",
            "draught_m: { kind: propeller }",
            "has another meaning in formulas",
        ),
        ("n: { kind: propeller }", "2n: { kind: propeller }", "letters, digits and underscores"),
        (
            "n: { kind: propeller }",
            "n: { kind: sail }",
            "actuators.n.kind: is `sail`, but should be one of `propeller`",
        ),
        (
            "n: { kind: propeller }",
            "n: { kind: propeller, angle: plain }",
            "actuators.n.angle: it has no angle",
        ),
        (
            "n: { kind: propeller }",
            "n: { kind: propeller, stall_deg: 30 }",
            "actuators.n.stall_deg: only rudders can stall",
        ),
        (
            "stall_deg: 35",
            "stall_deg: 200",
            "actuators.delta.stall_deg: must be above 0 and below 180 deg",
        ),
        (", stall_deg: 35", "", "submodels: this scheme distinguishes rudders by their stall"),
        ("couples: none", "pair: true", "actuators.bow.pair"),
        ("axes: [Y, N]", "axes: [K]", "actuators.bow.axes: give at least one of X, Y and N"),
        ("axes: [Y, N]", "axes: []", "actuators.bow.axes"),
        ("symmetry: parity", "symmetry: mirror, zeroth_powers: true", "rules.zeroth_powers"),
        ("symmetry: parity", "symmetry: mirror, squares: as_printed", "rules.squares"),
        (
            "symmetry: parity",
            "trigonometric_exceptions: [{ factor: cosgamma, axes: [Y] }]",
            "choose one of sindelta, cosdelta",
        ),
        (
            "ahead_stalled_astern",
            "{ astern: { when: [w < 0], meaning: astern } }",
            "submodels.astern: `w < 0` unknown name `w`",
        ),
        (
            "ahead_stalled_astern",
            "{ Astern: { when: [u < 0], meaning: astern } }",
            "submodels.Astern",
        ),
        (
            "ahead_stalled_astern",
            "{ port: { when: [v < 0], meaning: drifting } }",
            "submodels.port: breaks the port/starboard",
        ),
        ("actuators:", "actors:", "actors: is not a field"),
    ];
    for (from, to, message) in cases {
        let error = refused(from, to);
        assert!(error.contains(message) && error.starts_with("bad.yaml"), "{to}: {error}");
    }
}

#[test]
fn quadrants_need_one_propeller() {
    let text =
        "order: 1\nactuators: { n: { kind: propeller, pair: true } }\nsubmodels: quadrants\n";
    let error = derive_law("bad.yaml", &with_head(text)).unwrap_err().to_string();
    assert!(
        error.contains("bad.yaml:6: submodels: `quadrants` needs one single propeller"),
        "{error}"
    );
}

#[test]
fn names_that_could_be_mistaken_are_refused() {
    let text = "order: 2\nactuators: { n: { kind: propeller }, nn: { kind: propeller } }\n";
    let error = derive_law("bad.yaml", &with_head(text)).unwrap_err().to_string();
    assert!(error.contains("bad.yaml:5: actuators: their names make `X_n"), "{error}");
}

#[test]
fn an_expansion_without_end_is_refused() {
    let azimuths: Vec<String> =
        (0..6).map(|k| format!("a{k}: {{ kind: azimuth, pair: true }}")).collect();
    let text = format!("order: 4\nactuators: {{ {} }}\n", azimuths.join(", "));
    let error = derive_law("bad.yaml", &with_head(&text)).unwrap_err().to_string();
    assert!(error.contains("order: 39 variables to order 4"), "{error}");
}
