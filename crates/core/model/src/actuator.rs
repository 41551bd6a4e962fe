//! Actuators of a ship: what moves and steers it, where, and by which channels of a trial.

use std::collections::BTreeMap;

use indexmap::IndexMap;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::particulars::Particulars;
use crate::quantity::Quantity;
use crate::trial::Channel;

/// Actuators by name, in the order of the file.
pub type Actuators = IndexMap<String, Actuator>;

/// Most actuators of one ship.
const MAX_ACTUATORS: usize = 16;
/// Largest distance of an actuator from midship and centre plane, m: that of the largest ships.
const MAX_DISTANCE_M: f64 = 300.0;

/// Kind of an actuator.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ActuatorKind {
    /// Propeller on a shaft.
    Propeller,
    /// Thruster that does not turn, without a rudder.
    Thruster,
    /// Rudder.
    Rudder,
    /// Azimuth thruster.
    Azimuth,
    /// Pod with its propeller.
    Pod,
    /// Outboard motor.
    Outboard,
    /// Water jet with its bucket.
    WaterJet,
    /// Tunnel thruster, which pushes sideways.
    TunnelThruster,
}

/// Direction of rotation seen from aft.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Rotation {
    /// Clockwise: a right-handed propeller ahead.
    Right,
    /// Anticlockwise.
    Left,
}

/// An actuator as the file of a vessel writes it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Actuator {
    /// Kind.
    pub kind: ActuatorKind,
    /// Place forward of midship, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub x_m: Option<f64>,
    /// Place to starboard of the centre plane, m; default: on it.
    #[serde(default)]
    pub y_m: f64,
    /// Diameter of its propeller or jet, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub diameter_m: Option<f64>,
    /// Direction in which its propeller turns ahead.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub turns: Option<Rotation>,
    /// Channels of a trial that record it, each with the names of its column in the ship's files.
    /// Actuators that follow one order share a channel.
    #[serde(default)]
    pub channels: BTreeMap<Channel, Vec<String>>,
    /// Key of the source.
    pub source: String,
    /// A remark.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
}

/// Channels that may record an actuator, with the side on which it then stands: -1 for port.
const ACTUATOR_CHANNELS: [(Channel, f64); 6] = [
    (Channel::N, 0.0),
    (Channel::Delta, 0.0),
    (Channel::NS, 1.0),
    (Channel::DeltaS, 1.0),
    (Channel::NP, -1.0),
    (Channel::DeltaP, -1.0),
];

impl Actuator {
    /// Returns the faults of an actuator; `sources` are the keys that exist.
    fn find_faults(&self, sources: &[&str]) -> Vec<String> {
        let places = [self.x_m.unwrap_or(0.0), self.y_m];
        let is_far = places.iter().any(|place| place.is_nan() || place.abs() > MAX_DISTANCE_M);
        let far = is_far.then(|| format!("stands more than {MAX_DISTANCE_M} m from midship"));
        let is_wrong = self.diameter_m.is_some_and(|d| !(d > 0.0 && d < 20.0));
        let diameter = is_wrong.then(|| "`diameter_m` is above 0 and below 20 m".to_owned());
        let unknown = !sources.contains(&self.source.as_str());
        let source = unknown.then(|| format!("`{}` is not listed under `sources`", self.source));
        let channels = self.channels.keys().filter_map(|channel| self.channel_fault(*channel));
        [far, diameter, source].into_iter().flatten().chain(channels).collect()
    }

    fn channel_fault(&self, channel: Channel) -> Option<String> {
        let Some((_, side)) = ACTUATOR_CHANNELS.iter().find(|(known, _)| *known == channel) else {
            let known = ACTUATOR_CHANNELS.map(|(channel, _)| channel.name()).join(", ");
            return Some(format!("`{channel}` records no actuator; the channels are {known}"));
        };
        let is_other_side = *side != 0.0 && self.y_m * side <= 0.0;
        is_other_side.then(|| format!("`{channel}` is of the other side than y_m = {} m", self.y_m))
    }
}

/// Returns the faults of the actuators of a vessel, each with its name.
pub(crate) fn find_faults(actuators: &Actuators, sources: &[&str]) -> Vec<(String, String)> {
    let many = (actuators.len() > MAX_ACTUATORS)
        .then(|| (String::new(), format!("more than {MAX_ACTUATORS} actuators")));
    let each = actuators.iter().flat_map(|(name, actuator)| {
        actuator.find_faults(sources).into_iter().map(|message| (name.clone(), message))
    });
    many.into_iter().chain(each).collect()
}

/// Adds the particulars that follow from the actuators: the lever of thrusters to either side, and
/// the diameter of the propellers. Stated ones stay.
pub(crate) fn add_particulars(particulars: &mut Particulars, actuators: &Actuators) {
    let drives = |actuator: &&Actuator| actuator.kind != ActuatorKind::Rudder;
    let mean = |values: Vec<f64>| {
        let count = values.len() as f64;
        (count > 0.0).then(|| values.iter().sum::<f64>() / count)
    };
    let driving = || actuators.values().filter(drives);
    let lever = mean(driving().map(|a| a.y_m.abs()).filter(|lever| *lever > 0.0).collect());
    let diameter = mean(driving().filter_map(|actuator| actuator.diameter_m).collect());
    let source = driving().next().map_or("", |actuator| &actuator.source);
    for (name, value) in [("thruster_y_m", lever), ("propeller_diameter_m", diameter)] {
        let Some(value) = value else { continue };
        particulars.entry(name.to_owned()).or_insert_with(|| Quantity::new(value, source));
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use crate::Vessel;

    const HEAD: &str = "kind: vessel\nname: a\ntitle: A\ncategory: usv\n\
        sources: { s: { citation: C } }\nparticulars: { source: s, values: { lpp_m: 2.0 } }\n";

    #[test]
    fn levers_and_diameters_become_particulars() {
        let text = format!(
            "{HEAD}actuators:\n  left: {{ kind: thruster, y_m: -0.4, diameter_m: 0.2, channels: \
             {{ n_p: [thr_left] }}, source: s }}\n  right: {{ kind: thruster, y_m: 0.4, \
             diameter_m: 0.2, channels: {{ n_s: [] }}, source: s }}\n"
        );
        let vessel = Vessel::parse("a.yaml", &text).unwrap();
        assert_eq!(vessel.particular("thruster_y_m"), Some(0.4));
        assert_eq!(vessel.particular("propeller_diameter_m"), Some(0.2));
    }

    #[test]
    fn an_actuator_on_the_other_side_than_its_channel_is_refused() {
        let refused = |actuator: &str| {
            let text =
                format!("{HEAD}actuators: {{ one: {{ kind: rudder, source: s, {actuator} }} }}\n");
            Vessel::parse("a.yaml", &text).unwrap_err().to_string()
        };
        let side = refused("y_m: 0.4, channels: { n_p: [] }");
        assert!(side.contains("actuators.one") && side.contains("other side"), "{side}");
        assert!(refused("channels: { psi: [] }").contains("records no actuator"));
        assert!(refused("diameter_m: 25.0").contains("below 20 m"));
    }
}
