//! Thresholds of changes within a trial.

/// Resolution of the time of a change.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ChangeThresholds {
    /// `T_c`: length of the segments at whose limits a change may begin or end, by `L/U`,
    /// dimensionless. Source: `docs/evidence/diagnosis_unseen.md`, "Half and double": a quarter
    /// dates no change better.
    pub stretch: f64,
    /// `n_1`: fewest segments of a trial, a count. Source: chosen; an eighth of a trial is a time
    /// that helps to find the cause.
    pub fewest: usize,
    /// `n_2`: most segments of a trial, a count: each is a column for each parameter of each
    /// effect. Source: as [`Self::stretch`].
    pub most: usize,
    /// `n_c`: most columns of an effect, a count, where [`Self::fewest`] segments have no more.
    /// Source: as [`Self::stretch`]; the time of a filtering grows with their square.
    pub columns: usize,
    /// `n_t`: most trials that are examined, a count, those with the largest remainders. Source:
    /// chosen; a change on more of them is not limited to one day. With four the changes are the
    /// same, but effects that vary are refused one by one first (same table).
    pub asked: usize,
    /// `n_f`: times in a segment at which a change is then dated, a count. Source: chosen; a tenth
    /// of `L/U`, a few of the shortest steps between samples that are used. Five date as well (same
    /// table).
    pub finer: i32,
    /// `s_t`: least share of the trials with a remainder that the changes of one effect must
    /// explain, dimensionless. Source: chosen, half; the same table.
    pub trials: f64,
    /// `s_w`: largest share of all trials throughout which a change may be present, dimensionless.
    /// Source: chosen, half: an effect that most trials have in one size each is no change in time.
    /// With a quarter, an effect that half of the trials have is not reported (same table).
    pub throughout: f64,
    /// `p_t`: probability on either side of the interval of a change's time, dimensionless. Source:
    /// derived: 95 % lie between.
    pub tail: f64,
}

/// Values of changes.
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
