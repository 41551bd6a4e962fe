//! Families of terms that are fitted: the source's own terms, or all that the law's factors allow.

use serde::{Deserialize, Serialize};
use sistership_model::Model;
use sistership_model::coefficient::{Axis, CoefficientName};
use sistership_model::law::Law;
use sistership_model::quantity::Quantity;

/// A set of terms among which model selection chooses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[derive(schemars::JsonSchema)]
#[schemars(rename = "TermFamily")]
pub enum TermFamily {
    /// The source's own terms.
    Own,
    /// The source's own terms without those that break the symmetry of port and starboard, such as
    /// `Y_0` or `N_uu`.
    Symmetric,
    /// The symmetric terms, and every product of up to three of `u`, `v`, `r`, `phi` and `delta`
    /// that the law's factors allow and that has the symmetry of its axis; roll rate and the moment
    /// of heel enter linearly.
    ThirdOrder,
    /// The third-order terms, the source's own, and terms up to second order that break the
    /// symmetry of port and starboard: forces of a propeller to one side, a rudder that is not
    /// amidships, a hull that is not symmetric.
    Asymmetric,
}

/// Factors that may enter powers and products on an axis.
const PRODUCTS: [&str; 4] = ["v", "r", "phi", "delta"];
/// Factors that enter linearly only, where the law has them: in products they are redundant with
/// `phi`, or have too little effect.
const LINEAR: [&str; 2] = ["p", "heel"];

impl TermFamily {
    /// Every family, from the source's terms outwards.
    pub(super) const ALL: [Self; 4] =
        [Self::Own, Self::Symmetric, Self::ThirdOrder, Self::Asymmetric];

    /// Name for tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Own => "all terms of the law",
            Self::Symmetric => "symmetric terms",
            Self::ThirdOrder => "third order",
            Self::Asymmetric => "asymmetric terms",
        }
    }

    /// Returns a model with these terms; added terms start at zero. `None` if that changes nothing.
    pub fn extend_model(self, model: &Model, law: &Law) -> Option<Model> {
        let mut changed = model.clone();
        if matches!(self, Self::Symmetric | Self::ThirdOrder) {
            changed.coefficients.retain(|name, _| !breaks_symmetry(name, law));
        }
        let terms = match self {
            Self::Own | Self::Symmetric => Vec::new(),
            Self::ThirdOrder => third_order_terms(law),
            Self::Asymmetric => {
                third_order_terms(law).into_iter().chain(asymmetric_terms(law)).collect()
            }
        };
        for name in terms {
            changed.coefficients.entry(name).or_insert_with(added_term);
        }
        // Another family with the same terms would only repeat the candidates of `Own`.
        (self == Self::Own || changed != *model).then_some(changed)
    }
}

/// All third-order terms of a law that act on a ship that stays upright: none of roll, none with a
/// factor of heel.
pub(super) fn terms_without_heel(law: &Law) -> Vec<String> {
    let extra = law.extra_factors();
    let is_upright = |name: &String| {
        let heels = |symbol: &str| symbol == "phi" || LINEAR.contains(&symbol);
        CoefficientName::parse(name, &extra).is_ok_and(|parsed| {
            let has_heel = parsed.factors.iter().any(|factor| heels(&factor.symbol));
            parsed.axis != Axis::K && !has_heel
        })
    };
    third_order_terms(law).into_iter().filter(is_upright).collect()
}

/// A coefficient that was not in the source.
fn added_term() -> Quantity {
    Quantity::new(0.0, "term added")
}

/// Returns true if a coefficient breaks the symmetry of port and starboard: the number of its odd
/// factors does not fit the axis, so that mirrored motion would not give mirrored forces.
fn breaks_symmetry(name: &str, law: &Law) -> bool {
    let Ok(parsed) = CoefficientName::parse(name, &law.extra_factors()) else { return false };
    // Factors are odd if they change sign when the motion is mirrored: all but these, unless their
    // absolute value enters.
    let odd = |symbol: &str| !matches!(symbol, "u" | "n" | "cosdelta");
    let count =
        parsed.factors.iter().filter(|factor| !factor.absolute && odd(&factor.symbol)).count();
    (count % 2 == 1) != parsed.axis.is_odd()
}

/// All third-order terms of the open axes.
fn third_order_terms(law: &Law) -> Vec<String> {
    let known = |symbol: &&&str| law.factors.contains_key(**symbol);
    let products: Vec<&str> = PRODUCTS.iter().filter(known).copied().collect();
    let linear: Vec<&str> = LINEAR.iter().filter(known).copied().collect();
    available_terms(law, |axis| match axis.is_odd() {
        true => odd_terms(&products, &linear),
        false => even_terms(&products),
    })
}

/// Asymmetric terms of the open axes: for sway, roll and yaw a constant, its product with the
/// speed, and the even products; for surge the odd factors.
fn asymmetric_terms(law: &Law) -> Vec<String> {
    let known = |symbol: &&&str| law.factors.contains_key(**symbol);
    let products: Vec<&str> = PRODUCTS.iter().filter(known).copied().collect();
    available_terms(law, |axis| match axis.is_odd() {
        true => {
            let constant = ["0", "u"].into_iter().map(str::to_owned);
            constant.chain(monomials(&products, 2)).collect()
        }
        false => monomials(&products, 1),
    })
}

