//! Row of a log.

/// Values of a row, in SI units and radians; NaN for missing values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LogSample {
    /// Time, s.
    pub t_s: f64,
    /// Rudder angle, rad.
    pub rudder_rad: f64,
    /// Propeller revolutions, 1/s.
    pub revolutions_rps: f64,
    /// Yaw rate, rad/s; the heading is used where it is not measured.
    pub yaw_rate_rad_s: f64,
    /// Heading, rad, continuous or not.
    pub heading_rad: f64,
    /// Speed, m/s.
    pub speed_m_s: f64,
}
