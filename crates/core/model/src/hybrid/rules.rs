//! Selection and notation of the terms of the expansion: Miyauchi 2024, sec. 2.2.2, one function
//! for each rule.

use super::actuators::Variable;
use super::file::{Coupling, Rules, Squares, Symmetry, TrigonometricPowers};
use super::monomial::Monomial;
use crate::coefficient::Axis;

/// Term: a monomial, or the sum or difference of two that are mirror images of each other.
#[derive(Debug, Clone, PartialEq)]
pub struct Term {
    /// The monomial, which gives the coefficient its name.
    pub monomial: Monomial,
    /// Its mirror image, and true if that is subtracted.
    pub image: Option<(Monomial, bool)>,
}

/// Result of one rule.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// The rule.
    pub rule: &'static str,
    /// Setting of the rule.
    pub setting: String,
    /// Numbers of terms after it on X, Y and N.
    pub terms: [usize; 3],
}

/// Axes of the hybrid.
pub const AXES: [Axis; 3] = [Axis::X, Axis::Y, Axis::N];

/// Applies the rules one after another; returns the terms by axis, in the order of [`AXES`], and
/// the result of each rule.
pub fn select(
    all: &[Monomial],
    rules: &Rules,
    variables: &[Variable],
    setting: &str,
) -> ([Vec<Term>; 3], Vec<Step>) {
    let alone = |monomial: &Monomial| Term { monomial: monomial.clone(), image: None };
    let mut terms = AXES.map(|_| all.iter().map(alone).collect::<Vec<Term>>());
    let mut steps = vec![Step {
        rule: "Taylor expansion",
        setting: setting.to_owned(),
        terms: terms.each_ref().map(Vec::len),
    }];
    let selector = Selector { rules, variables };
    for (rule, setting, apply) in selector.rules() {
        for (axis, terms) in AXES.into_iter().zip(&mut terms) {
            *terms = terms.drain(..).filter_map(|term| apply(&selector, axis, term)).collect();
        }
        steps.push(Step { rule, setting, terms: terms.each_ref().map(Vec::len) });
    }
    (terms, steps)
}

type Rule<'a> = fn(&Selector<'a>, Axis, Term) -> Option<Term>;

struct Selector<'a> {
    rules: &'a Rules,
    variables: &'a [Variable],
}

impl<'a> Selector<'a> {
    /// The rules in order, with their settings in words.
    fn rules(&self) -> [(&'static str, String, Rule<'a>); 5] {
        let constant = if self.rules.constant { "keep" } else { "drop" };
        [
            ("force at rest", constant.into(), Self::constant),
            ("axes and couplings", "as declared".into(), Self::reach),
            ("A: symmetry", symmetry_in_words(self.rules), Self::symmetry),
            ("B: powers of sines and cosines", powers_in_words(self.rules), Self::trigonometric),
            ("C: squares", squares_in_words(self.rules).into(), Self::squares),
        ]
    }

    /// Rule of the force at rest, the first term of Eq. 7.
    fn constant(&self, _: Axis, term: Term) -> Option<Term> {
        (self.rules.constant || term.monomial.degree() > 0).then_some(term)
    }

    /// Rule of couplings: actuators act on their axes only, and multiply only the variables with
    /// which they couple.
    fn reach(&self, axis: Axis, term: Term) -> Option<Term> {
        let places =
            || term.monomial.powers.iter().map(|&(place, _)| &self.variables[place].actuator);
        let allowed = places().flatten().all(|one| {
            // `All` meets everything, `Hull` the motion, and every actuator itself.
            let met = |other: &Option<super::actuators::Reach>| match (one.couples, other) {
                (Coupling::All, _) => true,
                (Coupling::Hull, None) => true,
                (_, other) => other.as_ref().is_some_and(|other| other.name == one.name),
            };
            one.axes.as_ref().is_none_or(|axes| axes.contains(&axis)) && places().all(met)
        });
        allowed.then_some(term)
    }

    /// Rule of symmetry, modification A.
    fn symmetry(&self, axis: Axis, term: Term) -> Option<Term> {
        let image = term.monomial.exchanged(self.variables);
        let fits = term.monomial.is_odd(self.variables) == axis.is_odd();
        match self.rules.symmetry {
            Symmetry::None => Some(term),
            // Of two mirror images one represents both; their sum or difference has the parity of
            // the axis.
            Symmetry::Mirror if image != term.monomial => {
                let first = term.monomial < image;
                first.then_some(Term { image: Some((image, !fits)), ..term })
            }
            _ if fits || self.is_bias(axis, &term.monomial) => Some(term),
            _ => self.signed(axis, term),
        }
    }

    /// Returns true for a term without odd factors on an odd axis, if such biases are kept.
    fn is_bias(&self, axis: Axis, monomial: &Monomial) -> bool {
        let even = || monomial.powers.iter().all(|&(place, _)| !self.variables[place].odd);
        self.rules.zeroth_powers && axis.is_odd() && even()
    }

    /// Replaces `v^2` by `v|v|`, if that gives the term the parity of its axis.
    fn signed(&self, axis: Axis, mut term: Term) -> Option<Term> {
        // The first square of an odd variable is changed.
        let square = term.monomial.squares().find(|&place| self.variables[place].odd)?;
        term.monomial.moduli.insert(square);
        (self.rules.signed_squares && term.monomial.is_odd(self.variables) == axis.is_odd())
            .then_some(term)
    }

    /// Rule of the powers of sines and cosines, modification B.
    fn trigonometric(&self, axis: Axis, term: Term) -> Option<Term> {
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
    fn squares(&self, axis: Axis, mut term: Term) -> Option<Term> {
        self.moduli(axis, &mut term.monomial);
        if let Some((image, _)) = &mut term.image {
            self.moduli(axis, image);
        }
        Some(term)
    }

    fn moduli(&self, axis: Axis, monomial: &mut Monomial) {
        let wanted = match self.rules.squares {
            Squares::Plain => return,
            Squares::AsPrinted => axis.is_odd(),
            Squares::AsDescribed => false,
        };
        let squares: Vec<usize> =
            monomial.squares().filter(|&place| self.variables[place].odd == wanted).collect();
        monomial.moduli.extend(squares);
    }
}

fn symmetry_in_words(rules: &Rules) -> String {
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

fn powers_in_words(rules: &Rules) -> String {
    let powers = match rules.trigonometric_powers {
        TrigonometricPowers::Drop => "drop",
        TrigonometricPowers::Keep => "keep",
    };
    let excepted: String =
        rules.trigonometric_exceptions.iter().map(|of| format!(", not {}^2", of.factor)).collect();
    format!("{powers}{excepted}")
}

fn squares_in_words(rules: &Rules) -> &'static str {
    match rules.squares {
        Squares::AsDescribed => "as described",
        Squares::AsPrinted => "as printed",
        Squares::Plain => "plain",
    }
}
