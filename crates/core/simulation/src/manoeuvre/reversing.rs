//! Check that a model covers a propeller that is reversed while the ship moves ahead.
//!
//! Most laws describe a propeller as in open water ahead. Their formulas also give numbers for
//! revolutions astern, but these numbers rest on no measurement.

use std::collections::BTreeSet;

use sistership_formula::Expr;
use sistership_model::law::Law;
use sistership_model::{Model, particulars};

use crate::plant::PlantWorkspace;
use crate::ship::Ship;
use crate::state::{at, straight_state};

/// Reason for which a model cannot be stopped by reversing the propeller.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ReversingError {
    /// Thrust does not depend on revolutions.
    #[error("law `{law}` has no propeller revolutions as input")]
    NoRevolutions {
        /// The law.
        law: String,
    },
    /// The revolutions of the approach are unknown.
    #[error("{model} has no revolutions for its approach speed; give those astern")]
    NoApproach {
        /// The model.
        model: String,
    },
    /// The propeller of the law covers revolutions ahead only.
    #[error(
        "the propeller model of law `{law}` covers the first quadrant only (ahead, with \
         revolutions ahead)"
    )]
    FirstQuadrant {
        /// The law.
        law: String,
    },
    /// The coefficients of the revolutions were fitted without revolutions astern.
    #[error(
        "law `{law}` is a polynomial in the revolutions, but no trial of {model} has a reversed \
         propeller"
    )]
    NotCovered {
        /// The law.
        law: String,
        /// The model.
        model: String,
    },
    /// Reversing does not slow the ship down.
    #[error("in {model} a reversed propeller does not decelerate the ship at {speed} m/s")]
    DoesNotBrake {
        /// The model.
        model: String,
        /// Speed ahead, m/s.
        speed: String,
    },
}

/// Checks that a model covers a reversed propeller, and that reversing brakes the ship.
///
/// A law covers it where its formulas branch on the sign of the revolutions; where coefficients
/// multiply the revolutions themselves, trials with the propeller reversed are needed. A model with
/// its own propulsion covers it by that.
///
/// # Errors
/// Returns an error with the reason if the propeller cannot be reversed.
pub fn check_reversing(model: &Model, law: &Law, ship: &Ship) -> Result<(), ReversingError> {
    if model.propulsion.is_none() {
        check_coverage(model, law)?;
    }
    let ahead_rps = ship.revolutions_at(ship.approach_speed_m_s());
    if ahead_rps <= 0.0 {
        return Err(ReversingError::NoApproach { model: model.name.clone() });
    }
    check_braking(model, ship, ahead_rps)
}

/// Checks that a law, or the trials of a model, cover a reversed propeller.
fn check_coverage(model: &Model, law: &Law) -> Result<(), ReversingError> {
    let (of_law, of_model) = (|| law.name.clone(), || model.name.clone());
    if !law.inputs.contains_key("n") {
        return Err(ReversingError::NoRevolutions { law: of_law() });
    }
    // A polynomial in the revolutions is determined astern only by trials with revolutions astern.
    if law.factors.contains_key("n") {
        let reversed = model.validity.as_ref().and_then(|region| region.ranges.get("n"));
        if reversed.is_none_or(|[least, _]| *least >= 0.0) {
            return Err(ReversingError::NotCovered { law: of_law(), model: of_model() });
        }
    } else if !branches_on_revolutions(law) {
        return Err(ReversingError::FirstQuadrant { law: of_law() });
    }
    Ok(())
}

/// Checks that from the approach speed to rest, revolutions astern decelerate more than a stopped
/// propeller.
fn check_braking(model: &Model, ship: &Ship, ahead_rps: f64) -> Result<(), ReversingError> {
    let mut work = PlantWorkspace::default();
    let mut surge =
        |speed: f64, n_rps: f64| ship.rate_at(&straight_state(speed), 0.0, n_rps, &mut work)[at::U];
    for share in [1.0, 0.75, 0.5, 0.25, 0.0] {
        let speed = share * ship.approach_speed_m_s();
        let (reversed, stopped) = (surge(speed, -ahead_rps), surge(speed, 0.0));
        // The ship must decelerate, and more than with a stopped propeller.
        if reversed >= stopped.min(0.0) {
            let speed = format!("{speed:.2}");
            return Err(ReversingError::DoesNotBrake { model: model.name.clone(), speed });
        }
    }
    Ok(())
}

/// Returns true if some formula compares the revolutions, or a value that depends on them alone.
fn branches_on_revolutions(law: &Law) -> bool {
    // Values are in the order of their dependence, so that one pass finds all that follow from n.
    let mut revolutions = BTreeSet::from(["n"]);
    for (name, value) in &law.values {
        if depends_only_on_revolutions(value, &revolutions, law) {
            revolutions.insert(name);
        }
    }
    let axes = law.axes.values();
    let formulas = law.values.values().chain(law.factors.values());
    let formulas = formulas.chain(axes.flat_map(|axis| axis.terms.values().chain([&axis.rest])));
    formulas.into_iter().any(|formula| compares_revolutions(formula, &revolutions, law))
}

fn compares_revolutions(formula: &Expr, revolutions: &BTreeSet<&str>, law: &Law) -> bool {
    let here = match formula {
        Expr::If(_, sides) => {
            sides[..2].iter().any(|side| depends_only_on_revolutions(side, revolutions, law))
        }
        _ => false,
    };
    here || formula.children().into_iter().any(|part| compares_revolutions(part, revolutions, law))
}

/// Returns true if a formula names revolutions, and no other variable of the motion.
fn depends_only_on_revolutions(formula: &Expr, revolutions: &BTreeSet<&str>, law: &Law) -> bool {
    let names = formula.mentioned_names();
    let constant = |name: &str| {
        law.parameters.contains_key(name)
            || particulars::particular_dimension(name).is_some()
            || name == "g"
    };
    names.iter().any(|name| revolutions.contains(name))
        && names.iter().all(|name| revolutions.contains(name) || constant(name))
}
