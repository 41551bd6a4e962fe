//! What is learned beside a law of motion, as a simulation takes it, and how it comes to a model.

use std::fmt;
use std::sync::Arc;

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

/// Something learned that changes the accelerations of a ship in surge, sway and yaw.
///
/// It must keep its additions bounded, and give none outside what it was trained on.
pub trait LearnedBranch: fmt::Debug + Send + Sync {
    /// What is added to the rates of u, v, r: m/s2, m/s2, rad/s2.
    fn addition(&self, instant: &Instant) -> [f64; 3];

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
