//! Families: ships whose models have a common foundation, and the prior that they give for the next
//! one.
//!
//! Each member's coefficients are drawn from one normal distribution about a common mean, and its
//! trials determine them as far as their statistics do (empirical Bayes: Efron and Morris 1973, J
//! Am Stat Assoc 68, 117-130). Mean and covariance are those of greatest likelihood, by expectation
//! and maximisation (Dempster, Laird and Rubin 1977, J R Stat Soc B 39, 1-38).

mod evidence;
mod learn;
mod prior;
mod thresholds;

pub use learn::{FamilyError, FamilyMember, learn_family};
pub use prior::{FORMAT, FamilyAxis, FamilyPrior, FamilyPriorError};

#[cfg(test)]
mod tests;
