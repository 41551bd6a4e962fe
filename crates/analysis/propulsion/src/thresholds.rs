//! Constants of the balance and of the check, with symbol, meaning, unit and source.

/// The surge balance.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BalanceThresholds {
    /// `s`: ratio of the advance ratio at the self-propulsion point to that of zero thrust if no
    /// estimate of the ship gives it, dimensionless. Source: median of the estimates of the zoo,
    /// docs/evidence/propulsion.md.
    pub loading: f64,
    /// Range of the same to which an estimate is limited, dimensionless. Source: derived: at 0.9
    /// the blades have a tenth of the thrust of rest left, at 0.3 the ship tows.
    pub loadings: [f64; 2],
    /// `J/(0.7 pi)` at the self-propulsion point without an estimate, dimensionless. Source: as
    /// `loading`.
    pub advance: f64,
    /// `X_0`: resistance by `0.5 rho Lpp d U^2` without an estimate, dimensionless. Source: KVLCC2
    /// in Yasukawa and Yoshimura 2015; its deviation is half of it.
    pub resistance: f64,
    /// Relative deviation of the estimated resistance, dimensionless. Source: that of the friction
    /// line by the waves that it leaves out, models/regressions/ittc-1957.yaml.
    pub estimate_deviation: f64,
    /// Relative deviation of the resistance from the derivative of surge by the speed, besides that
    /// of the posterior, dimensionless. Source: derived: the factor of the derivative in
    /// `balance` changes by -17 and +30 % where the loading of 0.65 is 0.55 or 0.75.
    pub slope_deviation: f64,
    /// Thrust of the reversed propeller at rest by that ahead, dimensionless. Source: chosen, as
    /// the blades' camber and trailing edges are the wrong way round; docs/evidence/propulsion.md
    /// has half and double of the loss.
    pub backing: f64,
    /// Range of revolutions over which a law's weight falls, as a share of those of the approach,
    /// dimensionless. Source: derived: thrust goes with the square of the revolutions and has
    /// changed by about 40 % there, more than the deviation of the resistance.
    pub revolutions: f64,
    /// Least speed from which a law alone counts, by the least of its trials, and that from which
    /// it counts at all, dimensionless. Source: derived: turns at 35 deg after trials at 20 deg lose
    /// up to half of the speed once more, and the balance takes over in as much again.
    pub slow: [f64; 2],
    /// The same above the greatest speed, dimensionless.
    pub fast: [f64; 2],
    /// Greatest sway speed and yaw rate at which a law is evaluated at another speed, by those of its
    /// trials, dimensionless. Source: derived: turns at 35 deg after trials at 20 deg.
    pub turning: f64,
    /// Speed by that of the approach below which trials reach rest, dimensionless. Source: derived:
    /// less than any turn leaves.
    pub rest: f64,
    /// Share of the samples on either side that is outside the range, dimensionless. Source:
    /// chosen: dropouts of a tachometer are fewer.
    pub tails: f64,
}

/// The values.
pub(crate) const BALANCE: BalanceThresholds = BalanceThresholds {
    loading: 0.65,
    loadings: [0.3, 0.9],
    advance: 0.25,
    resistance: 0.022,
    estimate_deviation: 0.3,
    slope_deviation: 0.3,
    backing: 0.7,
    revolutions: 0.2,
    slow: [0.5, 0.25],
    fast: [1.25, 1.5],
    turning: 2.0,
    rest: 0.1,
    tails: 0.01,
};

/// Constants of the wave resistance of fast hulls.
#[derive(Debug, Clone, Copy)]
pub(crate) struct WaveThresholds {
    /// Froude number of the hump, dimensionless. Source: theory of a moving pressure: waves as long
    /// as pi times the hull.
    pub hump: f64,
    /// Power of the Froude number with which waves rise, dimensionless. Source: chosen, with the
    /// level at 0.26 a tenth of the resistance of KCS, at 0.4 a percent and a half of the weight.
    pub rise: i32,
    /// Level by weight at the slenderness below, dimensionless. Source: chosen, of the magnitude of
    /// the round bilge series (NPL, not seen); docs/evidence/propulsion.md.
    pub level: f64,
    /// Slenderness `L/V^(1/3)` of that level, and the power with which it falls, dimensionless.
    /// Source: as `level`.
    pub slenderness: f64,
    /// Power of the slenderness, dimensionless.
    pub slender: f64,
    /// Relative deviation, dimensionless. Source: chosen; hull forms differ by a half.
    pub deviation: f64,
}

/// The values.
pub(crate) const WAVES: WaveThresholds = WaveThresholds {
    hump: 0.5,
    rise: 8,
    level: 0.06,
    slenderness: 6.0,
    slender: 2.5,
    deviation: 0.5,
};

/// Constants of the checks.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CheckThresholds {
    /// Speed that counts as rest, by the greatest of the trials, and as astern, by that of the
    /// approach, dimensionless. Source: chosen; docs/evidence/propulsion.md has half and double.
    pub rest: f64,
    /// Greatest speed that counts as rest, by that of the approach, dimensionless. Source: chosen, as
    /// a fall by half cannot be the trace of a creep.
    pub rest_most: f64,
    /// `T`: longest duration, in units of the speed over the deceleration with the propeller
    /// stopped, dimensionless. Source: derived: a resistance that goes with the square of the speed
    /// leaves a tenth after nine times that; twice as much is allowed.
    pub patience: f64,
    /// Rise of the speed that is tolerated meanwhile, relative to that of the approach,
    /// dimensionless. Source: chosen, as of a trace of drift that dies down.
    pub rise: f64,
    /// `U/|u'|` with the propeller stopped, by `L/U`, dimensionless. Source: derived: mass by
    /// `0.5 rho L^2 d` over resistance by `0.5 rho L d U^2`, from 0.1 to 0.35 over 0.006 to 0.1,
    /// and half and double.
    pub stopping: [f64; 2],
    /// Speed from rest at the approach's revolutions, by that of the approach, dimensionless.
    /// Source: chosen, as trials may not keep one number of revolutions.
    pub ahead: [f64; 2],
    /// Rudder of the turn from which the propeller is stopped as well, deg. Source: that of common
    /// trials.
    pub turn_deg: f64,
    /// Duration of the turn, in units of `L/U`, dimensionless. Source: derived: yaw is steady after
    /// less.
    pub turn: f64,
    /// Step, by `L/U`, dimensionless. Source: as of steady motions in `simulation::manoeuvre`.
    pub step: f64,
}

/// The values.
pub(crate) const CHECK: CheckThresholds = CheckThresholds {
    rest: 0.1,
    rest_most: 0.5,
    patience: 18.0,
    rise: 0.02,
    stopping: [0.5, 120.0],
    ahead: [0.5, 1.5],
    turn_deg: 20.0,
    turn: 3.0,
    step: 0.05,
};
