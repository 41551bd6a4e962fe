//! Free-running trial in canonical units and signs.

use std::collections::BTreeMap;
use std::fmt;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::manifest::VelocityFrame;
use sistership_formula::units::Dimension;

/// A quantity that a trial may record besides time. Ship-fixed velocities are those of midship; `U`
/// and `V` are over the ground unless the trial declares them through the water; positive `Delta`
/// turns the ship to starboard; angles in radians, revolutions per second.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema,
)]
#[serde(rename_all = "snake_case")]
pub enum Channel {
    /// Position north, m.
    X,
    /// Position east, m.
    Y,
    /// Heading clockwise from north, rad, continuous.
    Psi,
    /// Surge velocity, m/s.
    U,
    /// Sway velocity, m/s, to starboard.
    V,
    /// Yaw rate, rad/s, to starboard.
    R,
    /// Roll angle, rad, to starboard.
    Phi,
    /// Roll rate, rad/s.
    P,
    /// Rudder angle, rad, positive turns the ship to starboard.
    Delta,
    /// Propeller revolutions, 1/s.
    N,
    /// True wind speed, m/s.
    WindSpeed,
    /// Direction from which the true wind comes, rad clockwise from north.
    WindFrom,
    /// Apparent wind speed, m/s.
    ApparentWindSpeed,
    /// Direction from which the apparent wind comes, rad clockwise from the bow.
    ApparentWindFrom,
    /// Water depth, m.
    Depth,
    /// Surge velocity through the water, m/s, in addition to `U` over the ground.
    UWater,
    /// Sway velocity through the water, m/s, to starboard, in addition to `V` over the ground.
    VWater,
    /// Revolutions of the starboard propeller or thruster, 1/s, in addition to `N`, their mean.
    NS,
    /// Revolutions of the port propeller or thruster, 1/s.
    NP,
    /// Angle of the starboard rudder, rad, in addition to `Delta`, their mean.
    DeltaS,
    /// Angle of the port rudder, rad.
    DeltaP,
}

/// Name in manifests, canonical column, and dimension of each channel, in the order of the enum.
const CHANNELS: [(Channel, &str, &str, Dimension); 21] = [
    (Channel::X, "x", "x_m", Dimension::LENGTH),
    (Channel::Y, "y", "y_m", Dimension::LENGTH),
    (Channel::Psi, "psi", "psi_rad", Dimension::NONE),
    (Channel::U, "u", "u_m_s", Dimension::SPEED),
    (Channel::V, "v", "v_m_s", Dimension::SPEED),
    (Channel::R, "r", "r_rad_s", Dimension::RATE),
    (Channel::Phi, "phi", "phi_rad", Dimension::NONE),
    (Channel::P, "p", "p_rad_s", Dimension::RATE),
    (Channel::Delta, "delta", "delta_rad", Dimension::NONE),
    (Channel::N, "n", "n_rps", Dimension::RATE),
    (Channel::WindSpeed, "wind_speed", "wind_speed_m_s", Dimension::SPEED),
    (Channel::WindFrom, "wind_from", "wind_from_rad", Dimension::NONE),
    (
        Channel::ApparentWindSpeed,
        "apparent_wind_speed",
        "apparent_wind_speed_m_s",
        Dimension::SPEED,
    ),
    (Channel::ApparentWindFrom, "apparent_wind_from", "apparent_wind_from_rad", Dimension::NONE),
    (Channel::Depth, "depth", "depth_m", Dimension::LENGTH),
    (Channel::UWater, "u_water", "u_water_m_s", Dimension::SPEED),
    (Channel::VWater, "v_water", "v_water_m_s", Dimension::SPEED),
    (Channel::NS, "n_s", "n_s_rps", Dimension::RATE),
    (Channel::NP, "n_p", "n_p_rps", Dimension::RATE),
    (Channel::DeltaS, "delta_s", "delta_s_rad", Dimension::NONE),
    (Channel::DeltaP, "delta_p", "delta_p_rad", Dimension::NONE),
];

impl Channel {
    /// Channels of propeller revolutions: of one shaft or all, of starboard, of port.
    pub const SHAFTS: [Self; 3] = [Self::N, Self::NS, Self::NP];

