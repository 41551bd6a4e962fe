//! Whether a model is told of a propeller that is reversed while the ship goes ahead.
//!
//! Most laws have a propeller as in open water ahead; their formulas give numbers for revolutions
//! astern as well, but nobody has meant or measured them.

use std::collections::BTreeSet;

use sistership_formula::Expr;
use sistership_model::law::Law;
use sistership_model::{Model, particulars};

use crate::plant::Work;
use crate::ship::Ship;
use crate::state::{at, straight};

/// Why a model cannot be stopped by reversing the propeller.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum NotReversing {
    /// Thrust is no function of revolutions.
    #[error("law `{law}` takes no propeller revolutions")]
    NoRevolutions {
        /// The law.
        law: String,
    },
    /// The revolutions of the approach are not known.
    #[error("{model} gives no revolutions for its approach speed: what is astern of them?")]
    NoApproach {
        /// The model.
        model: String,
    },
    /// The propeller of the law works ahead.
    #[error(
        "the propeller of law `{law}` is that of the first quadrant, ahead with revolutions ahead"
    )]
    FirstQuadrant {
        /// The law.
        law: String,
    },
    /// Coefficients of the revolutions were never told what they do astern.
    #[error(
        "law `{law}` is a polynomial in the revolutions, and the trials of {model} never reversed \
         the propeller"
    )]
    NotCovered {
        /// The law.
        law: String,
        /// The model.
        model: String,
    },
    /// Reversing does not slow the ship down.
    #[error("by {model}, reversing the propeller does not brake the ship at {speed} m/s")]
    DoesNotBrake {
        /// The model.
        model: String,
        /// At which speed ahead, m/s.
        speed: String,
    },
}

/// Checks that a model is told of a propeller that is reversed, and that it brakes by it.
///
/// A law is told where its formulas branch on the sign of the revolutions; where coefficients
/// multiply the revolutions themselves, they are told by trials with the propeller reversed. A model
/// with a propulsion of its own is told by that.
///
/// # Errors
/// Says why not.
pub fn check_reversing(model: &Model, law: &Law, ship: &Ship) -> Result<(), NotReversing> {
    if model.propulsion.is_none() {
        is_told(model, law)?;
    }
    let ahead_rps = ship.revolutions_at(ship.approach_speed_m_s());
    if ahead_rps <= 0.0 {
        return Err(NotReversing::NoApproach { model: model.name.clone() });
    }
    brakes(model, ship, ahead_rps)
}

/// Whether a law says what a reversed propeller does.
fn is_told(model: &Model, law: &Law) -> Result<(), NotReversing> {
    let (of_law, of_model) = (|| law.name.clone(), || model.name.clone());
    if !law.inputs.contains_key("n") {
        return Err(NotReversing::NoRevolutions { law: of_law() });
    }
    if law.factors.contains_key("n") {
        let reversed = model.validity.as_ref().and_then(|region| region.ranges.get("n"));
        if reversed.is_none_or(|[least, _]| *least >= 0.0) {
            return Err(NotReversing::NotCovered { law: of_law(), model: of_model() });
        }
    } else if !branches_on_revolutions(law) {
        return Err(NotReversing::FirstQuadrant { law: of_law() });
    }
    Ok(())
}

/// From the approach speed to rest, revolutions astern slow down more than a stopped propeller.
fn brakes(model: &Model, ship: &Ship, ahead_rps: f64) -> Result<(), NotReversing> {
    let mut work = Work::default();
    let mut surge =
        |speed: f64, n_rps: f64| ship.rate_at(&straight(speed), 0.0, n_rps, &mut work)[at::U];
    for share in [1.0, 0.75, 0.5, 0.25, 0.0] {
        let speed = share * ship.approach_speed_m_s();
        let (reversed, stopped) = (surge(speed, -ahead_rps), surge(speed, 0.0));
        if reversed >= stopped.min(0.0) {
            let speed = format!("{speed:.2}");
            return Err(NotReversing::DoesNotBrake { model: model.name.clone(), speed });
        }
    }
    Ok(())
}

/// Whether some formula compares the revolutions, or a value that follows from them alone.
fn branches_on_revolutions(law: &Law) -> bool {
    let mut revolutions = BTreeSet::from(["n"]);
    for (name, value) in &law.values {
        if is_of(value, &revolutions, law) {
            revolutions.insert(name);
        }
    }
    let axes = law.axes.values();
    let formulas = law.values.values().chain(law.factors.values());
    let formulas = formulas.chain(axes.flat_map(|axis| axis.terms.values().chain([&axis.rest])));
    formulas.into_iter().any(|formula| compares(formula, &revolutions, law))
}

fn compares(formula: &Expr, revolutions: &BTreeSet<&str>, law: &Law) -> bool {
    let here = match formula {
        Expr::If(_, sides) => sides[..2].iter().any(|side| is_of(side, revolutions, law)),
        _ => false,
    };
    here || formula.children().into_iter().any(|part| compares(part, revolutions, law))
}

/// Whether a formula names revolutions, and nothing else that moves.
fn is_of(formula: &Expr, revolutions: &BTreeSet<&str>, law: &Law) -> bool {
    let names = formula.names();
    let constant = |name: &str| {
        law.parameters.contains_key(name) || particulars::dimension(name).is_some() || name == "g"
    };
    names.iter().any(|name| revolutions.contains(name))
        && names.iter().all(|name| revolutions.contains(name) || constant(name))
}
