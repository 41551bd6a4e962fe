//! Constants of the segmentation, with symbol, meaning, unit and source.
//!
//! `T = L/U` is the time in which a ship travels its own length. Where the source is the test
//! table, `finder_tests.rs` checks that half and double the value find the same manoeuvres.

/// Thresholds between course keeping and movements of the controls.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SegmentThresholds {
    /// `Fn`: Froude number by which a length is estimated from a speed if none is given,
    /// dimensionless. Source: merchant ships in service have 0.15 to 0.25 (Molland, Turnock and
    /// Hudson, Ship Resistance and Propulsion, 2011).
    pub froude: f64,
    /// `L_0`: least length that is estimated from a speed, m. Source: derived: free-running models
    /// are longer, whatever slow speed the median of a record is.
    pub least_length_m: f64,
    /// `t_c`: time over which rudder, revolutions and yaw are averaged, by `T`. Source: derived:
    /// longer than the period of waves met (6 to 12 s, where `T` is 15 to 40 s), shorter than a
    /// zigzag holds its rudder (2 to 4 `T`).
    pub cell: f64,
    /// `t_w`: time over which the steady level and scatter are determined, by `T`. Source: the test
    /// table; at 10 knots and 150 m about two hours, in which weather and load hardly change.
    pub level: f64,
    /// `q`: fraction of the deviations from the median that counts as steady, dimensionless; their
    /// quantile `q` is divided by that of a standard normal distribution. Source: derived: a median
    /// absolute deviation (0.5) breaks down when half of the time is manoeuvring, this one when
    /// three quarters are.
    pub share: f64,
    /// `z_q`: that quantile of the absolute value of a standard normal variable. Source: derived
    /// from `q`.
    pub normal: f64,
    /// `k`: scatters beyond which a control moves, dimensionless. Source: derived: a normal
    /// variable is beyond six once in 5e8; a month has 1e5 to 1e6 intervals. The test table has
    /// half and double.
    pub controls: f64,
    /// `delta_0`: smallest movement of the rudder, rad. Source: derived: half of the 5 deg of the
    /// smallest standard zigzag.
    pub rudder_rad: f64,
    /// `dn_0`: smallest change of revolutions, by their median. Source: derived: in a seaway they
    /// vary by one or two hundredths; the test table.
    pub revolutions: f64,
    /// `k_a`: scatters of yaw rate and speed beyond which the ship still responds, dimensionless.
    /// Source: derived: exceeded by chance once in 370 intervals, so that ends are not delayed.
    pub answer: f64,
    /// `r'_0`: smallest yaw rate that is a response, by `U/L`. Source: derived: a tenth of that in
    /// a 10/10 zigzag (0.2 to 0.3 by IMO MSC.137(76) and its ships).
    pub yaw: f64,
    /// `du_0`: smallest change of speed within `T` that is a response, by `U`. Source: the test
    /// table.
    pub speed: f64,
    /// `t_j`: movements closer than this are one manoeuvre, by `T`. Source: derived: a ship has
    /// responded to a rudder after 2 to 4 lengths (its time constant `T'` is 0.5 to 4).
    pub join: f64,
    /// `t_a`: longest time for which the response of the ship is followed, by `T`. Source: stopping
    /// from full speed takes 15 lengths of track at most (IMO MSC.137(76)), at half the speed on
    /// average 30 `T`.
    pub follow: f64,
    /// `t_l`: steady approach before the first movement, by `T`. Source: derived: the initial state
    /// is determined from it, and windows of a regression need a few samples.
    pub lead: f64,
    /// `t_s`: time after the last response, by `T`. Source: as `t_l`.
    pub settle: f64,
    /// `t_log`: records longer than this are logs, by `T`. Source: derived: three full circles and
    /// a zigzag of five reversals take less than 100; a programme of a whole afternoon less than
    /// 400.
    pub log: f64,
    /// Largest fraction of a log that its segments may be, dimensionless. Source: derived from `q`:
    /// beyond, the steady level is not known well.
    pub most: f64,
    /// `t_d`: steady spans shorter than this are not listed, by `T`. Source: derived: a drift of
    /// the model shows over many ship lengths, and a list should be readable.
    pub steady: f64,
}

/// Values of the thresholds.
pub(crate) const THRESHOLDS: SegmentThresholds = SegmentThresholds {
    froude: 0.2,
    least_length_m: 0.5,
    cell: 0.5,
    level: 400.0,
    share: 0.25,
    normal: 0.318_639,
    controls: 6.0,
    rudder_rad: 0.043_633,
    revolutions: 0.05,
    answer: 3.0,
    yaw: 0.025,
    speed: 0.01,
    join: 5.0,
    follow: 30.0,
    lead: 2.0,
    settle: 2.0,
    log: 500.0,
    most: 0.5,
    steady: 50.0,
};

/// Thresholds of the classification of manoeuvres.
#[derive(Debug, Clone, Copy)]
pub(crate) struct KindThresholds {
    /// Fraction of the largest rudder angle that counts as holding it, dimensionless. Source:
    /// derived: a helmsman who meets a turn uses less than in the turn, a zigzag the same angle.
    pub hold: f64,
    /// Number of holds of alternating sides that form a zigzag, a count. Source: ITTC 7.5-04-02-01:
    /// one execute and two reversals give the first two overshoots.
    pub zigzag: usize,
    /// Change of heading from which a manoeuvre is a turn, rad. Source: ITTC 7.5-04-02-01: the
    /// tactical diameter is measured at half a turn.
    pub turn_rad: f64,
    /// Change of heading from which a manoeuvre is a course change, rad. Source: as `turn_rad`:
    /// figures of the initial turn are measured from 10 deg; half of it.
    pub course_rad: f64,
    /// Time for which the rudder is amidships while the ship continues to turn, for a pull-out, by
    /// `T`. Source: derived: longer than the rudder passes amidships when a turn is met.
    pub pull_out: f64,
    /// Remaining speed, divided by that before, below which a manoeuvre is a stop, dimensionless.
    /// Source: derived.
    pub stopped: f64,
}

/// Values of the thresholds of the classification.
pub(crate) const KINDS: KindThresholds = KindThresholds {
    hold: 0.4,
    zigzag: 3,
    turn_rad: std::f64::consts::PI,
    course_rad: 0.087_266,
    pull_out: 2.0,
    stopped: 0.5,
};
