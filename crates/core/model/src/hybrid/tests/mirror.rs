//! A symmetric ship has mirrored forces in mirrored motion.

use std::collections::BTreeMap;

use super::{LawDerivation, declared};
use crate::coefficient::Axis;

/// Ships that are symmetric under `symmetry: mirror`, with any coefficients.
const SHIPS: [&str; 4] = [
    "actuators: { n: { kind: propeller }, delta: { kind: vectwin } }",
    "actuators: { n: { kind: propeller, pair: true }, delta: { kind: rudder, pair: true }, bow: { \
     kind: tunnel_thruster } }",
    "actuators: { pod: { kind: azimuth, pair: true } }",
    "actuators: { n: { kind: propeller }, delta: { kind: rudder, angle: plain }, bow: { kind: \
     tunnel_thruster, couples: hull } }",
];

/// Numbers between -1 and 1 that are the same every time.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

type Point = BTreeMap<String, f64>;

/// States and inputs of the mirror image: sway and yaw reversed, and what the ship's actuators
/// become.
fn mirrored(point: &Point) -> Point {
    let sides = |name: &str| match name.strip_suffix("_s") {
        Some(stem) => format!("{stem}_p"),
        None => name.strip_suffix("_p").map_or(name.to_owned(), |stem| format!("{stem}_s")),
    };
    let odd = |name: &str| {
        matches!(name, "v" | "r" | "bow") || name.starts_with("delta") || name.starts_with("pod")
    };
    let one =
        |(name, value): (&String, &f64)| (sides(name), if odd(name) { -value } else { *value });
    point.iter().map(one).collect()
}

fn force(
    derivation: &LawDerivation,
    axis: Axis,
    coefficients: &BTreeMap<String, f64>,
    point: &Point,
) -> f64 {
    let law = &derivation.law;
    let value = |name: &String| {
        law.unscaled_regressor(name)
            .unwrap()
            .1
            .value(&|n| evaluate_term(derivation, n, point))
            .unwrap()
    };
    coefficients
        .iter()
        .filter(|(name, _)| name.starts_with(&axis.to_string()))
        .map(|(name, c)| c * value(name))
        .sum()
}

fn evaluate_term(derivation: &LawDerivation, name: &str, point: &Point) -> Option<f64> {
    let known = point.get(name).copied().or((name == "lpp_m").then_some(3.0));
    known.or_else(|| {
        derivation.law.values.get(name)?.value(&|n| evaluate_term(derivation, n, point))
    })
}

/// The largest difference between the forces of mirrored motions and the mirrored forces, and the
/// largest force.
fn asymmetry(derivation: &LawDerivation) -> (f64, f64) {
    let mut numbers = Numbers(7);
    let coefficients =
        derivation.law.coefficient_names().into_iter().map(|name| (name, numbers.next())).collect();
    let (mut worst, mut largest) = (0.0_f64, 0.0_f64);
    for _ in 0..100 {
        let names =
            ["u", "v", "r"].into_iter().chain(derivation.law.inputs.keys().map(String::as_str));
        let point: Point = names.map(|name| (name.to_owned(), numbers.next())).collect();
        let image = mirrored(&point);
        for (axis, sign) in [(Axis::X, 1.0), (Axis::Y, -1.0), (Axis::N, -1.0)] {
            let here = force(derivation, axis, &coefficients, &point);
            worst = worst.max((force(derivation, axis, &coefficients, &image) - sign * here).abs());
            largest = largest.max(here.abs());
        }
    }
    (worst, largest)
}

#[test]
fn mirrored_motion_has_mirrored_forces() {
    for ship in SHIPS {
        for (order, rules) in
            [(2, ""), (3, ""), (2, ", signed_squares: true"), (3, ", squares: plain")]
        {
            let body = format!(
                "order: {order}\n{ship}\nsubmodels: ahead_astern\nrules: {{ symmetry: \
                 mirror{rules} }}\n"
            );
            let (worst, largest) = asymmetry(&declared(&body));
            assert!(worst < 1e-12 * largest && largest > 0.1, "{body}: {worst} of {largest}");
        }
    }
}

#[test]
fn parity_is_enough_where_nothing_is_paired() {
    let body = |squares: &str| {
        format!(
            "order: 3\nactuators: {{ n: {{ kind: propeller }}, delta: {{ kind: rudder }} \
             }}\nrules: {{ squares: {squares} }}\n"
        )
    };
    let (worst, largest) = asymmetry(&declared(&body("as_described")));
    assert!(worst < 1e-12 * largest, "{worst} of {largest}");
    // The equations as printed give Y terms such as v|v|r, which do not change sign in the mirror.
    let (worst, largest) = asymmetry(&declared(&body("as_printed")));
    assert!(worst > 0.01 * largest, "{worst} of {largest}");
}

#[test]
fn the_mirror_keeps_what_differs_between_the_sides() {
    let twin = declared(
        "order: 1\nactuators: { n: { kind: propeller, pair: true } }\nrules: { symmetry: mirror \
         }\n",
    );
    let of = |axis: Axis| {
        twin.law_file.axes[&axis].terms.iter().map(|term| format!("{term:?}")).collect::<String>()
    };
    assert!(of(Axis::X).contains("n_s_bis + n_p_bis"), "{}", of(Axis::X));
    assert!(of(Axis::N).contains("n_s_bis - n_p_bis"), "{}", of(Axis::N));
    let parity = declared("order: 1\nactuators: { n: { kind: propeller, pair: true } }\n");
    assert!(!parity.law.axes[&Axis::N].terms.contains_key("N_n_s"));
}
