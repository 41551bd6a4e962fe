//! Thresholds of the search among hypotheses, and of the fit that follows it.

/// How hypotheses are searched.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SearchThresholds {
    /// `n_j`: how many of the most probable by one linearisation are judged where they stand, a
    /// count. Source: chosen, what a diagnosis of seconds affords (decision 5, "What it costs").
    pub judged: usize,
    /// `n_c`: the same for companions of an effect that is taken, a count. Source: as
    /// [`Self::judged`].
    pub companions: usize,
    /// `n_s`: rounds in which coefficients and effects are fitted together, everything linearised
    /// anew, a count. Source: chosen; the second round starts where the first has ended, so that
    /// what it changes is of second order.
    pub joint_rounds: usize,
    /// `n_r`: rounds in which a hypothesis is linearised anew where it stands, a count. Source:
    /// chosen, as [`Self::joint_rounds`]; [`Self::same`] ends them earlier.
    pub rounds: usize,
    /// `ln B_0`: evidence that makes no difference, natural logarithm. Source: derived: below 1 it
    /// is "not worth more than a bare mention" (Kass and Raftery 1995, J Am Stat Assoc 90, 773-795,
    /// section 3.2).
    pub same: f64,
    /// `ln B_x`: by how much more evidence another effect must have to take the place of one in a
    /// set, natural logarithm. Source: derived: the limit of the same scale above which evidence is
    /// positive.
    pub exchange: f64,
}

/// The search's values.
pub(super) const SEARCH: SearchThresholds = SearchThresholds {
    judged: 6,
    companions: 3,
    joint_rounds: 2,
    rounds: 3,
    same: 0.5,
    exchange: 1.0,
};

/// The fit of the model that is given.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RefitThresholds {
    /// `lambda_k`: strengths of the prior that are weighed where the effects stay as they were
    /// found, dimensionless. Source: chosen, decades from 1; errors on trials left out choose among
    /// them.
    pub strengths: [f64; 4],
    /// `T_d`: time over which accelerations are differenced, by `L/U`, dimensionless. Source:
    /// decision 2, with the table of how errors move from one sample to 0.2.
    pub difference: f64,
}

/// The refit's values.
pub(super) const REFIT: RefitThresholds =
    RefitThresholds { strengths: [1000.0, 100.0, 10.0, 1.0], difference: 0.1 };
