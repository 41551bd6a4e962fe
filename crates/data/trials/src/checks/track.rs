//! Check of the positions against the ship-fixed velocities, rotated by the heading.

use sistership_model::manifest::VelocityFrame;
use sistership_model::trial::Channel;

use crate::findings::Findings;
use crate::recording::Recording;
use crate::stats::{SampleBlock, fit_proportion, sample_blocks, value_range};

/// rad; with less turning of the heading, axes cannot be distinguished.
const TURNED: f64 = 0.5;
/// A different set of axes must leave less than this fraction of the squares that the declared axes
/// leave, and of all squares.
const MUCH_BETTER: f64 = 0.1;
/// Fraction of the mean speed from which a steady or an unsteady disagreement is reported.
const STEADY: f64 = 0.05;
const UNSTEADY: f64 = 0.25;

/// A block's displacement north and east, m.
type TrackStep = (f64, f64);

/// Alternative axes: velocity north and east from u, v, cos psi and sin psi.
type AxisMapping = fn(f64, f64, f64, f64) -> TrackStep;

// Rotation from ship-fixed to earth-fixed axes.
const DECLARED: AxisMapping = |u, v, c, s| (u * c - v * s, u * s + v * c);

const MISTAKES: [(AxisMapping, &str); 4] = [
    (
        |u, v, _, _| (u, v),
        "u and v are velocities north and east instead of ahead and to starboard; map them as \
         `v_north` and `v_east`",
    ),
    (
        |u, v, c, s| (u * s + v * c, u * c - v * s),
        "x and y are exchanged: x is north and y is east; exchange the columns",
    ),
    (
        |u, v, c, s| (u * c - v * s, -u * s - v * c),
        "y is positive to the west, or the heading is anticlockwise: y must be positive to the \
         east and the heading clockwise; change the sign",
    ),
    (
        |u, v, c, s| (u * c + v * s, u * s - v * c),
        "v is positive to port, but must be positive to starboard; change its sign",
    ),
];

/// Ratio of measured to predicted track, and the wrong unit that explains it.
const SCALES: [(f64, &str); 5] = [
    (1852.0 / 3600.0, "knots; declare `kn`"),
    (3600.0 / 1852.0, "m/s; declare `m/s`"),
    (1.0 / 3.6, "km/h; declare `km/h`"),
    (3.6, "m/s; declare `m/s`"),
    (1e-3, "right and time is in milliseconds; declare `ms` for t"),
];

pub(crate) fn check_track(recording: &Recording, findings: &mut Findings) {
    let Some(track) = TrackCheck::from_recording(recording) else { return };
    // With little turning, different axes explain the track equally well.
    let message = if value_range(track.psi) < TURNED {
        None
    } else {
        track.axis_mistake().or_else(|| track.scale_mistake())
    };
    match message {
        Some(message) => findings.error(None, Some(recording.column_header(Channel::U)), message),
        None if recording.trial.velocity == VelocityFrame::Ground => {
            track.report_disagreement(findings)
        }
        None => {}
    }
}

struct TrackCheck<'a> {
    recording: &'a Recording,
    blocks: Vec<SampleBlock>,
    measured: Vec<TrackStep>,
    psi: &'a [f64],
    u: &'a [f64],
    v: &'a [f64],
}

/// Residual of the track: a steady drift, m/s, and the sum of squares of the rest, m2.
struct TrackResidual {
    drift: TrackStep,
    squares: f64,
}

impl<'a> TrackCheck<'a> {
    fn from_recording(recording: &'a Recording) -> Option<Self> {
        let (x, y) = (recording.channel(Channel::X)?, recording.channel(Channel::Y)?);
        let (u, v) = (recording.channel(Channel::U)?, recording.channel(Channel::V)?);
        let psi = recording.channel(Channel::Psi)?;
        let blocks = sample_blocks(recording);
        let measured: Vec<TrackStep> =
            blocks.iter().map(|block| (block.total_change(x), block.total_change(y))).collect();
        (blocks.len() >= 10).then_some(Self { recording, blocks, measured, psi, u, v })
    }

    fn predict_steps(&self, axes: AxisMapping) -> Vec<TrackStep> {
        let t = self.recording.time();
        let velocity = |k: usize| axes(self.u[k], self.v[k], self.psi[k].cos(), self.psi[k].sin());
        self.blocks
            .iter()
            .map(|block| {
                (
                    block.time_integral(t, |k| velocity(k).0),
                    block.time_integral(t, |k| velocity(k).1),
                )
            })
            .collect()
    }

