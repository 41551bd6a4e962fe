//! Between the rudder that is recorded and the one that is there.

/// What the gear does, one after another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Gear {
    /// Stands at another angle by so much, rad.
    Offset(f64),
    /// Follows by a second-order system: delay of its step response in the mean, s, and damping.
    SecondOrder(f64, f64),
    /// Follows only when the record has left a band of so much to either side, rad.
    DeadBand(f64),
    /// Turns by a share of the record only, from half time on.
    Damaged(f64),
}

/// Where a gear stands.
#[derive(Debug, Clone, Copy)]
pub(super) struct Standing {
    gear: Gear,
    angle_rad: f64,
    rate_rad_s: f64,
}

impl Standing {
    pub fn new(gear: Gear) -> Self {
        Self { gear, angle_rad: 0.0, rate_rad_s: 0.0 }
    }

    /// The angle after a step of so many seconds, at a share of the trial.
    pub fn after(&mut self, recorded_rad: f64, share: f64, step_s: f64) -> f64 {
        match self.gear {
            Gear::Offset(offset) => self.angle_rad = recorded_rad + offset,
            Gear::DeadBand(half) => {
                self.angle_rad = self.angle_rad.clamp(recorded_rad - half, recorded_rad + half);
            }
            Gear::Damaged(left) => {
                self.angle_rad = if share < 0.5 { recorded_rad } else { left * recorded_rad };
            }
            Gear::SecondOrder(delay_s, damping) => {
                self.follow(recorded_rad, delay_s, damping, step_s)
            }
        }
        self.angle_rad
    }

    /// `a'' + 2 z w a' + w^2 (a - recorded) = 0` with `2 z/w` the delay, in ten steps that are
    /// implicit in the rate.
    fn follow(&mut self, recorded_rad: f64, delay_s: f64, damping: f64, step_s: f64) {
        let omega = 2.0 * damping / delay_s;
        let dt = step_s / 10.0;
        for _ in 0..10 {
            let pull = omega.powi(2) * (recorded_rad - self.angle_rad);
            self.rate_rad_s = (self.rate_rad_s + dt * pull) / (1.0 + 2.0 * damping * omega * dt);
            self.angle_rad += dt * self.rate_rad_s;
        }
    }
}
