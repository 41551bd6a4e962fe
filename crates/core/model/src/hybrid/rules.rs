//! Selection and notation of the terms of the expansion: Miyauchi 2024, sec. 2.2.2, one function
//! for each rule.

use super::actuators::ExpansionVariable;
use super::file::{Coupling, Rules, Squares, Symmetry, TrigonometricPowers};
use super::monomial::Monomial;
use crate::coefficient::Axis;

/// Term: a monomial, or the sum or difference of two that are mirror images of each other.
#[derive(Debug, Clone, PartialEq)]
pub struct HybridTerm {
    /// The monomial, which gives the coefficient its name.
    pub monomial: Monomial,
    /// Its mirror image, and true if that is subtracted.
    pub image: Option<(Monomial, bool)>,
}

/// Result of one rule.
#[derive(Debug, Clone, PartialEq)]
pub struct SelectionStep {
    /// The rule.
    pub rule: &'static str,
    /// Setting of the rule.
    pub setting: String,
    /// Numbers of terms after it on X, Y and N.
    pub terms: [usize; 3],
}

/// Axes of the hybrid.
pub const HYBRID_AXES: [Axis; 3] = [Axis::X, Axis::Y, Axis::N];

/// Applies the rules one after another; returns the terms by axis, in the order of [`AXES`], and
/// the result of each rule.
pub fn select_terms(
    all: &[Monomial],
    rules: &Rules,
    variables: &[ExpansionVariable],
    setting: &str,
) -> ([Vec<HybridTerm>; 3], Vec<SelectionStep>) {
    let alone = |monomial: &Monomial| HybridTerm { monomial: monomial.clone(), image: None };
    let mut terms = HYBRID_AXES.map(|_| all.iter().map(alone).collect::<Vec<HybridTerm>>());
    let mut steps = vec![SelectionStep {
        rule: "Taylor expansion",
        setting: setting.to_owned(),
        terms: terms.each_ref().map(Vec::len),
    }];
    let selector = TermSelector { rules, variables };
    for (rule, setting, apply) in selector.ordered_rules() {
        for (axis, terms) in HYBRID_AXES.into_iter().zip(&mut terms) {
            *terms = terms.drain(..).filter_map(|term| apply(&selector, axis, term)).collect();
        }
        steps.push(SelectionStep { rule, setting, terms: terms.each_ref().map(Vec::len) });
    }
    (terms, steps)
}

type RuleFunction<'a> = fn(&TermSelector<'a>, Axis, HybridTerm) -> Option<HybridTerm>;

struct TermSelector<'a> {
    rules: &'a Rules,
    variables: &'a [ExpansionVariable],
}

impl<'a> TermSelector<'a> {
    /// The rules in order, with their settings in words.
    fn ordered_rules(&self) -> [(&'static str, String, RuleFunction<'a>); 5] {
        let constant = if self.rules.constant { "keep" } else { "drop" };
        [
            ("force at rest", constant.into(), Self::apply_constant),
            ("axes and couplings", "as declared".into(), Self::apply_reach),
            ("A: symmetry", describe_symmetry(self.rules), Self::apply_symmetry),
            (
                "B: powers of sines and cosines",
                describe_powers(self.rules),
                Self::apply_trigonometric,
            ),
            ("C: squares", describe_squares(self.rules).into(), Self::apply_squares),
        ]
    }

    /// Rule of the force at rest, the first term of Eq. 7.
    fn apply_constant(&self, _: Axis, term: HybridTerm) -> Option<HybridTerm> {
        (self.rules.constant || term.monomial.degree() > 0).then_some(term)
    }

    /// Rule of couplings: actuators act on their axes only, and multiply only the variables with
    /// which they couple.
    fn apply_reach(&self, axis: Axis, term: HybridTerm) -> Option<HybridTerm> {
        let places =
            || term.monomial.powers.iter().map(|&(place, _)| &self.variables[place].actuator);
        let allowed = places().flatten().all(|one| {
            // `All` meets everything, `Hull` the motion, and every actuator itself.
            let met = |other: &Option<super::actuators::ActuatorReach>| match (one.couples, other) {
                (Coupling::All, _) => true,
                (Coupling::Hull, None) => true,
                (_, other) => other.as_ref().is_some_and(|other| other.name == one.name),
            };
            one.axes.as_ref().is_none_or(|axes| axes.contains(&axis)) && places().all(met)
        });
        allowed.then_some(term)
    }

