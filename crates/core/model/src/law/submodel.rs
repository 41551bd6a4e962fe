//! Submodels: conditions under which the coefficients of a law deviate from the shared ones.
//!
//! Miyauchi et al. (2024, sec. 2.2.3) give every condition a separate set of coefficients. Here the
//! first set is shared by all and the others are written as deviations from it, `X^(i) = X + X@i`:
//! the same functions with as many numbers, but a prior can shrink deviations that the trials
//! cannot distinguish to zero.

use indexmap::IndexMap;

use super::definition::{AxisLaw, Law, LawSubmodel, indicator_name};
use super::file::SubmodelFile;
use crate::coefficient::split_submodel;
use crate::name::check_slug;
use sistership_formula::{self as formula, Expr};

/// Reads submodels into `law`, whose inputs, parameters and values have been read.
pub fn read_submodels(
    law: &mut Law,
    raw: &IndexMap<String, SubmodelFile>,
) -> Result<(), (String, String)> {
    for (name, file) in raw {
        let field = |e: String| (format!("submodels.{name}"), e);
        check_slug(name).map_err(|e| field(e.to_string()))?;
        if !(file.shrinkage > 0.0 && file.shrinkage.is_finite()) {
            return Err(field(format!("shrinkage must be above 0, not {}", file.shrinkage)));
        }
        let expr = applies_formula(law, file).map_err(field)?;
        law.add_value(indicator_name(name), expr);
        law.submodels.insert(
            name.clone(),
            LawSubmodel { meaning: file.meaning.clone(), shrinkage: file.shrinkage },
        );
    }
    Ok(())
}

/// Returns a formula that is 1 if every comparison holds and no earlier submodel applies, and 0
/// otherwise.
fn applies_formula(law: &Law, file: &SubmodelFile) -> Result<Expr, String> {
    let mut product: Option<Expr> = None;
    for text in &file.when {
        let condition = formula::parse_condition(text).map_err(|e| e.to_string())?;
        // Both sides of the comparison must have the same dimension.
        formula::dimension_of(&condition, &|n| law.name_dimension(n))
            .map_err(|e| format!("`{text}` {e}"))?;
        product = Some(product.map_or(condition.clone(), |product| product.times(condition)));
    }
    let holds = product.ok_or("give at least one comparison under `when`")?;
    // Earlier submodels take precedence: `product * (1 - earlier)`.
    Ok(law.submodels.keys().fold(holds, |holds, earlier| {
        let elsewhere = Expr::Subtract(
            Box::new(Expr::Number(1.0)),
            Box::new(Expr::Name(indicator_name(earlier))),
        );
        holds.times(elsewhere)
    }))
}

impl Law {
    /// Submodel of a coefficient that is a deviation; `None` for a shared coefficient. An estimator
    /// shrinks deviations to zero by a prior whose precision is [`Submodel::shrinkage`] times that
    /// of the shared coefficient.
    pub fn deviation_submodel(&self, coefficient: &str) -> Option<&LawSubmodel> {
        self.submodels.get(split_submodel(coefficient).1?)
    }

    /// Every coefficient that the law lists: by axis the shared ones, then the deviations of each
    /// submodel.
    pub fn coefficient_names(&self) -> Vec<String> {
        let of_axis = |axis: &AxisLaw| -> Vec<String> {
            let shared = axis.terms.keys().cloned();
            let deviations = self.submodels.keys().flat_map(|submodel| {
                axis.terms.keys().map(move |name| format!("{name}@{submodel}"))
            });
            shared.chain(deviations).collect()
        };
        self.axes.values().flat_map(of_axis).collect()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    const LAW: &str = "
kind: law
name: two-quadrants
title: A law of the test
sources: {}
inputs: { delta: { unit: rad } }
factors: { u: u, v: v, r: r, delta: delta }
submodels:
  stalled: { when: [u >= 0, abs(delta) > 0.6], meaning: ahead with the rudder stalled, shrinkage: 4.0 }
  astern: { when: [u < 0], meaning: moving astern }
axes:
  X: { terms: [X_u] }
  Y: { terms: [Y_v, Y_delta] }
  N: { terms: [N_r] }
mass: { X: { X: mass_kg }, Y: { Y: mass_kg }, N: { N: mass_kg*lpp_m^2 } }
";

    fn value(law: &Law, name: &str, at: &[(&str, f64)]) -> f64 {
        fn of(law: &Law, name: &str, at: &[(&str, f64)]) -> Option<f64> {
            let known = at.iter().find(|(known, _)| *known == name).map(|&(_, value)| value);
            known.or_else(|| law.values.get(name)?.value(&|n| of(law, n, at)))
        }
        law.unscaled_regressor(name).unwrap().1.value(&|n| of(law, n, at)).unwrap()
    }

    #[test]
    fn a_deviation_acts_while_the_first_conditions_hold() {
        let law = Law::parse("two.yaml", LAW).unwrap();
        for (u, delta, active) in
            [(2.0, 0.1, None), (2.0, -0.7, Some("stalled")), (-2.0, 0.7, Some("astern"))]
        {
            let at = [("u", u), ("delta", delta)];
            for submodel in ["stalled", "astern"] {
                let wanted = if active == Some(submodel) { u } else { 0.0 };
                assert_eq!(
                    value(&law, &format!("X_u@{submodel}"), &at),
                    wanted,
                    "{u} {delta} {submodel}"
                );
            }
            assert_eq!(value(&law, "X_u", &at), u);
        }
    }

    #[test]
    fn deviations_are_flagged_and_listed() {
        let law = Law::parse("two.yaml", LAW).unwrap();
        assert_eq!(
            law.deviation_submodel("X_u@stalled").map(|submodel| submodel.shrinkage),
            Some(4.0)
        );
        assert_eq!(
            law.deviation_submodel("X_u@astern").map(|submodel| submodel.shrinkage),
            Some(1.0)
        );
        assert_eq!(law.deviation_submodel("X_u"), None);
        assert_eq!(law.coefficient_names().len(), 12);
        assert!(law.coefficient_names().iter().all(|name| law.scaled_regressor(name).is_ok()));
        assert_eq!(law.coefficient_dimension("Y_v@astern"), law.coefficient_dimension("Y_v"));
    }

    #[test]
    fn wrong_submodels_are_refused_with_their_field() {
        let refused = |from: &str, to: &str| {
            Law::parse("two.yaml", &LAW.replace(from, to)).unwrap_err().to_string()
        };
        assert!(
            refused("[u < 0]", "[u]")
                .contains("submodels.astern: condition `u` lacks a comparison")
        );
        assert!(refused("[u < 0]", "[w < 0]").contains("unknown name `w`"));
        assert!(refused("[u < 0]", "[u < r]").contains("compares"));
        assert!(refused("[u < 0]", "[]").contains("at least one"));
        assert!(refused("[u < 0]", "[v < 0]").contains("symmetry"));
        assert!(refused("shrinkage: 4.0", "shrinkage: 0").contains("above 0"));
        assert!(
            Law::parse("two.yaml", LAW)
                .unwrap()
                .unscaled_regressor("X_u@backing")
                .unwrap_err()
                .to_string()
                .contains("stalled, astern")
        );
    }
}
