//! A wind of steady strength and direction with gusts, by either of two authors.

use sistership_simulation::state::{StateVector, at};

use super::super::dimensions::Dimensions;
use super::{blendermann, isherwood};

/// Density of air, kg/m3.
const AIR_KG_M3: f64 = 1.224;

/// Whose coefficients.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Author {
    /// Isherwood 1972.
    Isherwood,
    /// Blendermann 1994.
    Blendermann,
}

/// A wind.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wind {
    /// Speed, m/s.
    pub speed_m_s: f64,
    /// Where it comes from, rad.
    pub from_rad: f64,
    /// Whose coefficients give its force.
    pub author: Author,
    /// Whether trials record it.
    pub is_recorded: bool,
}

/// What is above the water.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Areas {
    /// Seen from ahead, m2.
    pub frontal_m2: f64,
    /// Seen from abeam, m2.
    pub lateral_m2: f64,
    /// Length, m.
    pub length_m: f64,
    /// Breadth, m.
    pub beam_m: f64,
    /// Perimeter of the lateral view by length.
    pub perimeter: f64,
    /// Centroid of the lateral area behind the bow, by length.
    pub centroid: f64,
    /// Superstructure by lateral area.
    pub superstructure: f64,
    /// Groups of masts.
    pub masts: f64,
    /// Whether it is one of a tanker.
    pub is_tanker: bool,
}

impl Areas {
    /// Chosen as those of ships of the kind: a deck load of containers, or a tanker's house aft.
    pub fn of(ship: &Dimensions) -> Self {
        let is_tanker = ship.category == "tanker";
        let length_m = 1.04 * ship.lpp_m;
        let high = if is_tanker { 0.055 } else { 0.10 };
        Self {
            frontal_m2: if is_tanker { 0.5 } else { 0.9 } * ship.beam_m.powi(2),
            lateral_m2: high * length_m.powi(2),
            length_m,
            beam_m: ship.beam_m,
            perimeter: if is_tanker { 1.20 } else { 1.30 },
            centroid: if is_tanker { 0.55 } else { 0.50 },
            superstructure: if is_tanker { 0.35 } else { 0.20 },
            masts: 1.0,
            is_tanker,
        }
    }
}

impl Wind {
    /// Surge, sway (N) and yaw (N m) on a ship that moves over the ground as the state says, less
    /// those of still air, which its trials have always had.
    pub fn forces(&self, ship: &Dimensions, state: &StateVector) -> [f64; 3] {
        let areas = Areas::of(ship);
        let off = self.from_rad - state[at::PSI];
        let along = state[at::U] + self.speed_m_s * off.cos();
        let across = state[at::V] + self.speed_m_s * off.sin();
        let blowing = self.of_apparent(&areas, along, across);
        let still = self.of_apparent(&areas, state[at::U], state[at::V]);
        std::array::from_fn(|axis| blowing[axis] - still[axis])
    }

    /// `along` and `across` are where the apparent wind comes from, ahead and to starboard.
    fn of_apparent(&self, areas: &Areas, along: f64, across: f64) -> [f64; 3] {
        let angle = across.abs().atan2(along);
        let [x, y, n] = match self.author {
            Author::Isherwood => isherwood::coefficients(areas, angle),
            Author::Blendermann => blendermann::coefficients(areas, angle),
        };
        let head = 0.5 * AIR_KG_M3 * (along.powi(2) + across.powi(2));
        // To lee: from starboard to port, and the bow with it.
        let lee = -across.signum();
        let lateral = lee * head * areas.lateral_m2;
        [head * areas.frontal_m2 * x, lateral * y, lateral * areas.length_m * n]
    }
}
