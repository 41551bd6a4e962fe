//! Thresholds of the judgement of an effect.

/// Accuracy of effects and of their laws.
#[derive(Debug, Clone, Copy)]
pub(crate) struct EffectThresholds {
    /// `s_a`: relative error of the size of an effect's response by its own law, dimensionless.
    /// Source: decision 5 ("an effect's own law is trusted within 3 %"), introduced after the
    /// benchmark had named shadows of strong effects without it.
    pub size: f64,
    /// `s_f`: relative error of its shape, dimensionless. Source: as [`Self::size`], "0.3 % in
    /// shape" (`docs/evidence/diagnosis.md`).
    pub shape: f64,
    /// `k_m`: multiple of its misfit by which a form may differ from the true one before its
    /// remainder is attributed to a further effect, dimensionless. Source: derived: a misfit is a
    /// root mean square over authors, of which 95 % are within twice as much.
    pub misfits: f64,
    /// `T_f`: time by which another published form may be later, by `L/U`, dimensionless. Source:
    /// chosen, the order of the time constants of steering gear.
    pub form_memory: f64,
    /// `D_0`: divisor of the information on an effect where a model brings no uncertainty,
    /// dimensionless. Source: chosen; published coefficients have no clean trials on which a
    /// false-alarm level could be measured.
    pub unknown_discount: f64,
    /// `s_m`: relative error of virtual masses, by strip theory or regression, by the root of the
    /// product of the diagonal entries, dimensionless. Source: chosen, a judgement of strip theory
    /// and regressions; it widens standard errors of forces and decides nothing.
    pub mass_deviation: f64,
    /// `x_j`: shares of a trial by which a recorded external signal is shifted to make its placebo,
    /// dimensionless. Source: chosen: quarters are as far from the record and from each other as
    /// three shifts can be.
    pub placebo_shifts: [f64; 3],
    /// `w_0`: least difference of a recorded external signal from itself at other times for these
    /// to be a placebo, root mean square of the difference over `sqrt(2)` by that of the record,
    /// dimensionless. Source: chosen; with a turbulence of 10 to 20 % gusts alone suffice, while an
    /// anemometer's scatter about a steady wind does not.
    pub least_variation: f64,
    /// `z_s`: quantile of the standard normal distribution of the improbability of a form's
    /// coefficients, given published ones, beyond which they are attributed to another effect,
    /// dimensionless. Source: derived: one in a thousand right ones is refused. On the work half,
    /// chi-squares by their degrees of freedom were at most 1.4 where the effect was present, and
    /// 4.5 to 15 where a force of no effect was attributed to it; 22.5 of 6 is this limit.
    pub shape_quantile: f64,
    /// `z_0`: least size of an effect that is named, by its standard error, dimensionless. Source:
    /// derived: the half width of an interval of 95 % that does not contain zero.
    pub least_size: f64,
    /// `h`: step of numerical derivatives of reported values, by the parameter's standard error,
    /// dimensionless. Source: derived: central differences err by its square.
    pub report_step: f64,
}

/// Values of effects.
pub(super) const EFFECT: EffectThresholds = EffectThresholds {
    size: 0.03,
    shape: 0.003,
    misfits: 2.0,
    form_memory: 0.2,
    unknown_discount: 10.0,
    mass_deviation: 0.08,
    placebo_shifts: [0.25, 0.5, 0.75],
    least_variation: 0.15,
    shape_quantile: 3.09,
    least_size: 2.0,
    report_step: 1e-3,
};

/// Constancy of an effect in time.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ConstancyThresholds {
    /// `n_p`: number of pieces into which each trial is divided, a count. Source:
    /// `docs/evidence/diagnosis.md`, "the same size in both halves of every trial".
    pub pieces: usize,
    /// `v_p`: largest improvement by separate sizes in the pieces, beyond the common size and
    /// beyond chance, by the response to that size: a squared share, dimensionless; that of a
    /// form's misfit where it is larger. Source: chosen, sizes in the halves that differ by about a
    /// third.
    pub limit: f64,
    /// `r_0`: least response in that ratio, in squared deviations. Source: derived: it prevents a
    /// division by zero.
    pub least_response: f64,
}

/// Values of constancy.
pub(super) const CONSTANCY: ConstancyThresholds =
    ConstancyThresholds { pieces: 2, limit: 0.1, least_response: 1e-9 };

/// Distinction of two effects.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ConfoundingThresholds {
    /// `theta_a`: angle between two responses from which on effects count as different, deg.
    /// Source: chosen; at 40 deg the other effect follows `cos^2 = 59 %` of the response.
    pub apart_deg: f64,
    /// `e_r`: ridge on another effect's information by its largest diagonal entry, dimensionless.
    /// Source: derived: parameters with the same response on these trials make it singular, and
    /// this is far below any information of interest.
    pub ridge: f64,
}

/// Values of confounding.
pub(super) const CONFOUNDING: ConfoundingThresholds =
    ConfoundingThresholds { apart_deg: 40.0, ridge: 1e-9 };
