//! Typical values of a law's coefficients, with their spread over ships.
//!
//! They are the prior of a model that has no source: without them a ridge shrinks to zero, and a ship
//! without forces is like no other.

use std::collections::BTreeMap;

use indexmap::IndexMap;

use super::definition::{CoefficientPrior, Law};
use super::file::CoefficientPriorFile;
use crate::particulars;
use crate::quantity::Quantity;
use sistership_formula::units::Dimension;
use sistership_formula::{self as formula, Expr};

/// Names of the approach in formulas of typical values.
const APPROACH: [(&str, Dimension); 2] =
    [("approach_speed_m_s", Dimension::SPEED), ("approach_revolutions_rps", Dimension::RATE)];

/// Approach of a ship to its trials.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrialApproach {
    /// Speed, m/s.
    pub speed_m_s: f64,
    /// Propeller revolutions, 1/s, where recorded.
    pub n_rps: Option<f64>,
}

/// Typical value of a coefficient for a ship.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TypicalValue {
    /// Value, in the coefficient's unit.
    pub value: f64,
    /// Standard deviation over ships.
    pub deviation: f64,
}

impl Law {
    /// Typical value of a coefficient for a ship; `None` if the law has none, or if particulars and
    /// approach do not suffice for it.
    pub fn typical_value(
        &self,
        name: &str,
        ship: &BTreeMap<String, Quantity>,
        approach: Option<TrialApproach>,
    ) -> Option<TypicalValue> {
        let prior = self.typical.get(name)?;
        let lookup = |name: &str| match name {
            "approach_speed_m_s" => Some(approach?.speed_m_s),
            "approach_revolutions_rps" => approach?.n_rps,
            _ => particulars::particular_value(ship, name),
        };
        // One of the two without the other would be a prior of unknown strength.
        let [value, deviation] = [&prior.value, &prior.deviation].map(|of| of.value(&lookup));
        let typical = TypicalValue { value: value?, deviation: deviation? };
        let is_usable =
            typical.value.is_finite() && typical.deviation.is_finite() && typical.deviation > 0.0;
        is_usable.then_some(typical)
    }
}

/// Reads typical values into `law`, whose axes have been read.
///
/// # Errors
/// Returns the field at fault and the reason: no such coefficient, an unknown name, another unit.
pub fn read_typical(
    law: &mut Law,
    raw: &IndexMap<String, CoefficientPriorFile>,
) -> Result<(), (String, String)> {
    for (name, file) in raw {
        let field = format!("typical.{name}");
        let refuse = |message: String| (field.clone(), message);
        // A coefficient has the dimension that its regressors leave to it, so a typical value in
        // another unit is a mistake in the file.
        let wanted = law.coefficient_dimension(name).map_err(|e| refuse(e.to_string()))?;
        let read = |text: &str| read_formula(text, wanted).map_err(refuse);
        let prior =
            CoefficientPrior { value: read(&file.value)?, deviation: read(&file.deviation)? };
        law.typical.insert(name.clone(), prior);
    }
    Ok(())
}

/// A formula of particulars and approach with the dimension `wanted`; a bare number has any.
fn read_formula(text: &str, wanted: Dimension) -> Result<Expr, String> {
    let expr = formula::parse(text).map_err(|e| e.to_string())?;
    if expr.mentioned_names().is_empty() {
        return Ok(expr);
    }
    let approach = |name: &str| Some(APPROACH.iter().find(|(known, _)| *known == name)?.1);
    let known = |name: &str| {
        approach(name)
            .or_else(|| particulars::particular_dimension(name))
            .or_else(|| Some(formula::builtin_constant(name)?.1))
    };
    let found = formula::dimension_of(&expr, &known).map_err(|e| format!("`{text}` {e}"))?;
    match found == wanted {
        true => Ok(expr),
        false => Err(format!("`{text}` has the dimension {found}, but the coefficient {wanted}")),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use crate::Zoo;

    use super::*;

    #[test]
    fn thrust_of_a_typical_ship_balances_its_resistance_at_the_approach() {
        let zoo = Zoo::load_embedded().unwrap();
        let (law, ship) = (zoo.law("modular").unwrap(), zoo.vessel("kvlcc2-7m").unwrap());
        let (speed_m_s, n_rps) = (1.18, 10.2);
        let approach = Some(TrialApproach { speed_m_s, n_rps: Some(n_rps) });
        let of = |name: &str| law.typical_value(name, &ship.particulars, approach).unwrap();
        let froude_speed = (9.80665 * ship.particular("lpp_m").unwrap()).sqrt();
        let u = speed_m_s / froude_speed;
        let n = n_rps * ship.particular("propeller_diameter_m").unwrap() / froude_speed;
        let thrust = of("X_n|n|").value * n * n + of("X_u|n|").value * u * n;
        let resistance = of("X_u|u|").value * u * u;
        assert!((thrust + resistance).abs() < 1e-9 * thrust, "{thrust} {resistance}");
        assert!(law.typical_value("X_n|n|", &ship.particulars, None).is_none());
        assert!(law.typical_value("X_ahead", &ship.particulars, approach).is_none());
    }

    #[test]
    fn two_typical_thrusters_balance_the_resistance_of_their_craft_at_the_approach() {
        let zoo = Zoo::load_embedded().unwrap();
        let law = zoo.law("differential-thrust").unwrap();
        let (lpp_m, draught_m, speed_m_s, n_rps) = (1.2, 0.1, 1.5, 18.0);
        let particular = |value: f64| Quantity::new(value, "assumed");
        let ship = [("lpp_m", lpp_m), ("draught_m", draught_m)];
        let ship = ship.map(|(name, value)| (name.to_owned(), particular(value))).into();
        let approach = Some(TrialApproach { speed_m_s, n_rps: Some(n_rps) });
        let of = |name: &str| law.typical_value(name, &ship, approach).unwrap().value;
        let froude_speed = (9.80665_f64 * lpp_m).sqrt();
        let (u, n) = (speed_m_s / froude_speed, n_rps * lpp_m / froude_speed);
        let thrust = 2.0 * n * n * of("X_thrust") + 2.0 * n * u * of("X_advance");
        let resistance = of("X_u|u|") * u * u;
        assert!((thrust + resistance).abs() < 1e-9 * thrust, "{thrust} {resistance}");
        assert_eq!(of("N_steer"), of("X_thrust"));
    }

    #[test]
    fn a_wrong_name_or_unit_is_refused_with_its_field() {
        let zoo = Zoo::load_embedded().unwrap();
        let read = |name: &str, value: &str| {
            let file = CoefficientPriorFile { value: value.into(), deviation: "0.1".into() };
            let mut law = (**zoo.law("modular").unwrap()).clone();
            read_typical(&mut law, &[(name.to_owned(), file)].into_iter().collect())
        };
        assert_eq!(read("Y_v", "-0.3*draught_m/lpp_m"), Ok(()));
        for (name, value) in [("Y_uuu", "0.1"), ("Y_v", "draught_m"), ("Y_v", "n/lpp_m")] {
            let (field, message) = read(name, value).unwrap_err();
            assert!(field == format!("typical.{name}") && !message.is_empty(), "{message}");
        }
    }
}
