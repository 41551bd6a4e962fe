//! Ships at random: particulars, form and scatter of the laws drawn by a seed.

mod single;
mod twin;

use rand_chacha::ChaCha12Rng;

use super::manoeuvre::figures;
use super::motion::Truth;
use super::stability::growth_rate;
use crate::synthetic::replica;

pub use single::single_screw;
pub use twin::twin_screw;

/// A ship less stable than this (growth by `U/L`) is drawn again: none is built so.
const GROWTH_AT_MOST: f64 = 0.25;
/// Figures of a ship that sails every turn and zigzag to its end.
const ALL_FIGURES: usize = 12;

/// The kinds of hull that are drawn.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Hull {
    /// One propeller, one rudder.
    #[default]
    SingleScrew,
    /// Two of each.
    TwinScrew,
}

impl Hull {
    /// `single-screw` or `twin-screw`.
    ///
    /// # Errors
    /// Another word.
    pub fn named(name: &str) -> Result<Self, String> {
        match name {
            "single-screw" => Ok(Self::SingleScrew),
            "twin-screw" => Ok(Self::TwinScrew),
            _ => Err(format!("hulls are single-screw and twin-screw, not {name}")),
        }
    }

    /// The ship of a seed.
    pub fn ship(self, seed: u64) -> Box<dyn Truth + Send + Sync> {
        match self {
            Self::SingleScrew => Box::new(single_screw(seed)),
            Self::TwinScrew => Box::new(twin_screw(seed)),
        }
    }
}

/// Drawn until the ship turns to both sides and ends every zigzag.
fn steerable<T: Truth>(seed: u64, draw: impl Fn(&mut ChaCha12Rng) -> T) -> T {
    let mut rng = replica(seed, 0);
    loop {
        let ship = draw(&mut rng);
        if growth_rate(&ship) < GROWTH_AT_MOST && figures(&ship).len() == ALL_FIGURES {
            return ship;
        }
    }
}
