//! Thresholds of what a hypothesis leaves.

use sistership_model::trial::Channel;

/// When something remains unexplained.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RemainderThresholds {
    /// `T_b`: time over which prediction errors are added up, by `L/U`, dimensionless: what lasts
    /// stands out. Source: chosen, shorter than any manoeuvre lasts.
    pub block: f64,
    /// `n_b`: blocks that are judged together, a count. Source: chosen; with [`Self::block`] a
    /// stretch of 3.6 lengths.
    pub blocks: usize,
    /// `z_r`: root mean square of the sums, in deviations, above which a stretch is not noise where
    /// clean trials say nothing else, dimensionless. Source: derived: with six blocks of white
    /// errors, `P(chi^2_6 > 54) = 7e-10`, so that it is not chance in any number of trials.
    pub limit: f64,
    /// `k_r`: how many times larger than on any clean trial a stretch must be, dimensionless.
    /// Source: chosen; the benchmark has 27 of 27 unlisted effects unexplained with it, and nothing
    /// named on 20 of 20 clean sets.
    pub margin: f64,
    /// The channels whose equations are judged. Source: derived: those with a velocity of their
    /// own, and the heading.
    pub channels: [Channel; 5],
}

/// The remainder's values.
pub(super) const REMAINDER: RemainderThresholds = RemainderThresholds {
    block: 0.6,
    blocks: 6,
    limit: 3.0,
    margin: 1.25,
    channels: [Channel::U, Channel::V, Channel::R, Channel::P, Channel::Psi],
};

/// How it is asked where a remainder comes from.
#[derive(Debug, Clone, Copy)]
pub(crate) struct OriginThresholds {
    /// `f_o`: factors on a standard deviation that are tried, dimensionless. Source: derived: two
    /// neighbours are apart by a doubling, between which the log likelihood of `n` readings moves by
    /// at most `n/6`, the same for all; what is 32 times as random says nothing of a trial any more.
    pub factors: [f64; 5],
    /// `n_o`: most trials that are asked, a count. Source: as many as are asked for changes.
    pub asked: usize,
    /// `n_w`: origins that are told, a count. Source: chosen, as many as variables.
    pub shown: usize,
}

/// The origin's values.
pub(super) const ORIGIN: OriginThresholds =
    OriginThresholds { factors: [2.0, 4.0, 8.0, 16.0, 32.0], asked: 8, shown: 3 };

/// How it is asked on what a remainder depends.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DependenceThresholds {
    /// `n_g`: trees of the forest, a count. Source: chosen; the mean over more moves shares by less
    /// than their scatter between the halves.
    pub trees: usize,
    /// `n_f`: fewest samples in a leaf, a count. Source: chosen; a step of a curve
    /// has at least a fiftieth of a series of [`super::trials::SeriesThresholds::points`].
    pub leaf: usize,
    /// `n_d`: most splits from root to leaf, a count. Source: chosen; 64 steps of a staircase.
    pub depth: usize,
    /// `n_h`: blocks into which a series is cut, every second of which is learned from, a count.
    /// Source: chosen; a zigzag's half period or longer in records of usual length.
    pub blocks: usize,
    /// `n_s`: fewest samples of a block, a count; of shorter series every second one is learned
    /// from as a whole. Source: chosen; with fewer a block's ends, which are like their neighbours, are
    /// most of it.
    pub block: usize,
    /// `n_m`: fewest samples of an acceleration, a count. Source: derived: the fewest from which a
    /// branch is trained, twice, as half is learned from.
    pub samples: usize,
    /// `n_c`: points of a curve, a count. Source: chosen, about what a small plot shows.
    pub points: usize,
    /// `s_d`: share of the variance above which a variable is shown, dimensionless. Source: chosen;
    /// what is shuffled without need moves the error by about a hundredth of the variance.
    pub share: f64,
    /// `n_v`: variables that are shown, a count. Source: chosen.
    pub shown: usize,
}

/// The dependence's values.
pub(super) const DEPENDENCE: DependenceThresholds = DependenceThresholds {
    trees: 40,
    leaf: 5,
    depth: 6,
    blocks: 16,
    block: 4,
    samples: 80,
    points: 9,
    share: 0.05,
    shown: 3,
};