/// Names of the given terms of each open axis that the law can evaluate.
fn available_terms(law: &Law, terms: impl Fn(Axis) -> Vec<String>) -> Vec<String> {
    let open = law.axes.iter().filter(|(_, axis)| axis.open).map(|(axis, _)| *axis);
    let of_axis = |axis: Axis| {
        let names = terms(axis).into_iter().map(move |factors| format!("{axis}_{factors}"));
        names.filter(|name| law.unscaled_regressor(name).is_ok()).collect::<Vec<_>>()
    };
    open.flat_map(of_axis).collect()
}

/// Terms of an axis whose force changes sign with the mirrored motion: single factors, their
/// products with `u` and `uu`, and third-order products.
fn odd_terms(products: &[&str], linear: &[&str]) -> Vec<String> {
    let singles = products.iter().chain(linear).map(|s| (*s).to_owned());
    let with_u = products.iter().flat_map(|s| [format!("u{s}"), format!("uu{s}")]);
    singles.chain(with_u).chain(monomials(products, 3)).collect()
}

/// Terms of an axis whose force is the same for the mirrored motion: powers of `u`, second-order
/// products, and these times `u`.
fn even_terms(products: &[&str]) -> Vec<String> {
    let squares = monomials(products, 2);
    let with_u = squares.iter().map(|s| format!("u{s}")).collect::<Vec<_>>();
    ["0", "u", "uu", "uuu"].into_iter().map(str::to_owned).chain(squares).chain(with_u).collect()
}

/// All products of `degree` factors, with repetition, in the order of the factors.
fn monomials(factors: &[&str], degree: usize) -> Vec<String> {
    if degree == 0 {
        return vec![String::new()];
    }
    let from = |(i, first): (usize, &&str)| {
        let rest = monomials(&factors[i..], degree - 1);
        rest.into_iter().map(|rest| format!("{first}{rest}")).collect::<Vec<_>>()
    };
    factors.iter().enumerate().flat_map(from).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use sistership_model::Zoo;

    #[test]
    fn families_of_the_mariner() {
        let zoo = Zoo::load_embedded().unwrap();
        let (model, law) = (zoo.find_model("mariner").unwrap(), zoo.law("abkowitz").unwrap());
        let symmetric = TermFamily::Symmetric.extend_model(&model, law).unwrap();
        let dropped: Vec<&str> = model
            .coefficients
            .keys()
            .filter(|name| !symmetric.coefficients.contains_key(*name))
            .map(String::as_str)
            .collect();
        assert_eq!(dropped, ["N_0", "N_u", "N_uu", "Y_0", "Y_u", "Y_uu"]);
        assert_eq!(TermFamily::Symmetric.extend_model(&symmetric, law), None);
        let third = TermFamily::ThirdOrder.extend_model(&model, law).unwrap();
        for name in ["Y_vrr", "N_rrdelta", "X_rdelta", "Y_vrdelta", "N_ur"] {
            assert!(third.coefficients.contains_key(name), "{name}");
        }
        assert!(third.coefficients.iter().all(|(name, q)| q.value == model.coefficient(name)));
    }

    #[test]
    fn asymmetric_terms_are_added_to_those_of_third_order() {
        let zoo = Zoo::load_embedded().unwrap();
        let (model, law) = (zoo.find_model("mariner").unwrap(), zoo.law("abkowitz").unwrap());
        let [third, asymmetric] = [TermFamily::ThirdOrder, TermFamily::Asymmetric]
            .map(|f| f.extend_model(&model, law).unwrap());
        assert!(third.coefficients.keys().all(|name| asymmetric.coefficients.contains_key(name)));
        let more: Vec<&String> = asymmetric
            .coefficients
            .keys()
            .filter(|name| !third.coefficients.contains_key(*name))
            .collect();
        assert!(more.iter().all(|name| breaks_symmetry(name, law)), "{more:?}");
        for name in ["Y_0", "N_0", "Y_vr", "N_rr", "N_deltadelta", "X_delta"] {
            assert!(asymmetric.coefficients.contains_key(name), "{name}");
        }
        assert_eq!(asymmetric.coefficient("N_0"), model.coefficient("N_0"), "the source's own");
    }

    #[test]
    fn terms_without_heel_are_those_of_the_law_without_roll() {
        let zoo = Zoo::load_embedded().unwrap();
        let [plane, rolling] = ["abkowitz", "abkowitz-roll"].map(|name| zoo.law(name).unwrap());
        assert_eq!(terms_without_heel(rolling), third_order_terms(plane));
        assert!(third_order_terms(rolling).len() > third_order_terms(plane).len());
    }

    #[test]
    fn monomials_are_spelled_as_names_are() {
        assert_eq!(monomials(&["v", "r"], 3), ["vvv", "vvr", "vrr", "rrr"]);
    }
}
