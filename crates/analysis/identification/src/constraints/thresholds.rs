//! Constants of the constraints, with symbol, meaning, unit and source.
//!
//! A source that begins with "chosen" has not been measured at half and at double the value; the
//! reason given is a mathematical one.

/// Constants by which limits are set up and kept.
#[derive(Debug, Clone, Copy)]
pub(super) struct ConstraintThresholds {
    /// Number of speeds at which surge damping is required. Source: decision 13 ("at five speeds
    /// over those covered").
    pub speeds: usize,
    /// `U_0/U_1`: lowest of these speeds as a share of the greatest speed that the trials covered,
    /// dimensionless. Source: chosen; near rest the resistance vanishes with the speed, and so does
    /// its sign.
    pub least_speed: f64,
    /// `s`: growth or decay rate of a reference that is obtained by shifting a solution, in units
    /// of `U/L`, dimensionless. Source: chosen; small, so that the reference stays near the
    /// solution.
    pub shift: f64,
    /// Number of references tried one after the other, each the solution within the limits of the
    /// one before. Source: decision 13 ("three references ... give most of the rest").
    pub references: usize,
    /// `e`: disturbance of a straight course by the ship's speed, and of yaw by speed over length,
    /// dimensionless. Source: derived: central differences err by its square.
    pub disturbance: f64,
    /// Change of a coefficient that is zero, in its unit, by which functions that are affine in it
    /// are differenced. Source: derived: they are affine, so that any change gives the same slope.
    pub difference: f64,
    /// `m`: margin of the matrix inequality relative to its value at the reference, dimensionless.
    /// Source: chosen, a margin far above the solver's error.
    pub margin: f64,
    /// Violation that is attributed to the solver's error, in units of the scale of a limit,
    /// dimensionless. Source: chosen, a hundred times the solver's default tolerance of 1e-8.
    pub solver_error: f64,
    /// `w`: weight of the distance relative to the violations in the elastic programme,
    /// dimensionless. Source: chosen; small enough for the violation to be least, and large enough
    /// for the solution to be unique.
    pub elastic_weight: f64,
}

/// Values of the constants.
pub(super) const CONSTRAINTS: ConstraintThresholds = ConstraintThresholds {
    speeds: 5,
    least_speed: 0.2,
    shift: 0.05,
    references: 3,
    disturbance: 1e-3,
    difference: 1e-3,
    margin: 1e-3,
    solver_error: 1e-6,
    elastic_weight: 1e-7,
};
