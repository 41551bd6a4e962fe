//! Ships as foreign to the laws of the zoo as possible, by which the default call is judged: eight
//! kinds of propulsion and steering, each a family by seed.
//!
//! A craft is integrated by equations of this module alone: hulls by sections with incomplete
//! recovery (`hull`), propellers as blade elements in four quadrants (`screw`), foils that stall
//! (`foil`), engines that lose revolutions (`engine`), and the devices of `devices`. As propulsion
//! is physical in all quadrants, every craft comes to rest with its propeller stopped and goes
//! astern with it reversed. Dimensions and coefficients are drawn in the ranges that each kind
//! states. Seeds below [`JUDGEMENT`] are for work, the others for judgement alone.

pub mod coasting;
pub mod course;
pub mod craft;
pub mod devices;
pub mod engine;
pub mod foil;
pub mod hull;
mod kinds;
pub mod motion;
pub mod programme;
pub mod record;
pub mod resistance;
pub mod roll;
pub mod screw;
pub mod simulate;
pub mod size;
pub mod steerable;

use craft::Craft;
use steerable::steerable;

/// The first seed that is kept for judgement.
pub const JUDGEMENT: u64 = 1000;

/// Kinds of craft.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// Car carrier that heels, its rudder stalls and its engine loses revolutions in turns.
    CarCarrier,
    /// Workboat steered by an outboard, with propeller walk and a resistance hump.
    Outboard,
    /// Research vessel with two ducted azimuth thrusters at constant power.
    Azimuth,
    /// Ferry with two propellers and two rudders by one engine order.
    TwinScrew,
    /// Cruise ship with two pods.
    Pods,
    /// Fast craft with a water jet.
    WaterJet,
    /// Slender cargo ship with one propeller.
    Cargo,
    /// Catamaran steered by the difference of two fixed thrusters.
    Catamaran,
}

impl Kind {
    /// Every kind.
    pub const ALL: [Self; 8] = [
        Self::CarCarrier,
        Self::Outboard,
        Self::Azimuth,
        Self::TwinScrew,
        Self::Pods,
        Self::WaterJet,
        Self::Cargo,
        Self::Catamaran,
    ];

    /// The name on command lines and in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::CarCarrier => "car-carrier",
            Self::Outboard => "outboard",
            Self::Azimuth => "azimuth",
            Self::TwinScrew => "twin-screw",
            Self::Pods => "pods",
            Self::WaterJet => "water-jet",
            Self::Cargo => "cargo",
            Self::Catamaran => "catamaran",
        }
    }

    /// The kind of a name.
    ///
    /// # Errors
    /// Another name; says which there are.
    pub fn from_name(name: &str) -> Result<Self, String> {
        let known = || Self::ALL.map(Self::name).join(", ");
        let found = Self::ALL.into_iter().find(|kind| kind.name() == name);
        found.ok_or_else(|| format!("unknown kind {name}; there are {}", known()))
    }

    /// The craft of a seed.
    pub fn craft(self, seed: u64) -> Craft {
        let draw = match self {
            Self::CarCarrier => kinds::car_carrier::parts,
            Self::Outboard => kinds::outboard::parts,
            Self::Azimuth => kinds::azimuth::parts,
            Self::TwinScrew => kinds::twin_screw::parts,
            Self::Pods => kinds::pods::parts,
            Self::WaterJet => kinds::water_jet::parts,
            Self::Cargo => kinds::cargo::parts,
            Self::Catamaran => kinds::catamaran::parts,
        };
        steerable(seed, self as usize, draw)
    }
}
