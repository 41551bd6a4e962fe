//! A propeller in the wake.

/// Open-water thrust and the hull's part in it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Propeller {
    /// Diameter, m.
    pub diameter_m: f64,
    /// Thrust coefficient `K_T = k[0] + k[1] J + k[2] J^2`.
    pub thrust: [f64; 3],
    /// Wake fraction ahead.
    pub wake: f64,
    /// How fast it goes with the drift at the propeller: `w = wake exp(-c beta_P^2)`, 4 in Hirano
    /// (1980).
    pub wake_by_drift: f64,
    /// Thrust deduction fraction.
    pub deduction: f64,
}

impl Propeller {
    /// Speed of advance, m/s, at the ship's speed and the drift angle (rad) at the propeller.
    pub fn advance_m_s(&self, u: f64, drift_rad: f64) -> f64 {
        let wake = self.wake * (-self.wake_by_drift * drift_rad.powi(2)).exp();
        (1.0 - wake) * u
    }

    /// Thrust, N.
    pub fn thrust_n(&self, density: f64, advance_m_s: f64, n_rps: f64) -> f64 {
        if n_rps <= 0.0 {
            return 0.0;
        }
        let j = advance_m_s / (n_rps * self.diameter_m);
        let [k0, k1, k2] = self.thrust;
        density * n_rps.powi(2) * self.diameter_m.powi(4) * (k0 + k1 * j + k2 * j * j)
    }

    /// Speed far behind the disc, m/s, by momentum theory; that of advance where there is no
    /// thrust.
    pub fn slipstream_m_s(&self, density: f64, advance_m_s: f64, thrust_n: f64) -> f64 {
        let disc = 0.25 * std::f64::consts::PI * self.diameter_m.powi(2);
        let square = advance_m_s * advance_m_s.abs() + 2.0 * thrust_n.max(0.0) / (density * disc);
        square.max(0.0).sqrt()
    }

    /// Revolutions, 1/s, at which the thrust of `count` propellers balances a resistance.
    ///
    /// # Panics
    /// Fifty revolutions a second are not enough.
    pub fn revolutions_for(&self, density: f64, u: f64, resistance_n: f64, count: f64) -> f64 {
        let advance = self.advance_m_s(u, 0.0);
        let net = |n: f64| {
            count * (1.0 - self.deduction) * self.thrust_n(density, advance, n) - resistance_n
        };
        let (mut low, mut high) = (0.0, 50.0);
        assert!(net(high) > 0.0, "no revolutions drive the ship at {u} m/s");
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if net(middle) < 0.0 { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    }
}