    /// Every channel.
    pub fn all_channels() -> impl Iterator<Item = Self> {
        CHANNELS.iter().map(|&(channel, ..)| channel)
    }

    fn table_row(self) -> &'static (Self, &'static str, &'static str, Dimension) {
        // The table is in the order of the enum.
        &CHANNELS[self as usize]
    }

    /// Name in manifests and formulas.
    pub fn name(self) -> &'static str {
        self.table_row().1
    }

    /// Canonical column name, which includes the unit.
    pub fn column_name(self) -> &'static str {
        self.table_row().2
    }

    /// Dimension of its values.
    pub fn dimension(self) -> Dimension {
        self.table_row().3
    }

    /// Returns the channel with a name in manifests.
    pub fn by_name(name: &str) -> Option<Self> {
        CHANNELS.iter().find(|(_, known, ..)| *known == name).map(|&(channel, ..)| channel)
    }

    /// Returns the channel with a canonical column name.
    pub fn by_column(column: &str) -> Option<Self> {
        CHANNELS.iter().find(|(_, _, known, _)| *known == column).map(|&(channel, ..)| channel)
    }
}

impl fmt::Display for Channel {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(self.name())
    }
}

/// One trial: time and channels of equal length, in canonical units.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Trial {
    /// Name for readers, usually that of the file.
    pub name: String,
    /// Time, s, strictly increasing.
    pub t_s: Vec<f64>,
    /// Recorded channels; every vector is as long as `t_s`, every value finite.
    pub channels: BTreeMap<Channel, Vec<f64>>,
    /// The manoeuvre, such as `zigzag 10/10`.
    pub manoeuvre: Option<String>,
    /// Water depth where it is constant, m.
    pub depth_m: Option<f64>,
    /// Frame of `u` and `v`: speeds over the ground or through the water.
    pub velocity: VelocityFrame,
    /// Findings of the checks that did not refuse the trial.
    pub warnings: Vec<Finding>,
}

impl Trial {
    /// Samples of a channel, if it was recorded.
    pub fn channel(&self, channel: Channel) -> Option<&[f64]> {
        self.channels.get(&channel).map(Vec::as_slice)
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.t_s.len()
    }

    /// Returns true if there is no sample.
    pub fn is_empty(&self) -> bool {
        self.t_s.is_empty()
    }

    /// Time from the first to the last sample, s.
    pub fn duration_s(&self) -> f64 {
        match (self.t_s.first(), self.t_s.last()) {
            (Some(first), Some(last)) => last - first,
            _ => 0.0,
        }
    }

    /// Median time between samples, s.
    pub fn interval_s(&self) -> f64 {
        let mut steps: Vec<f64> = self.t_s.windows(2).map(|pair| pair[1] - pair[0]).collect();
        // The median: gaps do not change it.
        let middle = steps.len() / 2;
        if steps.is_empty() { 0.0 } else { *steps.select_nth_unstable_by(middle, f64::total_cmp).1 }
    }

    /// Ranges of samples without a gap: a step longer than 1.5 times the median starts a new range.
    pub fn segments(&self) -> Vec<std::ops::Range<usize>> {
        let limit = 1.5 * self.interval_s();
        let breaks = (1..self.len()).filter(|&k| self.t_s[k] - self.t_s[k - 1] > limit);
        let mut starts: Vec<usize> = std::iter::once(0).chain(breaks).collect();
        starts.push(self.len());
        starts.windows(2).map(|pair| pair[0]..pair[1]).filter(|range| !range.is_empty()).collect()
    }
}

/// A finding of a check.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Finding {
    /// Row of the file, counted from 1 with the header as row 1; absent if it concerns the whole
    /// column.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub row: Option<usize>,
    /// Name of the column in the file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub column: Option<String>,
    /// The finding and its remedy.
    pub message: String,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_channel_table_is_in_the_order_of_the_enum() {
        for channel in Channel::all_channels() {
            assert_eq!(Channel::by_name(channel.name()), Some(channel));
            assert_eq!(Channel::by_column(channel.column_name()), Some(channel));
        }
    }

    #[test]
    fn a_gap_starts_a_new_segment() {
        let trial = Trial { t_s: vec![0.0, 0.1, 0.2, 5.0, 5.1], ..Trial::default() };
        assert_eq!(trial.segments(), vec![0..3, 3..5]);
    }
}
