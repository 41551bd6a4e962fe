//! Ranges of estimates and draws, beyond which the formulas of the law are invalid.

/// Smallest and largest value of a parameter.
const RANGES: [(&str, f64, f64); 14] = [
    ("m_x", 1e-4, 0.2),
    ("m_y", 0.02, 0.8),
    ("J_z", 1e-3, 0.05),
    ("t_P", 0.0, 0.4),
    ("w_P0", 0.0, 0.6),
    ("C_1", 0.5, 4.0),
    ("C_2", 1.0, 2.0),
    ("t_R", 0.0, 0.7),
    ("a_H", 0.0, 0.8),
    ("x_H", -0.75, -0.3),
    ("gamma_R", 0.1, 0.9),
    ("l_R", -1.3, -0.5),
    ("epsilon", 0.7, 1.4),
    ("kappa", 0.3, 0.8),
];

/// Least share of its estimate that a damping coefficient keeps, as it is negative for physical
/// reasons.
const DAMPING_SHARE: f64 = 0.3;
const DAMPING: [&str; 5] = ["X_0", "Y_v", "N_r", "Y_vvv", "N_rrr"];

/// Limits a parameter to its range.
pub fn clamp_parameter(name: &str, value: f64) -> f64 {
    match RANGES.iter().find(|(known, ..)| *known == name) {
        Some(&(_, low, high)) => value.clamp(low, high),
        None => value,
    }
}

/// Limits a drawn coefficient, given its estimate.
pub fn limit_coefficient(name: &str, drawn: f64, estimate: f64) -> f64 {
    if DAMPING.contains(&name) && estimate < 0.0 {
        return drawn.min(DAMPING_SHARE * estimate);
    }
    drawn
}
