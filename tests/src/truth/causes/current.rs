//! Water that moves over the ground, and turns as it does.

/// A uniform current.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Current {
    /// Speed, m/s.
    pub speed_m_s: f64,
    /// Towards which it flows at half time, rad.
    pub towards_rad: f64,
    /// By how much it turns during a trial, rad.
    pub turns_rad: f64,
}

impl Current {
    /// Along and across a ship at a heading (rad), m/s, at a share of the trial.
    pub fn seen(&self, share: f64, heading_rad: f64) -> [f64; 2] {
        let towards = self.towards_rad + (share - 0.5) * self.turns_rad - heading_rad;
        [self.speed_m_s * towards.cos(), self.speed_m_s * towards.sin()]
    }

    /// Rates of these on a ship that turns at `r` (rad/s) in a trial of a duration (s): `r v_c + w
    /// (-v_c)` and `-r u_c + w u_c`, with `w` the rate at which the current turns.
    pub fn rates(&self, [along, across]: [f64; 2], r: f64, duration_s: f64) -> [f64; 2] {
        let turning = r - self.turns_rad / duration_s;
        [turning * across, -turning * along]
    }
}
