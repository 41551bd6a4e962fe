//! Everything that the trials of a ship hide.

use super::current::Current;
use super::force::Force;
use super::gear::Gear;
use super::sensors::Sensor;
use super::wind::Wind;

/// What is hidden; nothing by default.
#[derive(Debug, Clone, Default)]
pub struct Hidden {
    /// The wind, where it blows.
    pub wind: Option<Wind>,
    /// The water's own motion.
    pub current: Option<Current>,
    /// Between the rudder that is recorded and the one that is there.
    pub gear: Vec<Gear>,
    /// Forces of any other kind.
    pub forces: Vec<Force>,
    /// Errors of instruments.
    pub sensors: Vec<Sensor>,
    /// The share of each trial from which on gear, forces and rate biases are there.
    pub since: f64,
    /// The trial from which on they are, counted from 0.
    pub first_trial: usize,
}

impl Hidden {
    /// Both together.
    pub fn and(mut self, other: Self) -> Self {
        self.wind = self.wind.or(other.wind);
        self.current = self.current.or(other.current);
        self.gear.extend(other.gear);
        self.forces.extend(other.forces);
        self.sensors.extend(other.sensors);
        self.since = self.since.max(other.since);
        self.first_trial = self.first_trial.max(other.first_trial);
        self
    }
}
