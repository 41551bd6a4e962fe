//! Comparison of one quantity with data: ITTC 7.5-02-06-03, by the comparison of ITTC 7.5-03-01-01,
//! sec. 3 (Coleman and Stern 1997, J Fluids Eng 119, 795-803; Stern and others 2001, J Fluids Eng
//! 123, 793-802).

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// Data, simulation and uncertainties of a quantity before its verdict. Uncertainties are half the
/// width of intervals of 95 %, in the unit of the quantity.
#[derive(Debug, Clone, PartialEq)]
pub struct QuantityEvidence {
    /// The quantity: `turn 35 deg: advance`.
    pub quantity: String,
    /// Its unit: `L`, `m`, `deg`, `s`.
    pub unit: &'static str,
    /// Source of the data: the key of a citation, or the names of trials.
    pub data_from: String,
    /// Number of records of the data; none if a source does not state it.
    pub records: Option<usize>,
    /// The data, D.
    pub data: f64,
    /// Simulation, S; none if it does not reach the quantity.
    pub simulated: Option<f64>,
    /// Uncertainty of the data, U_D; none if it is not known.
    pub data_uncertainty: Option<f64>,
    /// Uncertainty due to the step of the simulation, U_SN; none if figures diverge.
    pub step_uncertainty: Option<f64>,
    /// Uncertainty due to the input of the simulation, U_input: that of the model's own posterior;
    /// none for a model without one.
    pub input_uncertainty: Option<f64>,
}

/// A quantity with its verdict.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct ValidatedQuantity {
    /// The quantity: `turn 35 deg: advance`.
    pub quantity: String,
    /// Its unit.
    pub unit: String,
    /// Source of the data: the key of a citation, or the names of trials.
    pub data_from: String,
    /// Number of records of the data; null if a source does not state it.
    pub records: Option<usize>,
    /// The data, D.
    pub data: f64,
    /// The simulation, S; null if it does not reach the quantity.
    pub simulated: Option<f64>,
    /// The comparison error, E = D - S.
    pub comparison_error: Option<f64>,
    /// Uncertainty of the data, U_D, 95 %.
    pub data_uncertainty: Option<f64>,
    /// Uncertainty of the simulation's step, U_SN.
    pub step_uncertainty: Option<f64>,
    /// Uncertainty of the simulation's input, U_input; null for a model without a posterior.
    pub input_uncertainty: Option<f64>,
    /// The validation uncertainty, U_V^2 = U_D^2 + U_SN^2 + U_input^2; unknown parts count as zero,
    /// so that it is then a lower bound.
    pub validation_uncertainty: Option<f64>,
    /// E relative to D, %.
    pub comparison_error_percent: Option<f64>,
    /// U_V relative to D, %.
    pub validation_uncertainty_percent: Option<f64>,
    /// Verdict.
    pub verdict: Verdict,
}

/// Verdict of a comparison.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// |E| < U_V: validated at the level U_V; the model's own error is below the noise.
    Validated,
    /// |E| >= U_V, all parts of U_V known: E is an error of the model by sign and size.
    NotValidated,
    /// |E| is above the known part of U_V, which has unknown parts.
    AboveWhatIsKnown,
    /// The uncertainty of the data is not known, or the simulation does not reach the quantity.
    Undecided,
}

impl Verdict {
    /// Returns the verdict in words.
    pub fn as_words(self) -> &'static str {
        match self {
            Self::Validated => "validated at U_V",
            Self::NotValidated => "not validated: an error of the model",
            Self::AboveWhatIsKnown => "undecided: above the known parts of U_V",
            Self::Undecided => "undecided",
        }
    }
}

impl From<QuantityEvidence> for ValidatedQuantity {
    fn from(of: QuantityEvidence) -> Self {
        let error = of.simulated.map(|simulated| of.data - simulated);
        let parts = [of.data_uncertainty, of.step_uncertainty, of.input_uncertainty];
        let squares: f64 = parts.iter().flatten().map(|part| part * part).sum();
        // Without the data's own uncertainty there is no verdict.
        let uncertainty = of.data_uncertainty.map(|_| squares.sqrt());
        let verdict = match error.zip(uncertainty) {
            None => Verdict::Undecided,
            Some((error, uncertainty)) if error.abs() < uncertainty => Verdict::Validated,
            Some(_) if parts.iter().all(Option::is_some) => Verdict::NotValidated,
            Some(_) => Verdict::AboveWhatIsKnown,
        };
        let percent = |value: f64| 100.0 * value / of.data.abs();
        // Data of zero have no relative error.
        let percent = |value: Option<f64>| value.filter(|_| of.data != 0.0).map(percent);
        Self {
            quantity: of.quantity,
            unit: of.unit.to_owned(),
            data_from: of.data_from,
            records: of.records,
            data: of.data,
            simulated: of.simulated,
            comparison_error: error,
            data_uncertainty: of.data_uncertainty,
            step_uncertainty: of.step_uncertainty,
            input_uncertainty: of.input_uncertainty,
            validation_uncertainty: uncertainty,
            comparison_error_percent: percent(error),
            validation_uncertainty_percent: percent(uncertainty),
            verdict,
        }
    }
}