    /// Rule of symmetry, modification A.
    fn apply_symmetry(&self, axis: Axis, term: HybridTerm) -> Option<HybridTerm> {
        let image = term.monomial.with_sides_exchanged(self.variables);
        let fits = term.monomial.is_odd(self.variables) == axis.is_odd();
        match self.rules.symmetry {
            Symmetry::None => Some(term),
            // Of two mirror images one represents both; their sum or difference has the parity of
            // the axis.
            Symmetry::Mirror if image != term.monomial => {
                let first = term.monomial < image;
                first.then_some(HybridTerm { image: Some((image, !fits)), ..term })
            }
            _ if fits || self.is_bias(axis, &term.monomial) => Some(term),
            _ => self.with_signed_square(axis, term),
        }
    }

    /// Returns true for a term without odd factors on an odd axis, if such biases are kept.
    fn is_bias(&self, axis: Axis, monomial: &Monomial) -> bool {
        let even = || monomial.powers.iter().all(|&(place, _)| !self.variables[place].odd);
        self.rules.zeroth_powers && axis.is_odd() && even()
    }

    /// Replaces `v^2` by `v|v|`, if that gives the term the parity of its axis.
    fn with_signed_square(&self, axis: Axis, mut term: HybridTerm) -> Option<HybridTerm> {
        // The first square of an odd variable is changed.
        let square = term.monomial.squared_variables().find(|&place| self.variables[place].odd)?;
        term.monomial.moduli.insert(square);
        (self.rules.signed_squares && term.monomial.is_odd(self.variables) == axis.is_odd())
            .then_some(term)
    }

    /// Rule of the powers of sines and cosines, modification B.
    fn apply_trigonometric(&self, axis: Axis, term: HybridTerm) -> Option<HybridTerm> {
        let drops = self.rules.trigonometric_powers == TrigonometricPowers::Drop;
        let excepted = |place: usize, power: u32| {
            let named = |of: &&super::file::ExceptionFile| {
                of.factor == self.variables[place].symbol && of.axes.contains(&axis)
            };
            power == 2
                && self.rules.trigonometric_exceptions.iter().any(|exception| named(&exception))
        };
        let goes = |&(place, power): &(usize, u32)| {
            power > 1 && self.variables[place].trigonometric && !excepted(place, power)
        };
        (!drops || !term.monomial.powers.iter().any(goes)).then_some(term)
    }

    /// Rule of squares, modification C.
    fn apply_squares(&self, axis: Axis, mut term: HybridTerm) -> Option<HybridTerm> {
        self.mark_moduli(axis, &mut term.monomial);
        if let Some((image, _)) = &mut term.image {
            self.mark_moduli(axis, image);
        }
        Some(term)
    }

    fn mark_moduli(&self, axis: Axis, monomial: &mut Monomial) {
        let wanted = match self.rules.squares {
            Squares::Plain => return,
            Squares::AsPrinted => axis.is_odd(),
            Squares::AsDescribed => false,
        };
        let squares: Vec<usize> = monomial
            .squared_variables()
            .filter(|&place| self.variables[place].odd == wanted)
            .collect();
        monomial.moduli.extend(squares);
    }
}

fn describe_symmetry(rules: &Rules) -> String {
    let selection = match rules.symmetry {
        Symmetry::Parity => "parity",
        Symmetry::Mirror => "mirror",
        Symmetry::None => "none",
    };
    let switches =
        [(rules.zeroth_powers, ", zeroth powers"), (rules.signed_squares, ", signed squares")];
    let on: String = switches.into_iter().filter(|(on, _)| *on).map(|(_, name)| name).collect();
    format!("{selection}{on}")
}

fn describe_powers(rules: &Rules) -> String {
    let powers = match rules.trigonometric_powers {
        TrigonometricPowers::Drop => "drop",
        TrigonometricPowers::Keep => "keep",
    };
    let excepted: String =
        rules.trigonometric_exceptions.iter().map(|of| format!(", not {}^2", of.factor)).collect();
    format!("{powers}{excepted}")
}

fn describe_squares(rules: &Rules) -> &'static str {
    match rules.squares {
        Squares::AsDescribed => "as described",
        Squares::AsPrinted => "as printed",
        Squares::Plain => "plain",
    }
}
