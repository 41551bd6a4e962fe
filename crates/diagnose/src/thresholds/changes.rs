//! Thresholds of changes within a trial.

/// How finely a change is dated.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ChangeThresholds {
    /// `T_c`: length of the stretches at whose ends a change may begin or end, by `L/U`,
    /// dimensionless. Source: chosen, about as long as what is added up to tell that something
    /// remains.
    pub stretch: f64,
    /// `n_1`: fewest stretches of a trial, a count. Source: chosen; an eighth of a trial is a
    /// time that helps to find what happened.
    pub fewest: usize,
    /// `n_2`: most stretches of a trial, a count. Source: chosen; each is a column for each
    /// parameter of each effect, and a sixtieth of a trial is as fine as a plot shows.
    pub most: usize,
    /// `n_c`: most columns of an effect, a count, where [`Self::fewest`] stretches have no more.
    /// Source: chosen; the time of a filtering goes with their square.
    pub columns: usize,
    /// `n_t`: most trials that are asked, a count, those that leave most. Source: chosen; what
    /// changed on more of them is not of one day.
    pub asked: usize,
    /// `n_f`: times in a stretch at which a change is then dated, a count. Source: chosen; a
    /// twentieth of `L/U`, about the shortest step between samples that are used.
    pub finer: i32,
    /// `s_t`: least share of the trials that leave something which the changes of one effect must
    /// explain, dimensionless. Source: chosen, half; see `docs/evidence/diagnosis_unseen.md`.
    pub trials: f64,
    /// `s_w`: largest share of all trials that a change may be there throughout, dimensionless.
    /// Source: chosen, half: what most trials have in one size each is no change in time.
    pub throughout: f64,
    /// `p_t`: probability on either side of the interval of a change's time, dimensionless. Source:
    /// derived: 95 % lie between.
    pub tail: f64,
}

/// The values.
pub(super) const CHANGES: ChangeThresholds = ChangeThresholds {
    stretch: 0.5,
    fewest: 8,
    most: 60,
    columns: 80,
    asked: 8,
    finer: 10,
    trials: 0.5,
    throughout: 0.5,
    tail: 0.025,
};
