//! Grammar of terms that are searched one by one.

use std::collections::BTreeMap;
use std::sync::Arc;

use indexmap::IndexMap;

use super::file::{ActsOn, GrammarFile};
use super::form::EffectForm;
use super::scope::{FieldFault, FormScope};
use super::symmetry;
use super::term::{GrammarFactor, GrammarTerm};
use crate::coefficient::{Axis, STANDARD_FACTORS};
use crate::law::axis_dimension;
use crate::law::limits::check_count;
use crate::trial::Channel;
use sistership_formula::Expr;
use sistership_formula::units::Dimension;

/// Largest number of factors of a grammar: to the fourth order they make some 5000 terms.
const MAX_FACTORS: usize = 16;

/// Grammar, read and checked.
#[derive(Debug, Clone, PartialEq)]
pub struct TermGrammar {
    file: GrammarFile,
    /// Factors in canonical order.
    factors: Vec<GrammarFactor>,
    /// Forces and moments per unit of a term.
    scales: BTreeMap<Axis, Expr>,
}

impl TermGrammar {
    /// Reads and checks a grammar; errors name the field below it.
    pub fn from_file(file: &GrammarFile) -> Result<Self, FieldFault> {
        let scope = FormScope::new(false);
        let dimension = |axis: &Axis| Ok(axis_dimension(*axis));
        let factors = scope.read_section(
            "factors",
            &file.factors,
            &|_: &String| Ok(Dimension::NONE),
            false,
        )?;
        let scales: BTreeMap<Axis, Expr> =
            scope.read_section("scales", &file.scales, &dimension, false)?;
        check_grammar(file, &scales)?;
        let grammar =
            Self { factors: ordered_factors(file, &factors)?, scales, file: file.clone() };
        // Each term is read once, so that none that is searched for later can be refused.
        grammar.list_terms().iter().try_for_each(|term| {
            let readable = |axis: &Axis| {
                EffectForm::from_file(ActsOn::Force, &term.to_form(&grammar.file, *axis))
                    .map(|_| ())
            };
            grammar.scales.keys().filter(|axis| term.fits_axis(**axis)).try_for_each(readable)
        })?;
        Ok(grammar)
    }

    /// Returns every term that fits one of the axes: products of factors with the parity of the
    /// axis, named like coefficients, without those whose name is `known` and those that need a
    /// channel for which `has` returns false.
    pub fn list_forms(
        &self,
        axes: &[Axis],
        known: &dyn Fn(&str) -> bool,
        has: &dyn Fn(Channel) -> bool,
    ) -> Vec<Arc<EffectForm>> {
        let terms = self.list_terms();
        let spelled = |axis: Axis| {
            terms
                .iter()
                .filter(move |term| term.fits_axis(axis))
                .map(move |term| term.to_form(&self.file, axis))
        };
        let axes = axes.iter().copied().filter(|axis| self.scales.contains_key(axis));
        let wanted = axes
            .flat_map(spelled)
            .filter(|form| !known(&form.name) && form.needs.iter().all(|&channel| has(channel)));
        wanted
            .filter_map(|form| EffectForm::from_file(ActsOn::Force, &form).ok())
            .map(Arc::new)
            .collect()
    }

    /// Returns the constant of each axis, such as `Y_0`, for a ship that is not exactly symmetric;
    /// none of those that are `known`.
    pub fn constant_forms(
        &self,
        axes: &[Axis],
        known: &dyn Fn(&str) -> bool,
    ) -> Vec<Arc<EffectForm>> {
        let constant = GrammarTerm { factors: Vec::new(), bars: false };
        let axes = axes.iter().copied().filter(|axis| self.scales.contains_key(axis));
        let wanted =
            axes.map(|axis| constant.to_form(&self.file, axis)).filter(|form| !known(&form.name));
        wanted
            .filter_map(|form| EffectForm::from_file(ActsOn::Force, &form).ok())
            .map(Arc::new)
            .collect()
    }

    fn list_terms(&self) -> Vec<GrammarTerm<'_>> {
        let mut terms = Vec::new();
        for order in 1..=self.file.order {
            self.add_products(order, 0, &mut Vec::new(), &mut terms);
        }
        terms
    }

    /// Adds products of `left` more factors from index `from` on, each also with its variant in
    /// bars.
    fn add_products<'a>(
        &'a self,
        left: usize,
        from: usize,
        taken: &mut Vec<&'a GrammarFactor>,
        terms: &mut Vec<GrammarTerm<'a>>,
    ) {
        if left == 0 {
            terms.push(GrammarTerm { factors: taken.clone(), bars: false });
            // Only products of two factors have such a variant, as in `v|v|`.
            if taken.len() == 2 && taken[1].absolute {
                terms.push(GrammarTerm { factors: taken.clone(), bars: true });
            }
            return;
        }
        // Each product is listed once: factors do not decrease, and may be repeated.
        for place in from..self.factors.len() {
            taken.push(&self.factors[place]);
            self.add_products(left - 1, place, taken, terms);
            taken.pop();
        }
    }
}

