//! Wind, current and the mean drift of waves, in forms that the zoo does not have.

use super::hull::Hull;

/// Density of air, kg/m3, and of sea water.
const AIR: f64 = 1.225;
const WATER: f64 = 1025.0;
const GRAVITY: f64 = 9.80665;
/// Areas above water, m2, and length over all, m, chosen for a research vessel of 36 m over all
/// with a high forecastle.
const FRONTAL_M2: f64 = 70.0;
const LATERAL_M2: f64 = 180.0;
const OVER_ALL_M: f64 = 36.25;
/// Coefficients of Kanazawa 2023, Eq. 2.11, as Fossen 2011 has them for a ship abeam and ahead:
/// -c_x cos, c_y sin, c_n sin of twice the angle; chosen within his ranges (0.5 to 0.9, 0.7 to
/// 0.95, 0.05 to 0.2).
const WIND: [f64; 3] = [0.7, 0.8, 0.12];
/// Share of the waves' energy that is turned back abeam and ahead, chosen.
const TURNED_BACK: [f64; 2] = [0.3, 0.5];

/// What is between calm and a moderate breeze, all of one direction (sec. 3.1.2).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weather {
    /// Significant height, m, and period of the peak, s.
    pub height_m: f64,
    pub period_s: f64,
    pub wind_m_s: f64,
    pub current_m_s: f64,
    /// Where wind, waves and current go, rad.
    pub towards_rad: f64,
}

impl Weather {
    pub const CALM: Self =
        Self { height_m: 0.0, period_s: 5.0, wind_m_s: 0.0, current_m_s: 0.0, towards_rad: 0.0 };

    /// Beaufort 3 or 4: wind and waves of the Met Office's table (mean wind, probable height),
    /// periods of one steepness, that of the waves of 1 m and 5 s of sec. 4.1.2, currents chosen.
    pub fn beaufort(force: u8, towards_rad: f64) -> Self {
        let (height_m, wind_m_s, current_m_s): (f64, f64, f64) =
            if force == 3 { (0.6, 5.0, 0.2) } else { (1.0, 7.0, 0.4) };
        Self { height_m, period_s: 5.0 * height_m.sqrt(), wind_m_s, current_m_s, towards_rad }
    }

    /// The same by Froude's law for a hull of another size.
    pub fn of_size(self, hull: &Hull) -> Self {
        let (length, speed) = (hull.scale(), hull.scale().sqrt());
        Self {
            height_m: length * self.height_m,
            period_s: speed * self.period_s,
            wind_m_s: speed * self.wind_m_s,
            current_m_s: speed * self.current_m_s,
            ..self
        }
    }

    /// Accelerations of a hull in it.
    pub fn accelerations(
        &self,
        hull: &Hull,
        psi_rad: f64,
        [u, v, r]: [f64; 3],
        n_rps: f64,
        delta_rad: f64,
    ) -> [f64; 3] {
        let (sin, cos) = (self.towards_rad - psi_rad).sin_cos();
        let [u_c, v_c] = [self.current_m_s * cos, self.current_m_s * sin];
        let still = hull.accelerations([u - u_c, v - v_c, r], n_rps, delta_rad);
        let wind = wind(hull, [u - self.wind_m_s * cos, v - self.wind_m_s * sin]);
        let waves = self.drift(hull, sin, cos);
        let pushed = hull.mass.answers(std::array::from_fn(|axis| wind[axis] + waves[axis]));
        // A steady current turns in the ship's axes.
        let turning = [r * v_c, -r * u_c, 0.0];
        std::array::from_fn(|axis| still[axis] + turning[axis] + pushed[axis])
    }

    /// The momentum of waves that are turned back: by half rho g a^2, of mean square Hs^2/8.
    fn drift(&self, hull: &Hull, sin: f64, cos: f64) -> [f64; 3] {
        let push = 0.5 * WATER * GRAVITY * self.height_m.powi(2) / 8.0;
        let ahead = TURNED_BACK[0] * push * hull.beam_m * cos * cos.abs();
        let aside = TURNED_BACK[1] * push * hull.lpp_m * sin * sin.abs();
        [ahead, aside, 0.0]
    }
}

/// Forces of a relative wind, N and N m.
fn wind(hull: &Hull, [u, v]: [f64; 2]) -> [f64; 3] {
    let pressure = 0.5 * AIR * (u * u + v * v);
    let (sin, cos) = (-(v.atan2(u))).sin_cos();
    let ([x, y, n], scale) = (WIND, hull.scale());
    let (frontal, lateral) = (scale * scale * FRONTAL_M2, scale * scale * LATERAL_M2);
    [
        -x * cos * pressure * frontal,
        y * sin * pressure * lateral,
        n * 2.0 * sin * cos * pressure * lateral * scale * OVER_ALL_M,
    ]
}
