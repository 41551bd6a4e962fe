//! Thresholds of changes within a trial.

/// How finely a change is dated.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ChangeThresholds {
    /// `T_c`: length of the stretches at whose ends a change may begin or end, by `L/U`,
    /// dimensionless. Source: `docs/evidence/diagnosis_unseen.md`, "Half and double": a quarter
    /// dates no change better.
    pub stretch: f64,
    /// `n_1`: fewest stretches of a trial, a count. Source: chosen; an eighth of a trial is a
    /// time that helps to find what happened.
    pub fewest: usize,
    /// `n_2`: most stretches of a trial, a count: each is a column for each parameter of each
    /// effect. Source: as [`Self::stretch`].
    pub most: usize,
    /// `n_c`: most columns of an effect, a count, where [`Self::fewest`] stretches have no more.
    /// Source: as [`Self::stretch`]; the time of a filtering goes with their square.
    pub columns: usize,
    /// `n_t`: most trials that are asked, a count, those that leave most. Source: chosen; what
    /// changed on more of them is not of one day. With four the changes are the same, but effects
    /// that vary are refused one by one first (same table).
    pub asked: usize,
    /// `n_f`: times in a stretch at which a change is then dated, a count. Source: chosen; a tenth
    /// of `L/U`, a few of the shortest steps between samples that are used. Five date as well (same
    /// table).
    pub finer: i32,
    /// `s_t`: least share of the trials that leave something which the changes of one effect must
    /// explain, dimensionless. Source: chosen, half; the same table.
    pub trials: f64,
    /// `s_w`: largest share of all trials that a change may be there throughout, dimensionless.
    /// Source: chosen, half: what most trials have in one size each is no change in time. With a
    /// quarter, what half of the trials have is not told (same table).
    pub throughout: f64,
    /// `p_t`: probability on either side of the interval of a change's time, dimensionless. Source:
    /// derived: 95 % lie between.
    pub tail: f64,
}

/// The values.
pub(super) const CHANGES: ChangeThresholds = ChangeThresholds {
    stretch: 1.0,
    fewest: 8,
    most: 30,
    columns: 40,
    asked: 8,
    finer: 10,
    trials: 0.5,
    throughout: 0.5,
    tail: 0.025,
};
