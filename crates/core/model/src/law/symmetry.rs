//! Port/starboard symmetry: mirrored motion must give mirrored forces.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet, HashMap};

use super::definition::{Law, indicator_name};
use crate::coefficient::{Axis, CoefficientName};
use sistership_formula::Expr;

/// States and inputs that change sign in the mirror.
const ODD_STATES: [&str; 6] = ["v", "r", "p", "phi", "psi", "delta"];

/// Inputs beyond [`AT`] that also change sign: directions of the wind.
const ODD_INPUTS: [&str; 2] = ["wind_from", "apparent_wind_from"];

/// States at which formulas are evaluated, distinct from zero and from each other, SI.
const TEST_POINTS: [[f64; 8]; 3] = [
    // u, v, r, p, phi, psi, delta, n
    [5.0, 0.7, 0.011, 0.004, 0.05, 0.3, 0.2, 1.2],
    [3.0, -0.4, 0.007, -0.003, 0.02, -0.4, 0.1, 0.8],
    [8.0, 1.1, -0.009, 0.002, -0.03, 0.8, -0.3, 1.7],
];
const POINT_NAMES: [&str; 8] = ["u", "v", "r", "p", "phi", "psi", "delta", "n"];

/// Checks every term and rest; a term whose name declares a bias (`Y_0`, `N_u`) must be one.
pub fn check_law(law: &Law) -> Result<(), (String, String)> {
    for (first, second) in &law.mirrors {
        let second = second.trim_start_matches('-');
        let both = |known: &dyn Fn(&str) -> bool| known(first) && known(second);
        if !both(&|name| law.parameters.contains_key(name))
            && !both(&|name| law.inputs.contains_key(name))
        {
            return Err((
                format!("mirrors.{first}"),
                "both must be parameters of the law, or both inputs".into(),
            ));
        }
    }
    let places = MirrorPairs::new(law);
    let factors: BTreeMap<&str, Option<bool>> = law
        .factors
        .iter()
        .map(|(symbol, expr)| (symbol.as_str(), formula_parity(&places, expr)))
        .collect();
    for name in law.submodels.keys() {
        check_parity(
            &places,
            &Expr::Name(indicator_name(name)),
            false,
            &format!("submodels.{name}"),
        )?;
    }
    for (axis, axis_law) in &law.axes {
        check_parity(&places, &axis_law.rest, axis.is_odd(), &format!("axes.{axis}.rest"))?;
        for (name, term) in &axis_law.terms {
            let field = format!("axes.{axis}.terms.{name}");
            check_parity(&places, term, spelled_parity(law, &factors, name, *axis), &field)?;
        }
    }
    Ok(())
}

/// Returns true if the product of a name's factors is odd in the mirror. If one of them is neither
/// odd nor even, such as the angle of one rudder of a pair, the name cannot declare a bias and the
/// parity of the axis applies.
fn spelled_parity(
    law: &Law,
    factors: &BTreeMap<&str, Option<bool>>,
    name: &str,
    axis: Axis,
) -> bool {
    let Ok(parsed) = CoefficientName::parse(name, &law.extra_factors()) else {
        return axis.is_odd();
    };
    // The parity of a factor that only explicit formulas use follows from its symbol.
    let of_symbol = |symbol: &String| {
        factors
            .get(symbol.as_str())
            .copied()
            .unwrap_or_else(|| Some(ODD_STATES.contains(&symbol.as_str())))
    };
    let plain = parsed.factors.iter().filter(|f| !f.absolute).map(|f| of_symbol(&f.symbol));
    let odd = plain.collect::<Option<Vec<bool>>>();
    odd.map_or(axis.is_odd(), |odd| odd.into_iter().filter(|odd| *odd).count() % 2 == 1)
}

fn check_parity(
    places: &MirrorPairs<'_>,
    expr: &Expr,
    odd: bool,
    field: &str,
) -> Result<(), (String, String)> {
    // A formula that vanishes at all points has either parity.
    let vanishes = places.0.iter().all(|[here, _]| here.evaluate_formula(expr) == Some(0.0));
    if vanishes || formula_parity(places, expr) == Some(odd) {
        return Ok(());
    }
    let wanted = if odd { "change its sign" } else { "stay as it is" };
    let message = format!(
        "breaks the port/starboard symmetry: mirrored (v, r, p, phi, delta with other signs) it \
         should {wanted}"
    );
    Err((field.to_owned(), message))
}

/// Returns the parity of a formula in the mirror: odd (`Some(true)`), even (`Some(false)`) or
/// neither.
fn formula_parity(places: &MirrorPairs<'_>, expr: &Expr) -> Option<bool> {
    let parity = |sign: f64| {
        places.0.iter().all(|[here, there]| {
            match (here.evaluate_formula(expr), there.evaluate_formula(expr)) {
                (Some(here), Some(there)) => {
                    (here - sign * there).abs() <= 1e-9 * (here.abs() + there.abs())
                }
                // A point without a value says nothing about the parity.
                _ => true,
            }
        })
    };
    match (parity(1.0), parity(-1.0)) {
        (true, _) => Some(false),
        (false, true) => Some(true),
        _ => None,
    }
}

