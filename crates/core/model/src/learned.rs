//! What is learned beside a law of motion, as a simulation takes it, and how it comes to a model.

use std::fmt;
use std::sync::Arc;

use sistership_formula::Expr;

/// What a learned branch sees of an instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Instant {
    /// u, v, r: m/s, m/s, rad/s.
    pub velocities: [f64; 3],
    /// Rudder angle, rad; 0 for a law without one.
    pub delta_rad: f64,
    /// Propeller revolutions, 1/s; 0 for a law without them.
    pub n_rps: f64,
    /// The rates of u, v, r that the law gives, its foundation: m/s2, m/s2, rad/s2.
    pub accelerations: [f64; 3],
}

/// Derivatives of what a learned correction adds to the rates of u, v, r; a row for each of them.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct AdditionGradient {
    /// With u, v, r.
    pub by_velocity: [[f64; 3]; 3],
    /// With the rudder angle.
    pub by_delta: [f64; 3],
    /// With the propeller revolutions.
    pub by_n: [f64; 3],
    /// With the rates of u, v, r that the law gives.
    pub by_acceleration: [[f64; 3]; 3],
}

/// Names of the law's own rates of u, v, r in formulas of a learned correction.
pub const LAW_RATES: [&str; 3] = ["law.u_dot", "law.v_dot", "law.r_dot"];

/// What a learned correction adds as formulas over `u`, `v`, `r`, `delta`, `n` and [`LAW_RATES`].
#[derive(Debug, Clone, Default, PartialEq)]
pub struct AdditionFormulas {
    /// Intermediate values by name, each of names before it.
    pub values: Vec<(String, Expr)>,
    /// What is added to the rates of u, v, r; none where nothing is.
    pub added: [Option<Expr>; 3],
}

/// Something learned that changes the accelerations of a ship in surge, sway and yaw.
///
/// It must keep its additions bounded, and give none outside what it was trained on.
pub trait LearnedBranch: fmt::Debug + Send + Sync {
    /// What is added to the rates of u, v, r: m/s2, m/s2, rad/s2.
    fn addition(&self, instant: &Instant) -> [f64; 3];

    /// Derivatives of [`LearnedBranch::addition`].
    fn gradient(&self, instant: &Instant) -> AdditionGradient;

    /// [`LearnedBranch::addition`] as formulas.
    fn formulas(&self) -> AdditionFormulas;

    /// What it counts for, from 0 (the foundation acts alone) to 1.
    fn share(&self, instant: &Instant) -> f64;
}

/// The weights of a branch, checked against its document and ready to be asked; none in a document
/// just read. `sistership-learned` attaches them. A model with a branch and without weights does
/// not sail.
#[derive(Clone, Default)]
pub struct Attached(Option<Arc<dyn LearnedBranch>>);

impl Attached {
    /// Of weights that suit the document.
    pub fn new(learned: Arc<dyn LearnedBranch>) -> Self {
        Self(Some(learned))
    }

    /// The weights, where they are there.
    pub fn get(&self) -> Option<&Arc<dyn LearnedBranch>> {
        self.0.as_ref()
    }
}

/// Documents are compared: which weights belong to one, it says by their hash.
impl PartialEq for Attached {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl fmt::Debug for Attached {
    /// Whether there are weights: they are many numbers.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Attached").field(&self.0.is_some()).finish()
    }
}
