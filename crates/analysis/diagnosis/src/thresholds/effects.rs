//! Thresholds of what is said of an effect.

/// How far effects and their laws are trusted.
#[derive(Debug, Clone, Copy)]
pub(crate) struct EffectThresholds {
    /// `s_a`: how far the size of what an effect's own law gives is from the truth, dimensionless.
    /// Source: decision 5 ("an effect's own law is trusted within 3 %"), put in after the benchmark
    /// had named shadows of strong effects without it.
    pub size: f64,
    /// `s_f`: how far its shape is, dimensionless. Source: as [`Self::size`], "0.3 % in shape"
    /// (`docs/evidence/diagnosis.md`).
    pub shape: f64,
    /// `k_m`: how many times its misfit a form may be from nature's before what it leaves is taken
    /// for an effect beside it, dimensionless. Source: derived: a misfit is a root mean square over
    /// authors, of which 95 % are within twice as much.
    pub misfits: f64,
    /// `D_0`: what the information on an effect is divided by where a model brings no uncertainty,
    /// dimensionless. Source: chosen; published coefficients have no clean trials on which a
    /// false-alarm level could be measured.
    pub unknown_discount: f64,
    /// `s_m`: how far virtual masses, by strip theory or regression, are from the truth, by the
    /// root of the product of the diagonal entries, dimensionless. Source: chosen, a judgement of
    /// strip theory and regressions; it widens standard errors of forces and decides nothing.
    pub mass_deviation: f64,
    /// `x_j`: shares of a trial by which a record from outside is shifted to make its placebo,
    /// dimensionless. Source: chosen: quarters are as far from the record and from each other as
    /// three shifts can be.
    pub placebo_shifts: [f64; 3],
    /// `w_0`: how much a record from outside must differ from itself at other times for these to be
    /// a placebo, root mean square of the difference over `sqrt(2)` by that of the record,
    /// dimensionless. Source: chosen; with a turbulence of 10 to 20 % gusts alone do it, while an
    /// anemometer's scatter about a steady wind does not.
    pub least_variation: f64,
    /// `z_s`: how improbable the coefficients of a form may be under what authors have before they
    /// are held for another effect's, quantile of the standard normal distribution, dimensionless.
    /// Source: derived: one in a thousand right ones is refused. On the work half, chi-squares by
    /// their degrees of freedom were at most 1.4 where the effect was there, and 4.5 to 15 where a
    /// force that no effect has was taken for it; 22.5 of 6 is this limit.
    pub shape_quantile: f64,
    /// `h`: step of numerical derivatives of what is reported, by the parameter's standard error,
    /// dimensionless. Source: derived: central differences err by its square.
    pub report_step: f64,
}

/// The effects' values.
pub(super) const EFFECT: EffectThresholds = EffectThresholds {
    size: 0.03,
    shape: 0.003,
    misfits: 2.0,
    unknown_discount: 10.0,
    mass_deviation: 0.08,
    placebo_shifts: [0.25, 0.5, 0.75],
    least_variation: 0.15,
    shape_quantile: 3.09,
    report_step: 1e-3,
};

/// Whether an effect is the same at all times.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ConstancyThresholds {
    /// `n_p`: pieces into which each trial is cut, a count. Source: `docs/evidence/diagnosis.md`,
    /// "the same size in both halves of every trial".
    pub pieces: usize,
    /// `v_p`: what the pieces may ask for beyond the common size and beyond chance, by the response
    /// to that size: a squared share, dimensionless; that of a form's misfit where it is larger.
    /// Source: chosen, sizes in the halves that differ by about a third.
    pub limit: f64,
    /// `r_0`: least response by which that is divided, in squared deviations. Source: derived:
    /// keeps a division by zero away.
    pub least_response: f64,
}

/// Constancy's values.
pub(super) const CONSTANCY: ConstancyThresholds =
    ConstancyThresholds { pieces: 2, limit: 0.1, least_response: 1e-9 };

/// When two effects count as different.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ConfoundingThresholds {
    /// `theta_a`: angle between two responses from which on effects count as different, deg.
    /// Source: chosen; at 40 deg the other effect follows `cos^2 = 59 %` of the response.
    pub apart_deg: f64,
    /// `e_r`: ridge on another effect's information by its largest diagonal entry, dimensionless.
    /// Source: derived: parameters that say the same on these trials make it singular, and this is
    /// far below what matters.
    pub ridge: f64,
}

/// Confounding's values.
pub(super) const CONFOUNDING: ConfoundingThresholds =
    ConfoundingThresholds { apart_deg: 40.0, ridge: 1e-9 };