fn check_grammar(file: &GrammarFile, scales: &BTreeMap<Axis, Expr>) -> Result<(), FieldFault> {
    if !(1..=4).contains(&file.order) {
        return Err(("order".into(), format!("{} is not from 1 to 4", file.order)));
    }
    check_count("factors", file.factors.len(), MAX_FACTORS)?;
    if let Some(symbol) = file.absolute.iter().find(|symbol| !file.factors.contains_key(*symbol)) {
        return Err((format!("absolute.{symbol}"), "is not one of the factors".into()));
    }
    for (axis, scale) in scales {
        let deviation = file.deviations.get(axis).copied().unwrap_or(f64::NAN);
        if !(deviation.is_finite() && deviation > 0.0) {
            return Err((
                format!("deviations.{axis}"),
                "give a deviation above zero for each scale".into(),
            ));
        }
        if !symmetry::has_parity(&IndexMap::new(), &IndexMap::new(), scale, false) {
            return Err((format!("scales.{axis}"), symmetry::symmetry_message(false)));
        }
    }
    Ok(())
}

fn ordered_factors(
    file: &GrammarFile,
    formulas: &IndexMap<String, Expr>,
) -> Result<Vec<GrammarFactor>, FieldFault> {
    let mut factors = Vec::new();
    for (symbol, formula) in formulas {
        let is = |odd| symmetry::has_parity(&IndexMap::new(), &IndexMap::new(), formula, odd);
        // A factor must be either odd or even; one that is both is zero.
        if is(true) == is(false) {
            let message = "breaks the port/starboard symmetry: mirrored, it should be unchanged \
                           or change its sign";
            return Err((format!("factors.{symbol}"), message.into()));
        }
        let (text, absolute) = (file.factors[symbol].clone(), file.absolute.contains(symbol));
        factors.push(GrammarFactor { symbol: symbol.clone(), text, odd: is(true), absolute });
    }
    // A stable sort: factors without a standard rank stay in the order of the file, at the end.
    let rank = |symbol: &str| {
        STANDARD_FACTORS.iter().position(|known| *known == symbol).unwrap_or(STANDARD_FACTORS.len())
    };
    factors.sort_by_key(|factor| rank(&factor.symbol));
    Ok(factors)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::Effect;
    use crate::coefficient::CoefficientName;

    const TERMS: &str = "
kind: effect
name: terms
title: Terms
acts_on: force
sources: { test: { citation: made for this test } }
grammar:
  factors: { r: r*lpp_m/sqrt(u^2 + v^2), v: v/sqrt(u^2 + v^2), phi: phi, delta: delta }
  absolute: [v]
  order: 3
  scales: { X: 0.5*water_density_kg_m3*lpp_m^2*u^2, Y: 0.5*water_density_kg_m3*lpp_m^2*u^2, N: 0.5*water_density_kg_m3*lpp_m^3*u^2 }
  deviations: { X: 0.003, Y: 0.01, N: 0.003 }
";

    fn grammar() -> TermGrammar {
        Effect::parse("terms.yaml", TERMS).unwrap_or_else(|e| panic!("{e}")).grammar.unwrap()
    }

    fn names(known: &[&str], has_roll: bool) -> Vec<String> {
        let has = |channel| has_roll || channel != Channel::Phi;
        let forms =
            grammar().list_forms(&[Axis::X, Axis::Y, Axis::N], &|name| known.contains(&name), &has);
        forms.iter().map(|form| form.file.name.clone()).collect()
    }

    #[test]
    fn terms_are_spelled_like_coefficients() {
        let spelled = names(&["Y_v"], false);
        for name in ["N_vvr", "Y_v|v|", "X_vr", "N_vrdelta"] {
            assert!(spelled.contains(&name.to_owned()), "{name} is not among {spelled:?}");
        }
        for name in ["Y_v", "X_v", "Y_vr", "X_vvv", "Y_vphi", "Y_phi"] {
            assert!(!spelled.contains(&name.to_owned()), "{name} should not be spelled");
        }
        for name in spelled {
            assert!(CoefficientName::parse(&name, &[]).is_ok(), "{name}");
        }
        assert!(names(&[], true).contains(&"Y_phi".to_owned()));
    }

    #[test]
    fn a_term_is_a_form_of_one_parameter() {
        let forms = grammar().list_forms(&[Axis::Y], &|_| false, &|_| true);
        let form = forms.iter().find(|form| form.file.name == "Y_v|v|").unwrap();
        let parameter = &form.parameters["Y_v_abs_v"];
        assert_eq!((parameter.prior_deviation, parameter.bounds), (0.01, [-0.2, 0.2]));
        let roll = forms.iter().find(|form| form.file.name == "Y_phi").unwrap();
        assert_eq!(
            (roll.parameters.len(), roll.file.needs.as_slice()),
            (1, [Channel::Phi].as_slice())
        );
        assert_eq!(EffectForm::from_file(ActsOn::Force, &form.file).as_ref(), Ok(form.as_ref()));
    }

    #[test]
    fn a_factor_without_parity_is_refused() {
        let broken = TERMS.replace("phi: phi", "phi: phi + 0.1");
        let error = Effect::parse("terms.yaml", &broken).unwrap_err().to_string();
        assert!(error.contains("terms.yaml:8: grammar.factors.phi"), "{error}");
    }
}
