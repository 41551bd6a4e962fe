//! Interface of learned corrections for simulations, and their attachment to models.

use std::fmt;
use std::sync::Arc;

use sistership_formula::Expr;

/// Inputs of a learned correction at an instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CorrectionInstant {
    /// u, v, r: m/s, m/s, rad/s.
    pub velocities: [f64; 3],
    /// Rudder angle, rad; 0 for a law without one.
    pub delta_rad: f64,
    /// Propeller revolutions, 1/s; 0 for a law without them.
    pub n_rps: f64,
    /// Rates of u, v, r by the law, the foundation: m/s2, m/s2, rad/s2.
    pub accelerations: [f64; 3],
}

/// Derivatives of the additions to the rates of u, v, r; one row for each of them.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct AdditionGradient {
    /// With respect to u, v, r.
    pub by_velocity: [[f64; 3]; 3],
    /// With respect to the rudder angle.
    pub by_delta: [f64; 3],
    /// With respect to the propeller revolutions.
    pub by_n: [f64; 3],
    /// With respect to the rates of u, v, r by the law.
    pub by_acceleration: [[f64; 3]; 3],
}

/// Names of the law's own rates of u, v, r in formulas of a learned correction.
pub const LAW_RATES: [&str; 3] = ["law.u_dot", "law.v_dot", "law.r_dot"];

/// Additions of a learned correction as formulas of `u`, `v`, `r`, `delta`, `n` and [`LAW_RATES`].
#[derive(Debug, Clone, Default, PartialEq)]
pub struct AdditionFormulas {
    /// Intermediate values by name, each of earlier names.
    pub values: Vec<(String, Expr)>,
    /// Additions to the rates of u, v, r; `None` where nothing is added.
    pub added: [Option<Expr>; 3],
}

/// Learned correction of the accelerations of a ship in surge, sway and yaw.
///
/// An implementation must keep its additions bounded, and return zero outside the range of its
/// training.
pub trait CorrectionModel: fmt::Debug + Send + Sync {
    /// Returns the additions to the rates of u, v, r: m/s2, m/s2, rad/s2.
    fn rate_additions(&self, instant: &CorrectionInstant) -> [f64; 3];

    /// Returns the derivatives of [`LearnedBranch::addition`].
    fn addition_gradient(&self, instant: &CorrectionInstant) -> AdditionGradient;

    /// Returns [`LearnedBranch::addition`] as formulas.
    fn addition_formulas(&self) -> AdditionFormulas;

    /// Returns the share of the correction, from 0 (the foundation acts alone) to 1.
    fn active_share(&self, instant: &CorrectionInstant) -> f64;
}

/// Weights of a learned correction, checked against its document and ready for evaluation; empty in
/// a document that was just read. `sistership-learned` attaches them. A model with a learned
/// correction but without its weights cannot be simulated.
#[derive(Clone, Default)]
pub struct AttachedWeights(Option<Arc<dyn CorrectionModel>>);

impl AttachedWeights {
    /// Attaches weights that match the document.
    pub fn new(learned: Arc<dyn CorrectionModel>) -> Self {
        Self(Some(learned))
    }

    /// The weights, if they have been attached.
    pub fn get(&self) -> Option<&Arc<dyn CorrectionModel>> {
        self.0.as_ref()
    }
}

/// All are equal, because documents are compared by the hash of their weights.
impl PartialEq for AttachedWeights {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl fmt::Debug for AttachedWeights {
    /// Writes only the presence of weights, which are many numbers.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Attached").field(&self.0.is_some()).finish()
    }
}
