//! Domain of a learned correction: full share within the range of its training, and a smooth fade
//! to zero outside it.
//!
//! The fade bounds the correction. Let D be the region in which its share is above zero. Outside D
//! the foundation acts alone, so a simulation with a correction can leave the physical range only
//! where one of the foundation alone, started from some motion in D, would leave it; and D lies in
//! the physical range ([`FadedDomain::is_within`]). The addition within D is bounded by the range
//! of the training targets. Decision 20 has the argument in full.

use sistership_formula::{Comparison, Expr, Function};
use sistership_model::validity::{HalfSpace, Region};
use sistership_simulation::MotionEnvelope;
use sistership_simulation::branch::CorrectionInstant;

use crate::expressions::{added, divided, subtracted};

/// Channels of a region, in the order of their values in an instant.
const CHANNELS: [&str; 5] = ["u", "v", "r", "delta", "n"];

/// Region with the distance outside it over which a correction fades to zero.
#[derive(Debug, Clone, PartialEq)]
pub struct FadedDomain {
    faces: Vec<DirectionBounds>,
    fade: f64,
    /// Largest |u|, |v|, |r| with a share above zero.
    reach: [f64; 3],
}

/// Bounds in one direction: two channels by index, each with its factor and the centre that is
/// subtracted before.
#[derive(Debug, Clone, Copy, PartialEq)]
struct DirectionBounds {
    terms: [(usize, f64, f64); 2],
    bounds: [f64; 2],
}

impl FadedDomain {
    /// Creates a domain from a region that bounds u, v and r. Returns `None` if one of these is not
    /// bounded, or if another channel is.
    pub fn from_region(region: &Region, fade: f64) -> Option<Self> {
        let faces =
            region.half_spaces().iter().map(direction_bounds).collect::<Option<Vec<_>>>()?;
        let reach = |place: usize| {
            // Only faces along a single channel bound that channel by itself.
            let alone =
                |face: &&DirectionBounds| face.terms[0].0 == place && face.terms[1].1 == 0.0;
            let (_, factor, centre) = faces.iter().find(alone)?.terms[0];
            // Scaled by the factor, the range is one half range to either side of its centre, and
            // the fade adds its own.
            Some(centre.abs() + (1.0 + fade) / factor)
        };
        let reach = [reach(0)?, reach(1)?, reach(2)?];
        Some(Self { faces, fade, reach })
    }

    /// Share of the correction at an instant, 0 to 1.
    pub fn share_at(&self, instant: &CorrectionInstant) -> f64 {
        let [u, v, r] = instant.velocities;
        let channels = [u, v, r, instant.delta_rad, instant.n_rps];
        let excess = self.faces.iter().map(|face| face.excess_at(&channels)).fold(0.0, f64::max);
        let out = excess / self.fade;
        // A cubic step, continuous in value and slope.
        if out < 1.0 { 1.0 - out * out * (3.0 - 2.0 * out) } else { 0.0 }
    }

    /// Derivatives of the share with respect to u, v, r, delta and n.
    pub fn share_gradient(&self, instant: &CorrectionInstant) -> [f64; 5] {
        let mut slopes = [0.0; 5];
        let [u, v, r] = instant.velocities;
        let channels = [u, v, r, instant.delta_rad, instant.n_rps];
        // The share depends on the largest excess, so only that direction has a derivative.
        // The excess is the maximum over all directions.
        let furthest = self
            .faces
            .iter()
            .map(|face| (face, face.excess_at(&channels)))
            .max_by(|(_, a), (_, b)| a.total_cmp(b));
        let Some((face, excess)) = furthest else { return slopes };
        let out = excess / self.fade;
        if out > 0.0 && out < 1.0 {
            let by_excess = -6.0 * out * (1.0 - out) / self.fade;
            let side = by_excess * face.excess_sign(&channels);
            face.terms.iter().for_each(|(k, factor, _)| slopes[*k] += side * factor);
        }
        slopes
    }

    /// Formula of the share over the channels; `value` names an expression that is used more than
    /// once.
    pub fn share_formula(&self, value: &mut dyn FnMut(Expr) -> Expr) -> Expr {
        let largest = |a: Expr, b: Expr| Expr::Call(Function::Max, vec![a, b]);
        let excess =
            self.faces.iter().map(DirectionBounds::excess_formula).fold(Expr::Number(0.0), largest);
        let out = value(divided(excess, self.fade));
        let step = subtracted(Expr::Number(3.0), Expr::Number(2.0).times(out.clone()));
        let faded = subtracted(Expr::Number(1.0), out.clone().times(out.clone()).times(step));
        // The same cubic as in a simulation: 1 - out^2 (3 - 2 out) below 1, otherwise 0.
        let parts = [out, Expr::Number(1.0), faded, Expr::Number(0.0)];
        Expr::If(Comparison::Less, Box::new(parts))
    }