    /// Returns the residual of the measured track. A steady drift is subtracted first: it is a
    /// current, and does not indicate wrong axes.
    fn track_residual(&self, predicted: &[TrackStep]) -> TrackResidual {
        let left: Vec<TrackStep> =
            self.measured.iter().zip(predicted).map(|(a, b)| (a.0 - b.0, a.1 - b.1)).collect();
        // The steady drift is the mean residual velocity; blocks have about equal durations.
        let seconds = self.total_seconds();
        let sum = left.iter().fold((0.0, 0.0), |sum, step| (sum.0 + step.0, sum.1 + step.1));
        let drift = (sum.0 / seconds, sum.1 / seconds);
        let each = seconds / left.len() as f64;
        let squares = left
            .iter()
            .map(|step| (step.0 - drift.0 * each).powi(2) + (step.1 - drift.1 * each).powi(2))
            .sum();
        TrackResidual { drift, squares }
    }

    fn total_seconds(&self) -> f64 {
        let t = self.recording.time();
        self.blocks.iter().map(|block| block.total_change(t)).sum()
    }

    fn axis_mistake(&self) -> Option<String> {
        let declared = self.track_residual(&self.predict_steps(DECLARED)).squares;
        // Residual of a prediction of no motion: the squares of the track itself.
        let whole = self.track_residual(&vec![(0.0, 0.0); self.blocks.len()]).squares;
        let left = MISTAKES.iter().map(|&(axes, message)| {
            (self.track_residual(&self.predict_steps(axes)).squares, message)
        });
        let (best, message) = left.min_by(|a, b| a.0.total_cmp(&b.0))?;
        (best < MUCH_BETTER * declared && best < MUCH_BETTER * whole)
            .then(|| format!("according to the track, {message}"))
    }

    fn scale_mistake(&self) -> Option<String> {
        let predicted = self.predict_steps(DECLARED);
        let pairs: Vec<(f64, f64)> = predicted
            .iter()
            .zip(&self.measured)
            .flat_map(|(a, b)| [(a.0, b.0), (a.1, b.1)])
            .collect();
        // Both axes together. The high correlation ensures that only the scale is wrong.
        let found = fit_proportion(&pairs).filter(|found| found.correlation > 0.98)?;
        let unit = SCALES.iter().find(|(factor, _)| (found.slope / factor - 1.0).abs() < 0.03)?.1;
        Some(format!(
            "the speed of the positions is {:.4} times that of u and v; the velocities are \
             probably {unit}",
            found.slope
        ))
    }

    fn report_disagreement(&self, findings: &mut Findings) {
        let predicted = self.predict_steps(DECLARED);
        let rest = self.track_residual(&predicted);
        let (n, seconds) = (self.blocks.len() as f64, self.total_seconds());
        let speed = predicted.iter().map(|step| step.0.hypot(step.1)).sum::<f64>() / seconds;
        // Root mean square of the residual of a block, divided by the mean duration of a block,
        // m/s.
        let scatter = (rest.squares / n).sqrt() * n / seconds;
        let drift = rest.drift.0.hypot(rest.drift.1);
        let header = self.recording.column_header(Channel::X);
        // Also significant: more than four standard errors of the mean.
        if drift > STEADY * speed && drift > 4.0 * scatter / n.sqrt() {
            let towards =
                rest.drift.1.atan2(rest.drift.0).to_degrees().rem_euclid(360.0).round() % 360.0;
            let message = format!(
                "the positions drift by {drift:.3} m/s towards {towards:.0} deg relative to u and \
                 v: if these are from a log through the water, map them as `u_water` and \
                 `v_water` and declare `derive: [u, v]`; otherwise check the speed sensors"
            );
            findings.warning(None, Some(header), message);
        }
        if scatter > UNSTEADY * speed {
            let message = format!(
                "positions and velocities differ by {scatter:.3} m/s (mean speed {speed:.3} m/s); \
                 check reference points and sensors"
            );
            findings.warning(None, Some(header), message);
        }
    }
}

#[cfg(test)]
#[path = "track_tests.rs"]
mod tests;
