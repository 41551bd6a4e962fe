//! Relation of rudder and yaw rate: which column is the rudder, and the sign of it.
//!
//! Two indications are combined: the correlation with the yaw rate some moments later, and the
//! partial correlation with the yaw acceleration in Nomoto's first-order model, dr/dt = a r + b
//! delta + c.

use crate::relation::{ColumnRelation, RelationInput};
use crate::role::Role;
use crate::signals::RecordingSignals;

/// Lags of the yaw rate behind the rudder, as fractions of the recording.
const LAGS: [f64; 5] = [0.0, 0.0025, 0.005, 0.01, 0.02];
/// Log odds for each unit of the sum of both correlations.
const PER_UNIT: f64 = 6.0;

/// Lagged and partial correlation of yaw rate and rudder, for the assumed sign of the rudder.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct SteeringEvidence {
    pub lagged: f64,
    pub partial: f64,
}

impl SteeringEvidence {
    pub(crate) fn new(
        signals: &RecordingSignals,
        r: usize,
        delta: usize,
        is_reversed: bool,
    ) -> Self {
        let sign = if is_reversed { -1.0 } else { 1.0 };
        let lagged = lagged_correlation(&signals.continuous[delta], &signals.continuous[r]);
        // Nomoto's model integrated over blocks: change of r = a (integral of r) + b (integral of
        // delta) + c (duration), which needs no derivative of a noisy yaw rate.
        let partials = signals.scales.iter().map(|scale| {
            let (yaw, rudder) = (&scale.columns[r], &scale.columns[delta]);
            partial_correlation(&yaw.change, [&yaw.integral, &rudder.integral, &scale.duration])
        });
        let partial = partials.max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(0.0);
        Self { lagged: sign * lagged, partial: sign * partial }
    }

    pub(crate) fn to_relation(self, rudder: Role, observed: RelationInput<'_>) -> ColumnRelation {
        let odds = (PER_UNIT * (self.lagged + self.partial)).clamp(-10.0, 12.0);
        let lagged = self.lagged;
        let figure =
            observed.format_figure(|| format!("correlation of the yaw rate with it {lagged:.2}"));
        ColumnRelation { roles: [rudder, Role::R, Role::Other], odds, figure }
    }
}

pub(crate) fn lagged_correlation(delta: &[f64], r: &[f64]) -> f64 {
    let n = delta.len();
    let at = |part: &f64| {
        let lag = (part * n as f64) as usize;
        pearson_correlation(&delta[..n - lag], &r[lag..])
    };
    LAGS.iter().map(at).max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(0.0)
}

/// Returns Pearson's correlation; zero if one side is constant.
pub(crate) fn pearson_correlation(a: &[f64], b: &[f64]) -> f64 {
    let n = a.len().max(1) as f64;
    let (ma, mb) = (a.iter().sum::<f64>() / n, b.iter().sum::<f64>() / n);
    let (mut aa, mut ab, mut bb) = (0.0, 0.0, 0.0);
    for (a, b) in a.iter().zip(b) {
        aa += (a - ma).powi(2);
        ab += (a - ma) * (b - mb);
        bb += (b - mb).powi(2);
    }
    if aa > 0.0 && bb > 0.0 { ab / (aa * bb).sqrt() } else { 0.0 }
}

/// Returns the partial correlation of the second regressor with a response: its coefficient divided
/// by its standard error, scaled to -1 to 1.
pub(crate) fn partial_correlation(response: &[f64], regressors: [&Vec<f64>; 3]) -> f64 {
    let rows = response.len();
    if rows < 15 {
        return 0.0;
    }
    // The first and the third regressor are projected out of the response and of the second.
    let rest = |values: &[f64]| regression_residual(values, regressors[0], regressors[2]);
    let (Some(y), Some(d)) = (rest(response), rest(regressors[1])) else { return 0.0 };
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let (yy, yd, dd) = (dot(&y, &y), dot(&y, &d), dot(&d, &d));
    if yy > 0.0 && dd > 0.0 { yd / (yy * dd).sqrt() } else { 0.0 }
}

/// Residual of a regression on two series, by the normal equations; `None` if they are collinear.
fn regression_residual(values: &[f64], one: &[f64], other: &[f64]) -> Option<Vec<f64>> {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let (aa, ab, bb) = (dot(one, one), dot(one, other), dot(other, other));
    let (va, vb) = (dot(values, one), dot(values, other));
    let determinant = aa * bb - ab * ab;
    if determinant <= 1e-12 * aa * bb {
        return None;
    }
    let (p, q) = ((bb * va - ab * vb) / determinant, (aa * vb - ab * va) / determinant);
    let left = values.iter().zip(one.iter().zip(other));
    Some(left.map(|(value, (a, b))| value - p * a - q * b).collect())
}