/// Returns half the width of the 95 % interval of a mean, from repeated values: t s/sqrt(n). `None`
/// for fewer than two values.
pub fn mean_uncertainty(values: &[f64]) -> Option<f64> {
    let n = values.len() as f64;
    let (_, spread) = mean_and_spread(values)?;
    Some(student_t(values.len() - 1) * spread / n.sqrt())
}

/// Returns mean and standard deviation (n - 1); `None` for fewer than two values.
pub fn mean_and_spread(values: &[f64]) -> Option<(f64, f64)> {
    if values.len() < 2 {
        return None;
    }
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    Some((mean, (squares / (n - 1.0)).sqrt()))
}

/// The quantile of 97.5 % of Student's t by degrees of freedom (Abramowitz and Stegun 1964, table
/// 26.10); beyond the table by Fisher's expansion about the normal distribution (26.7.5, first
/// three terms).
fn student_t(freedom: usize) -> f64 {
    const TABLE: [f64; 10] =
        [12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228];
    let normal = NORMAL_95;
    match TABLE.get(freedom.saturating_sub(1)) {
        Some(t) => *t,
        None => {
            let v = freedom as f64;
            let (x3, x5, x7) = (normal.powi(3), normal.powi(5), normal.powi(7));
            normal
                + (x3 + normal) / (4.0 * v)
                + (5.0 * x5 + 16.0 * x3 + 3.0 * normal) / (96.0 * v * v)
                + (3.0 * x7 + 19.0 * x5 + 17.0 * x3 - 15.0 * normal) / (384.0 * v.powi(3))
        }
    }
}

/// The quantile of 97.5 % of the normal distribution.
pub const NORMAL_95: f64 = 1.959_964;

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// By hand: a tactical diameter of 3.25 L measured within 0.10 L (95 %), 3.05 L simulated, the
    /// step within 0.02 L, the posterior within 0.09 L. E = 0.20, U_V^2 = 0.0100 + 0.0004 + 0.0081
    /// =
    /// 0.0185, U_V = 0.13601; in % of D: 6.154 and 4.185. |E| > U_V.
    fn by_hand() -> QuantityEvidence {
        QuantityEvidence {
            quantity: "turn 35 deg: tactical diameter".into(),
            unit: "L",
            data_from: "by hand".into(),
            records: None,
            data: 3.25,
            simulated: Some(3.05),
            data_uncertainty: Some(0.10),
            step_uncertainty: Some(0.02),
            input_uncertainty: Some(0.09),
        }
    }

    fn close(value: Option<f64>, expected: f64) -> bool {
        (value.unwrap() - expected).abs() < 1e-5 * expected.abs().max(1.0)
    }

    #[test]
    fn the_figures_are_those_calculated_by_hand() {
        let judged = ValidatedQuantity::from(by_hand());
        assert!(close(judged.comparison_error, 0.20), "{judged:?}");
        assert!(close(judged.validation_uncertainty, 0.136_014_7));
        assert!(close(judged.comparison_error_percent, 6.153_846));
        assert!(close(judged.validation_uncertainty_percent, 4.185_068));
        assert_eq!(judged.verdict, Verdict::NotValidated);
        let nearer =
            ValidatedQuantity::from(QuantityEvidence { simulated: Some(3.38), ..by_hand() });
        assert!(close(nearer.comparison_error, -0.13));
        assert_eq!(nearer.verdict, Verdict::Validated);
    }

    #[test]
    fn what_is_not_known_is_not_claimed() {
        let bare = QuantityEvidence { input_uncertainty: None, ..by_hand() };
        assert_eq!(ValidatedQuantity::from(bare.clone()).verdict, Verdict::AboveWhatIsKnown);
        let near =
            ValidatedQuantity::from(QuantityEvidence { simulated: Some(3.20), ..bare.clone() });
        assert_eq!(near.verdict, Verdict::Validated);
        let alone =
            ValidatedQuantity::from(QuantityEvidence { data_uncertainty: None, ..bare.clone() });
        assert_eq!((alone.verdict, alone.validation_uncertainty), (Verdict::Undecided, None));
        let unsailed = ValidatedQuantity::from(QuantityEvidence { simulated: None, ..bare });
        assert_eq!((unsailed.verdict, unsailed.comparison_error), (Verdict::Undecided, None));
    }

    /// Three first overshoots of 8.1, 8.7 and 8.4 deg: mean 8.4, s = 0.3, t = 4.303, U =
    /// 4.303 * 0.3 / sqrt(3) = 0.74530.
    #[test]
    fn repeats_tell_the_uncertainty_of_their_mean() {
        assert!(close(mean_uncertainty(&[8.1, 8.7, 8.4]), 0.745_301_4));
        assert_eq!(mean_uncertainty(&[8.1]), None);
        // Abramowitz and Stegun: 2.042 at 30 degrees of freedom, 2.201 at 11.
        assert!((student_t(30) - 2.042).abs() < 1e-3 && (student_t(11) - 2.201).abs() < 1e-3);
    }
}
