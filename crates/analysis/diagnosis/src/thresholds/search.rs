//! Thresholds of the search among hypotheses, and of the fit that follows it.

/// Search among hypotheses.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SearchThresholds {
    /// `n_j`: number of hypotheses, the most probable by one linearisation, that are linearised and
    /// judged at their estimates, a count. Source: chosen, as a diagnosis of seconds allows
    /// (decision 5, "What it costs").
    pub judged: usize,
    /// `n_c`: number of companions of an accepted effect that are judged so, a count. Source: as
    /// [`Self::judged`].
    pub companions: usize,
    /// `n_s`: rounds in which coefficients and effects are fitted together, everything linearised
    /// again, a count. Source: chosen; the second round starts at the end of the first, so that its
    /// change is of second order.
    pub joint_rounds: usize,
    /// `n_r`: rounds in which a hypothesis is linearised again at its estimate, a count. Source:
    /// chosen, as [`Self::joint_rounds`]; [`Self::same`] ends them earlier.
    pub rounds: usize,
    /// `ln B_0`: evidence that makes no difference, natural logarithm. Source: derived: below 1 it
    /// is "not worth more than a bare mention" (Kass and Raftery 1995, J Am Stat Assoc 90, 773-795,
    /// section 3.2).
    pub same: f64,
    /// `ln B_x`: least additional evidence of another effect that replaces one in a set, natural
    /// logarithm. Source: derived: the limit of the same scale above which evidence is positive.
    pub exchange: f64,
}

/// Values of the search.
pub(super) const SEARCH: SearchThresholds = SearchThresholds {
    judged: 6,
    companions: 3,
    joint_rounds: 2,
    rounds: 3,
    same: 0.5,
    exchange: 1.0,
};

/// Final fit of coefficients and effects.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RefitThresholds {
    /// `lambda_k`: strengths of the prior that are evaluated where the effects stay as they were
    /// found, dimensionless. Source: chosen, decades from 1; errors on held-out trials choose among
    /// them.
    pub strengths: [f64; 4],
    /// `T_d`: time over which accelerations are differenced, by `L/U`, dimensionless. Source:
    /// decision 2, with the table of errors from one sample to 0.2.
    pub difference: f64,
}

/// Values of the refit.
pub(super) const REFIT: RefitThresholds =
    RefitThresholds { strengths: [1000.0, 100.0, 10.0, 1.0], difference: 0.1 };
