//! Forward sensitivities: derivatives of a simulated motion with respect to the law's coefficients
//! and to the initial state.
//!
//! A step of the Runge-Kutta method is differentiated exactly. With `A_i` the derivatives of the
//! rate with respect to the state at stage `i` and `B_i` those with respect to the coefficients, a
//! step takes `S` to `P S + sum_i G_i B_i`, where `G_4 = h/6`, `G_3 = h/3 + h G_4 A_4`,
//! `G_2 = h/3 + h/2 G_3 A_3`, `G_1 = h/6 + h/2 G_2 A_2` and `P = 1 + sum_i G_i A_i` (the chain rule through
//! the method's stages; Hairer, Norsett and Wanner 1993, Solving Ordinary Differential Equations I,
//! section I.14). The stages are small matrices, evaluated for a block of lanes at once; only `P S`
//! and the last sum are as wide as the number of coefficients.

mod row_sums;
mod run;
mod small_matrix;
mod system;

pub use run::SensitiveRun;
pub use system::SensitiveSystem;

#[cfg(test)]
mod tests;
