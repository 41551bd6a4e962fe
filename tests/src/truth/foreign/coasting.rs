//! Runs with the propeller stopped and reversed, whose ends every model must reach.

use super::craft::Craft;
use super::simulate::{Track, simulate, start};

/// Share of the speed that is left at the end of a coasting run.
const LEFT: f64 = 0.1;
/// Revolutions astern by those of the approach.
const ASTERN: f64 = -0.7;
/// Lengths at the speed of the approach after which a craft that has not slowed down is given up.
const AT_MOST: f64 = 400.0;
/// Lengths for which the propeller is reversed.
const REVERSED: f64 = 80.0;

/// Both runs of a craft.
#[derive(Debug, Clone, PartialEq)]
pub struct Coasting {
    /// With the propeller stopped, until nine tenths of the speed are lost.
    pub stopped: Track,
    /// With the propeller reversed, until well after the craft moves astern.
    pub reversed: Track,
    /// When the craft has come to rest with the propeller reversed, s.
    pub rest_s: Option<f64>,
}

impl Coasting {
    /// Simulates both, with the steering amidships.
    pub fn simulate(craft: &Craft) -> Self {
        let length_s = craft.size().length_time_s();
        let idle = craft.orders_at(0.0, 0.0);
        let mut stopped = simulate(craft, start(craft, 1.0), AT_MOST * length_s, |_, _| idle);
        let speeds = stopped.speeds();
        let end = speeds.iter().position(|u| *u <= LEFT * speeds[0]).unwrap_or(speeds.len() - 1);
        stopped.t_s.truncate(end + 1);
        stopped.motions.truncate(end + 1);
        let astern = craft.orders_at(ASTERN * craft.rated_rps(), 0.0);
        let reversed = simulate(craft, start(craft, 1.0), REVERSED * length_s, |_, _| astern);
        let rest = reversed.speeds().iter().position(|u| *u <= 0.0);
        Self { stopped, reversed, rest_s: rest.map(|index| index as f64 * craft.step_s()) }
    }
}
