//! Revolutions at which thrust and resistance are in equilibrium.

use crate::estimates::propeller::ThrustParabola;

/// A ship on a straight course.
#[derive(Debug, Clone, Copy)]
pub struct StraightCourse {
    /// Length, m.
    pub lpp_m: f64,
    /// Draught, m.
    pub draught_m: f64,
    /// Speed, m/s.
    pub speed_m_s: f64,
    /// Resistance by `0.5 rho L d U^2`, below zero.
    pub x_0: f64,
    /// Thrust deduction.
    pub t_p: f64,
    /// Wake fraction.
    pub w_p0: f64,
    /// Propeller diameter, m.
    pub diameter_m: f64,
    /// Its thrust.
    pub thrust: ThrustParabola,
}

impl StraightCourse {
    /// Returns the revolutions, 1/s; none where the propeller cannot give the thrust.
    ///
    /// `(1 - t) rho n^2 D^4 K_T(J) = R` with `n = u_P/(J D)` is `K_T(J) = c J^2`.
    pub fn revolutions_rps(&self) -> Option<f64> {
        // The density cancels: thrust and resistance are both proportional to it.
        let resistance = -0.5 * self.x_0 * self.lpp_m * self.draught_m * self.speed_m_s.powi(2);
        let inflow = (1.0 - self.w_p0) * self.speed_m_s;
        let c = resistance / ((1.0 - self.t_p) * (inflow * self.diameter_m).powi(2));
        let ThrustParabola { k_0, k_1, k_2 } = self.thrust;
        let advance = positive_root(k_2 - c, k_1, k_0)?;
        Some(inflow / (advance * self.diameter_m))
    }
}

/// Smallest positive root of `a x^2 + b x + c`.
fn positive_root(a: f64, b: f64, c: f64) -> Option<f64> {
    let root = (b * b - 4.0 * a * c).sqrt();
    let roots = [(-b - root) / (2.0 * a), (-b + root) / (2.0 * a)];
    roots.into_iter().filter(|x| *x > 1e-6).min_by(f64::total_cmp)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn kvlcc2_runs_at_its_own_revolutions() {
        let kvlcc2 = StraightCourse {
            lpp_m: 320.0,
            draught_m: 20.8,
            speed_m_s: 7.974,
            x_0: -0.0162,
            t_p: 0.22,
            w_p0: 0.4,
            diameter_m: 9.86,
            thrust: ThrustParabola { k_0: 0.2931, k_1: -0.2753, k_2: -0.1385 },
        };
        assert!((kvlcc2.revolutions_rps().unwrap() - 1.547).abs() < 0.005);
        let weak = StraightCourse {
            diameter_m: 9.86,
            thrust: ThrustParabola { k_0: -0.1, k_1: -0.3, k_2: 0.0 },
            ..kvlcc2
        };
        assert_eq!(weak.revolutions_rps(), None);
    }
}
