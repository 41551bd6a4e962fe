//! Thresholds of calibration, and of the discrepancy that it learns.

/// Calibration on the trials that a model was fitted on.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CalibrationThresholds {
    /// `s_0`: standard deviation of a coefficient's prior by its own size, dimensionless. Source:
    /// chosen so that the prior gives no more than the order of magnitude, since the trials that
    /// follow decide.
    pub prior_share: f64,
    /// `m_d`: least standard deviation of every coefficient, by that of the grammar's terms on its
    /// axis, dimensionless. Source: chosen; a share of a coefficient that is nearly zero would fix
    /// it as if it were known.
    pub least_prior_share: f64,
    /// `d_0`: standard deviation where no grammar has a term on the axis, in the unit of the
    /// coefficient (prime systems: dimensionless). Source: chosen, the order of magnitude of a
    /// linear derivative in a prime system.
    pub fallback_deviation: f64,
    /// `s_M`: standard deviation of a virtual mass, by the root of the product of the diagonal
    /// entries, dimensionless; practically fixed. Source: clean trials seemed to determine masses,
    /// and side forces came out 40 % off with standard errors of 5 % (`docs/evidence/diagnosis.md`,
    /// "Virtual masses are held"). Any value far below [`EffectThresholds::mass_deviation`] does
    /// the same.
    ///
    /// [`EffectThresholds::mass_deviation`]: super::effects::EffectThresholds::mass_deviation
    pub mass_prior: f64,
    /// `q_k`: levels of the discrepancy that are evaluated first, the same for all axes, by the
    /// typical acceleration, dimensionless. Source: chosen, half decades between the noise of the
    /// arithmetic and a law that is of no use; refined by [`Self::factors`].
    pub first_levels: [f64; 7],
    /// `f_rk`: factors by which each parameter of the noise model is then multiplied or divided, by
    /// round; coefficients are fitted again between rounds, dimensionless. Source: chosen as a
    /// descending line search that ends within 20 % of the optimum; with a round of 3.0 and 1.6 between
    /// these two, models of the Esso Osaka and their instruments' errors are the same but for a
    /// last factor of 1.2.
    pub factors: [[f64; 2]; 2],
    /// `e_D`: least gain in deviance (minus twice the logarithm of the likelihood) of a change,
    /// dimensionless. Source: chosen; a twentieth of a unit of log-likelihood is far below the half
    /// unit of one standard error.
    pub least_gain: f64,
    /// `r_s`: least noise of an instrument as a share of the noise of its readings alone,
    /// dimensionless. Source: derived: 1 less the rounding of multiplying and dividing by the same
    /// factor.
    pub scatter_share: f64,
    /// `c_0`: least improvement expected by chance (in squared deviations) from which a false-alarm
    /// level is a ratio, dimensionless. Source: chosen; below a thousandth of one degree of freedom
    /// trials have no information on the effect.
    pub least_chance: f64,
    /// `1/d`: false-alarm levels and remainders are rounded to so many parts of 1, so that a
    /// version does not depend on a last digit. Source: chosen, 0.1 % of a quantity that is
    /// compared with 1.
    pub rounding: f64,
    /// `ln B_s`: least evidence for a systematic error of an instrument, natural logarithm. Source:
    /// Esso Osaka's positions, 0.95 s ahead in all trials, are above it
    /// (`docs/evidence/diagnosis.md`, "Measured data"); it must be far above the remainder of a law
    /// that is not quite right, since these trials have calibrated the coefficients already.
    pub systematic_error_evidence: f64,
    /// Share of it that an error must have by one linearisation to be searched for, dimensionless.
    /// Source: chosen; errors of instruments act nearly linearly, and a third allows for evidence
    /// that is three times as large at the estimate. With it Esso Osaka's delay is found as before;
    /// values between have not been tested.
    pub seeming_share: f64,
}

/// Values of calibration.
pub(super) const CALIBRATION: CalibrationThresholds = CalibrationThresholds {
    prior_share: 1.0,
    least_prior_share: 0.1,
    fallback_deviation: 1e-2,
    mass_prior: 1e-6,
    first_levels: [1e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2],
    factors: [[8.0, 3.0], [1.6, 1.2]],
    least_gain: 0.1,
    scatter_share: 0.999,
    least_chance: 1e-3,
    rounding: 1e3,
    systematic_error_evidence: 300.0,
    seeming_share: 1.0 / 3.0,
};

/// The random accelerations that no coefficient explains.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DiscrepancyThresholds {
    /// `w`: initial white part, by the root of the other part's density at zero frequency,
    /// dimensionless. Source: chosen; calibration learns it, so that it is a starting value where a
    /// model has been calibrated.
    pub white_share: f64,
    /// `k_j`: levels that are considered where a model brings its own discrepancy, as factors on
    /// it, dimensionless. Source: chosen: half decades to ten times the level of the calibration,
    /// beyond which the remainder shows that something is missing.
    pub known_factors: [f64; 3],
    /// `k_0`: level below that of the calibration, considered in addition to
    /// [`Self::known_factors`] for effects of a recorded external signal, dimensionless: these were
    /// also present on the trials of the calibration, and are a part of their discrepancy. Source:
    /// chosen, a half decade (`docs/evidence/diagnosis_unseen.md`, "Random divisions").
    pub factor_below: f64,
    /// `s_k`: standard deviation of the natural logarithm of that factor, dimensionless. Source:
    /// chosen, so that a level ten times the known one costs an evidence of 2.7.
    pub known_spread: f64,
    /// `k_j` where a model brings none, as factors on [`Self::least_level`], all equally probable,
    /// dimensionless. Source: chosen, powers of four from the noise of the arithmetic to 4 % of the
    /// typical acceleration.
    pub unknown_factors: [f64; 7],
    /// `q_0`: least level that is considered, by the typical acceleration (`U^2/L`, or `(U/L)^2`),
    /// dimensionless. Source: chosen, far below any instrument's noise.
    pub least_level: f64,
    /// `q_r`: level that is allowed for a model that brings none when the remainder is judged, by
    /// the typical acceleration, dimensionless. Source: chosen.
    pub remainder_level: f64,
}

/// Values of the discrepancy.
pub(super) const DISCREPANCY: DiscrepancyThresholds = DiscrepancyThresholds {
    white_share: 0.05,
    known_factors: [1.0, 3.0, 10.0],
    factor_below: 1.0 / 3.0,
    known_spread: 1.0,
    unknown_factors: [1.0, 4.0, 16.0, 64.0, 256.0, 1024.0, 4096.0],
    least_level: 1e-5,
    remainder_level: 3e-4,
};
