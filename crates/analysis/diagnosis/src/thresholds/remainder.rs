//! Thresholds of the remainder of a hypothesis.

use sistership_model::trial::Channel;

/// Detection of an unexplained remainder.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RemainderThresholds {
    /// `T_b`: time over which prediction errors are summed, by `L/U`, dimensionless: lasting errors
    /// stand out. Source: chosen, shorter than any manoeuvre lasts.
    pub block: f64,
    /// `n_b`: number of blocks that are judged together, a count. Source: chosen; with
    /// [`Self::block`] a segment of 3.6 lengths.
    pub blocks: usize,
    /// `z_r`: root mean square of the sums, in standard deviations, above which a segment is not
    /// noise, where clean trials give no other limit, dimensionless. Source: derived: with six
    /// blocks of white errors, `P(chi^2_6 > 54) = 7e-10`, so that it is not chance in any number of
    /// trials.
    pub limit: f64,
    /// `k_r`: least ratio of a segment to that of any clean trial, dimensionless. Source: chosen;
    /// the benchmark has 27 of 27 unlisted effects unexplained with it, and nothing named on 20 of
    /// 20 clean sets.
    pub margin: f64,
    /// Channels whose equations are judged. Source: derived: those with a velocity of their own,
    /// and the heading.
    pub channels: [Channel; 5],
}

/// Values of the remainder.
pub(super) const REMAINDER: RemainderThresholds = RemainderThresholds {
    block: 0.6,
    blocks: 6,
    limit: 3.0,
    margin: 1.25,
    channels: [Channel::U, Channel::V, Channel::R, Channel::P, Channel::Psi],
};

/// Search for the origin of a remainder.
#[derive(Debug, Clone, Copy)]
pub(crate) struct OriginThresholds {
    /// `f_o`: factors on a standard deviation that are evaluated, dimensionless. Source: derived:
    /// two neighbours differ by a doubling, between which the log likelihood of `n` readings moves
    /// by at most `n/6`, the same for all; with 32 times the deviation, readings have no more
    /// information on a trial.
    pub factors: [f64; 5],
    /// `n_o`: most trials that are examined, a count. Source: as many as are examined for changes.
    pub asked: usize,
    /// `n_w`: number of origins that are reported, a count. Source: chosen, as many as variables.
    pub shown: usize,
}

/// Values of the origin.
pub(super) const ORIGIN: OriginThresholds =
    OriginThresholds { factors: [2.0, 4.0, 8.0, 16.0, 32.0], asked: 8, shown: 3 };

/// Search for the variables on which a remainder depends.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DependenceThresholds {
    /// `n_g`: number of trees of the forest, a count. Source: chosen; the mean over more moves
    /// shares by less than their scatter between the halves.
    pub trees: usize,
    /// `n_f`: fewest samples in a leaf, a count. Source: chosen; a step of a curve
    /// has at least a fiftieth of a series of [`super::trials::SeriesThresholds::points`].
    pub leaf: usize,
    /// `n_d`: most splits from root to leaf, a count. Source: chosen; 64 steps of a staircase.
    pub depth: usize,
    /// `n_h`: number of blocks into which a series is divided, every second of which is used for
    /// learning, a count. Source: chosen; a zigzag's half period or longer in records of usual
    /// length.
    pub blocks: usize,
    /// `n_s`: fewest samples of a block, a count; of shorter series every second one is used for
    /// learning as a whole. Source: chosen; with fewer, a block would mostly consist of its ends,
    /// which are like their neighbours.
    pub block: usize,
    /// `n_m`: fewest samples of an acceleration, a count. Source: derived: twice the fewest from
    /// which a learned correction is trained, as half is used for learning.
    pub samples: usize,
    /// `n_c`: number of points of a curve, a count. Source: chosen, about as many as a small plot
    /// shows.
    pub points: usize,
    /// `s_d`: share of the variance above which a variable is shown, dimensionless. Source: chosen;
    /// shuffling a variable of no influence moves the error by about a hundredth of the variance.
    pub share: f64,
    /// `n_v`: number of variables that are shown, a count. Source: chosen.
    pub shown: usize,
}

/// Values of the dependence.
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

/// Patterns of the remainder.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PatternThresholds {
    /// `s_k`: standard deviation of the size of a pattern, by the typical acceleration (`U^2/L`, or
    /// `(U/L)^2`), dimensionless. Source: chosen, the order of the smallest force that changes a
    /// manoeuvre.
    pub size: f64,
    /// `n_k`: number of harmonics of the heading, a count. Source: chosen; forces by the direction
    /// of an influence have two, and one more shows any other dependence.
    pub harmonics: i32,
    /// `s_u`: loss of speed by the approach speed that is one unit, dimensionless. Source: chosen,
    /// that of a turn.
    pub speed: f64,
    /// `s_d`: rudder angle that is one unit, rad. Source: derived: 20 deg, a usual order.
    pub rudder_rad: f64,
    /// `T_k`: periods that are evaluated, by `L/U`, dimensionless. Source: chosen: factors of 1.25
    /// from a few samples to the half of a short trial; a sine between two of them over ten periods
    /// has half of the power at the nearest.
    pub periods: [f64; 12],
}

/// Values of patterns.
pub(super) const PATTERNS: PatternThresholds = PatternThresholds {
    size: 0.01,
    harmonics: 3,
    speed: 0.3,
    rudder_rad: 0.349,
    periods: [0.8, 1.0, 1.25, 1.56, 1.95, 2.44, 3.05, 3.81, 4.77, 5.96, 7.45, 9.31],
};
