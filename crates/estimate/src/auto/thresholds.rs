//! Constants of the search, with symbol, meaning, unit and source.

/// How entrants go on, and when trials are cut.
#[derive(Debug, Clone, Copy)]
pub(super) struct SearchThresholds {
    /// `1/eta`: of so many sources of a law one goes on, a count. Source: Jamieson and Talwalkar
    /// 2016 and its successors halve or take a third; `docs/evidence/plain.md`.
    pub share: usize,
    /// `g_t`: error in weak form by the least of it up to which trajectories are fitted,
    /// dimensionless. Source: `docs/evidence/plain.md`.
    pub trajectory_gain: f64,
    /// Most entrants of which trajectories are fitted, a count. Source: `docs/evidence/plain.md`.
    pub trajectories: usize,
    /// Fewer trials are left out in parts, a count. Source: derived: of two, each is fitted by the
    /// other alone, and a scatter has one degree of freedom.
    pub few: usize,
    /// `lambda_h`: strength of a prior that keeps the source, dimensionless. Source: derived: what
    /// the trials say counts for less than the rounding of its coefficients.
    pub kept: f64,
    /// Most sources that enter, by rank of correlation, a count. Source: chosen; each costs a fit
    /// for every law, and correlation has ranked them.
    pub sources: usize,
}

/// The values.
pub(super) const SEARCH: SearchThresholds = SearchThresholds {
    share: 3,
    trajectory_gain: 3.0,
    trajectories: 2,
    few: 3,
    kept: 1e9,
    sources: 5,
};