impl Law {
    /// Returns true if a coefficient's regressor changes sign with the rudder: by `delta`, or by a
    /// factor of the law that does, such as its sine.
    pub fn is_odd_in_rudder(&self, coefficient: &str) -> bool {
        let odd: BTreeSet<&str> = self.odd_factors_in_rudder().collect();
        self.is_odd_in(coefficient, &odd)
    }

    /// Factors of the law that change sign with the rudder.
    pub(crate) fn odd_factors_in_rudder(&self) -> impl Iterator<Item = &str> {
        let own = self.factors.iter().filter(|(_, expr)| is_formula_odd_in_rudder(self, expr));
        own.map(|(symbol, _)| symbol.as_str()).chain(["delta"])
    }

    /// Returns true if a coefficient's regressor changes sign with the factors in `odd`.
    pub(crate) fn is_odd_in(&self, coefficient: &str, odd: &BTreeSet<&str>) -> bool {
        let Ok(name) = CoefficientName::parse(coefficient, &self.extra_factors()) else {
            return false;
        };
        name.factors
            .iter()
            .filter(|factor| !factor.absolute && odd.contains(factor.symbol.as_str()))
            .count()
            % 2
            == 1
    }
}

/// Returns true if a formula changes sign with every rudder angle, `delta` or one of a pair, at
/// otherwise equal values.
fn is_formula_odd_in_rudder(law: &Law, expr: &Expr) -> bool {
    let rudders =
        || law.inputs.keys().filter(|name| *name == "delta" || name.starts_with("delta_"));
    let value = |point: &[f64; 8], sign: f64| {
        let mut place = SymmetryPoint::new(law, point, false);
        // Each rudder has a different angle, so that their sum cannot cancel.
        place.known.extend(
            rudders().enumerate().map(|(k, name)| (name.as_str(), sign * (0.2 + 0.1 * k as f64))),
        );
        place.evaluate_formula(expr)
    };
    TEST_POINTS.iter().all(|point| match (value(point, 1.0), value(point, -1.0)) {
        (Some(here), Some(there)) => here != 0.0 && (here + there).abs() <= 1e-9 * here.abs(),
        _ => false,
    })
}

/// The ship in one of the points, or its mirror image, with the values that were evaluated there,
/// each once.
struct SymmetryPoint<'a> {
    law: &'a Law,
    known: BTreeMap<&'a str, f64>,
    mirrored: bool,
    values: RefCell<HashMap<&'a str, f64>>,
}

impl<'a> SymmetryPoint<'a> {
    fn new(law: &'a Law, point: &[f64; 8], mirrored: bool) -> Self {
        let mut known: BTreeMap<&str, f64> =
            POINT_NAMES.iter().copied().zip(point.iter().copied()).collect();
        if mirrored {
            for name in ODD_STATES {
                known.entry(name).and_modify(|value| *value = -*value).or_insert(0.0);
            }
        }
        Self { law, known, mirrored, values: RefCell::default() }
    }

    fn evaluate_formula(&self, expr: &Expr) -> Option<f64> {
        expr.value(&|name| self.name_value(name))
    }

    fn name_value(&self, name: &str) -> Option<f64> {
        if let Some(value) = self.known.get(name).or(self.values.borrow().get(name)) {
            return Some(*value);
        }
        let Some((name, expr)) = self.law.values.get_key_value(name) else {
            return Some(arbitrary_value(self.law, name, self.mirrored));
        };
        let value = self.evaluate_formula(expr)?;
        self.values.borrow_mut().insert(name, value);
        Some(value)
    }
}

/// Pairs of a point and its mirror image.
struct MirrorPairs<'a>(Vec<[SymmetryPoint<'a>; 2]>);

impl<'a> MirrorPairs<'a> {
    fn new(law: &'a Law) -> Self {
        Self(
            TEST_POINTS
                .iter()
                .map(|point| [false, true].map(|mirrored| SymmetryPoint::new(law, point, mirrored)))
                .collect(),
        )
    }
}

/// Arbitrary number for a particular or parameter, which differs from name to name.
fn arbitrary_value(law: &Law, name: &str, mirrored: bool) -> f64 {
    if let Some((value, _)) = sistership_formula::builtin_constant(name) {
        return value;
    }
    let twin = if mirrored { mirror_twin(law, name) } else { None };
    let (sign, name) = twin.unwrap_or((1.0, name));
    let sign = if mirrored && ODD_INPUTS.contains(&name) { -sign } else { sign };
    let hash =
        name.bytes().fold(7_u32, |hash, byte| hash.wrapping_mul(31).wrapping_add(u32::from(byte)));
    sign * (0.2 + f64::from(hash % 997) / 997.0)
}

/// Returns the name that a parameter or input becomes in the mirror, with its sign: another one
/// (`gamma_R_minus`), its own opposite (`-c_Pr`), or the opposite of another (`-delta_p`).
fn mirror_twin<'a>(law: &'a Law, name: &str) -> Option<(f64, &'a str)> {
    law.mirrors.iter().find_map(|(a, b)| {
        let (sign, b) = b.strip_prefix('-').map_or((1.0, b.as_str()), |positive| (-1.0, positive));
        if a == name { Some((sign, b)) } else { (b == name).then_some((sign, a.as_str())) }
    })
}
