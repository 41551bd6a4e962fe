//! Thrust of a propeller series in open water.

use serde::Deserialize;
use sistership_model::FileError;
use sistership_model::source::Source;

/// A series in the form of its file: `K_T = sum c J^s (P/D)^t (A_E/A_0)^u Z^v`.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PropellerSeries {
    #[serde(rename = "kind")]
    _kind: SeriesKind,
    /// Name of the series.
    pub name: String,
    #[serde(rename = "title")]
    _title: String,
    /// Publication.
    pub source: Source,
    #[serde(rename = "note")]
    _note: String,
    /// Default number of blades.
    blades: f64,
    /// Expanded area ratio, which particulars do not have.
    area_ratio: f64,
    terms: Vec<[f64; 5]>,
}

#[derive(Debug, Clone, Copy, Deserialize)]
enum SeriesKind {
    #[serde(rename = "propeller-series")]
    Series,
}

/// Parabola of thrust: `K_T = k_0 + k_1 J + k_2 J^2`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ThrustParabola {
    /// Thrust coefficient at `J = 0`.
    pub k_0: f64,
    /// Slope.
    pub k_1: f64,
    /// Curvature.
    pub k_2: f64,
}

/// Number of points of the curve to which the parabola is fitted.
const POINTS: usize = 24;

impl PropellerSeries {
    /// Parses a file.
    ///
    /// # Errors
    /// Returns an error that describes what is wrong in the file.
    pub fn parse(file: &str, text: &str) -> Result<Self, FileError> {
        sistership_model::yaml::read_document(text).map_err(|error| FileError {
            file: file.to_owned(),
            line: None,
            field: String::new(),
            message: error.to_string(),
            further: Vec::new(),
        })
    }

    /// Thrust coefficient at an advance ratio.
    pub fn k_t(&self, advance: f64, pitch_ratio: f64, blades: f64) -> f64 {
        let term = |[c, s, t, u, v]: &[f64; 5]| {
            c * advance.powf(*s) * pitch_ratio.powf(*t) * self.area_ratio.powf(*u) * blades.powf(*v)
        };
        self.terms.iter().map(term).sum()
    }

    /// Fits a parabola to the curve from `J = 0` to the advance ratio at which the thrust ends.
    pub fn fit_thrust(&self, pitch_ratio: f64, blades: Option<f64>) -> ThrustParabola {
        let blades = blades.unwrap_or(self.blades);
        // Advance ratio at which the thrust ends, in steps of 0.02.
        let mut advance = 0.0;
        while self.k_t(advance, pitch_ratio, blades) > 0.0 && advance < 2.0 {
            advance += 0.02;
        }
        let points: Vec<(f64, f64)> = (0..=POINTS)
            .map(|k| advance * k as f64 / POINTS as f64)
            .map(|j| (j, self.k_t(j, pitch_ratio, blades)))
            .collect();
        fit_parabola(&points)
    }
}

/// Least-squares fit of a parabola, by the normal equations.
fn fit_parabola(points: &[(f64, f64)]) -> ThrustParabola {
    let mut normal = nalgebra::Matrix3::<f64>::zeros();
    let mut right = nalgebra::Vector3::<f64>::zeros();
    for &(x, y) in points {
        let row = nalgebra::Vector3::new(1.0, x, x * x);
        normal += row * row.transpose();
        right += row * y;
    }
    let solved = normal.lu().solve(&right).unwrap_or_default();
    ThrustParabola { k_0: solved[0], k_1: solved[1], k_2: solved[2] }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use crate::estimates::library::RegressionLibrary;

    /// The propeller of KVLCC2 (pitch ratio 0.721, four blades, area ratio 0.431) has
    /// 0.293 - 0.275 J - 0.139 J^2 in Yasukawa and Yoshimura 2015, of another series.
    #[test]
    fn the_series_gives_the_thrust_of_a_like_propeller() {
        let thrust =
            RegressionLibrary::parse_embedded().unwrap().series.fit_thrust(0.721, Some(4.0));
        let at = |j: f64| thrust.k_0 + thrust.k_1 * j + thrust.k_2 * j * j;
        let kvlcc2 = |j: f64| 0.2931 - 0.2753 * j - 0.1385 * j * j;
        for j in [0.0, 0.2, 0.4, 0.6] {
            assert!((at(j) - kvlcc2(j)).abs() < 0.03, "{j}: {} {}", at(j), kvlcc2(j));
        }
    }
}