    /// True if the share is zero before the motion leaves the physical range.
    pub fn is_within(&self, envelope: &MotionEnvelope) -> bool {
        let [u, v, r] = self.reach;
        // The largest speed has both velocities at their limits.
        u.hypot(v) < envelope.speed_m_s() && r < envelope.yaw_rate_rad_s()
    }
}

/// Bounds of one direction of a region. Returns `None` for a channel that a correction does not
/// have.
fn direction_bounds(face: &HalfSpace<'_>) -> Option<DirectionBounds> {
    let mut terms = [(0, 0.0, 0.0); 2];
    for (place, term) in terms.iter_mut().zip(&face.terms) {
        *place = (CHANNELS.iter().position(|c| *c == term.channel)?, term.factor, term.centre);
    }
    Some(DirectionBounds { terms, bounds: face.bounds })
}

impl DirectionBounds {
    /// Distance outside the bounds, in half ranges; negative inside.
    #[inline]
    fn excess_at(&self, channels: &[f64; 5]) -> f64 {
        let at: f64 = self.terms.iter().map(|(k, factor, c)| factor * (channels[*k] - c)).sum();
        (self.bounds[0] - at).max(at - self.bounds[1])
    }

    /// Sign of the derivative of the excess in this direction.
    fn excess_sign(&self, channels: &[f64; 5]) -> f64 {
        let at: f64 = self.terms.iter().map(|(k, factor, c)| factor * (channels[*k] - c)).sum();
        if at - self.bounds[1] > self.bounds[0] - at { 1.0 } else { -1.0 }
    }

    /// Formula of the excess over the channels.
    fn excess_formula(&self) -> Expr {
        let term = |&(k, factor, centre): &(usize, f64, f64)| {
            subtracted(Expr::Name(CHANNELS[k].to_owned()), Expr::Number(centre))
                .times(Expr::Number(factor))
        };
        // A direction along one channel has a second term with a factor of zero, which is omitted.
        let terms = self.terms.iter().filter(|(_, factor, _)| *factor != 0.0).map(term);
        let at = terms.reduce(added).unwrap_or(Expr::Number(0.0));
        let [low, high] = self.bounds.map(Expr::Number);
        let sides = vec![subtracted(low, at.clone()), subtracted(at, high)];
        Expr::Call(Function::Max, sides)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// Of the corners of a box.
    fn domain() -> FadedDomain {
        let column = |bit: u8, low: f64, high: f64| {
            (0..8_u8).map(|corner| if corner >> bit & 1 == 1 { high } else { low }).collect()
        };
        let columns = [
            ("u".to_owned(), column(0, 4.0, 6.0)),
            ("v".to_owned(), column(1, -1.0, 1.0)),
            ("r".to_owned(), column(2, -0.01, 0.01)),
        ];
        FadedDomain::from_region(&Region::from_samples(&columns.into()).unwrap(), 0.5).unwrap()
    }

    fn share(u: f64, r: f64) -> f64 {
        let accelerations = [0.0; 3];
        let velocities = [u, 0.0, r];
        domain().share_at(&CorrectionInstant {
            velocities,
            delta_rad: 9.0,
            n_rps: 9.0,
            accelerations,
        })
    }

    #[test]
    fn the_share_is_whole_inside_and_fades_to_nothing() {
        assert_eq!((share(5.0, 0.0), share(6.0, 0.0)), (1.0, 1.0));
        assert!((share(6.25, 0.0) - 0.5).abs() < 1e-12);
        assert_eq!((share(6.5, 0.0), share(5.0, -0.02), share(f64::MAX, 0.0)), (0.0, 0.0, 0.0));
    }

    #[test]
    fn it_has_no_step() {
        let fine: Vec<f64> = (0..=2000).map(|k| share(5.9 + 0.0005 * f64::from(k), 0.0)).collect();
        assert!(fine.windows(2).all(|pair| (pair[0] - pair[1]).abs() < 0.002));
    }

    #[test]
    fn its_reach_is_compared_with_the_physical_range() {
        // Up to 6.5 and 1.5 m/s, 0.015 rad/s; the range is three times the approach speed.
        assert!(domain().is_within(&MotionEnvelope::new(100.0, 2.3)));
        assert!(!domain().is_within(&MotionEnvelope::new(1.0, 2.1)));
    }
}
