//! Random craft that can be steered.

use rand::RngExt;
use rand_chacha::ChaCha12Rng;

use super::craft::{Craft, Parts};
use super::simulate::{growth_rate, turning};
use crate::synthetic::replica;

/// Growth of a small yaw rate by `U/L` from which on a craft is drawn again.
const GROWTH_AT_MOST: f64 = 0.25;
/// Tactical diameters by length: craft that turn tighter or wider are drawn again. Kijima and
/// others have 1.5 to 6 for merchant ships; small craft reach more than that at speed.
const DIAMETERS: std::ops::Range<f64> = 1.2..8.0;
/// The same for craft without an angle, whose slender hulls turn widely at speed.
const BY_DIFFERENCE: std::ops::Range<f64> = 1.2..16.0;
/// Draws after which a kind is wrong.
const DRAWS: usize = 200;

/// Random numbers in ranges.
pub struct Draw {
    rng: ChaCha12Rng,
    /// The seed, for names.
    pub seed: u64,
}

impl Draw {
    /// A number between two limits.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        self.rng.random_range(low..high)
    }
}

/// The first craft of a seed that keeps its course more or less, and turns to both sides.
///
/// # Panics
/// None of the draws does.
pub fn steerable(seed: u64, kind: usize, parts: impl Fn(&mut Draw) -> Parts) -> Craft {
    let mut draw = Draw { rng: replica(seed, 500 + kind), seed };
    let craft = (0..DRAWS).map(|_| Craft::new(parts(&mut draw))).find(can_be_steered);
    craft.unwrap_or_else(|| panic!("no craft of kind {kind} and seed {seed} can be steered"))
}

fn can_be_steered(craft: &Craft) -> bool {
    growth_rate(craft) < GROWTH_AT_MOST
        && [35.0, -35.0].into_iter().all(|angle| turns(craft, angle))
}

fn turns(craft: &Craft, angle_deg: f64) -> bool {
    let diameter = turning(craft, angle_deg).tactical_diameter_m;
    let range = if craft.steers_by_difference() { BY_DIFFERENCE } else { DIAMETERS };
    diameter.is_some_and(|metres| range.contains(&(metres / craft.size().lpp_m)))
}
