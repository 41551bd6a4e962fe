//! External inputs of an exported model, with unit, meaning and range.

use sistership_model::effect::qualified_name;
use sistership_model::validity::Region;
use sistership_model::{Model, law, particulars};

use crate::identifier::to_identifier;
use crate::quoting::single_line;

/// External input of a model.
#[derive(Debug, Clone, PartialEq)]
pub struct ExternalInput {
    /// Name in the law.
    pub name: String,
    /// Identifier in exported programs.
    pub identifier: String,
    /// SI unit.
    pub unit: String,
    /// Meaning and sign convention.
    pub meaning: String,
    /// Default value.
    pub default: f64,
    /// Range in which the model is valid, as far as it is known.
    pub range: [Option<f64>; 2],
}

/// Effect and form by which a current acts on any law, and its parameters.
pub const CURRENT: (&str, &str, [&str; 2]) = ("current", "constant", ["north_m_s", "east_m_s"]);

/// Names, identifiers, units and meanings of common inputs of laws and effects.
const KNOWN: [(&str, &str, &str, &str); 13] = [
    ("n", "n", "1/s", "propeller revolutions, positive drives ahead"),
    ("n_s", "n_starboard", "1/s", "revolutions of the starboard propeller, positive drives ahead"),
    ("n_p", "n_port", "1/s", "revolutions of the port propeller, positive drives ahead"),
    ("delta_s", "delta_starboard", "rad", "starboard rudder, positive turns the ship to starboard"),
    ("delta_p", "delta_port", "rad", "port rudder, positive turns the ship to starboard"),
    ("depth", "depth", "m", "water depth; infinite for deep water"),
    ("wind_speed", "wind_speed", "m/s", "true wind speed"),
    ("wind_from", "wind_from", "rad", "direction the true wind comes from, clockwise from north"),
    ("apparent_wind_speed", "apparent_wind_speed", "m/s", "apparent wind speed"),
    (
        "apparent_wind_from",
        "apparent_wind_from",
        "rad",
        "direction the apparent wind comes from, clockwise from the bow",
    ),
    ("recorded.t", "t_since_start", "s", "time since the start, for effects that grow with it"),
    (
        "recorded.phi",
        "phi_given",
        "rad",
        "roll angle to starboard, which the law does not simulate",
    ),
    ("recorded.p", "p_given", "rad/s", "roll rate to starboard, which the law does not simulate"),
];

impl ExternalInput {
    /// Creates an input of a model's law with effects.
    pub fn from_law(model: &Model, name: &str, input: &law::LawInput) -> Self {
        if let Some(current) = Self::current_component(name, input) {
            return current;
        }
        let known = KNOWN.iter().find(|(law, ..)| *law == name);
        let (identifier, unit, meaning) = match known {
            Some(&(_, identifier, unit, meaning)) => {
                (identifier.to_owned(), unit.to_owned(), meaning.to_owned())
            }
            None => {
                (to_identifier(name), si_unit(input), single_line(&format!("`{name}` of the law")))
            }
        };
        // Propeller revolutions default to those of the model's approach.
        let approach_rps = model.revolutions_rps.unwrap_or(0.0);
        let default = match (name, input.default, &input.helm) {
            (_, Some(default), _) => default,
            ("n", None, _) => approach_rps,
            (_, None, Some(helm)) => law::helm_value(helm, 0.0, approach_rps),
            (_, None, None) => 0.0,
        };
        let range = valid_range(model, name);
        Self { name: name.to_owned(), identifier, unit, meaning, default, range }
    }

    /// Component of the current, if the input is one.
    fn current_component(name: &str, input: &law::LawInput) -> Option<Self> {
        let (effect, form, parameters) = CURRENT;
        // The parameters of the effect are components to the north and to the east.
        let place = parameters.iter().position(|p| qualified_name(effect, form, p) == name)?;
        Some(Self {
            name: name.to_owned(),
            identifier: ["current_north", "current_east"][place].to_owned(),
            unit: "m/s".to_owned(),
            meaning: format!("velocity of the water to the {}", ["north", "east"][place]),
            default: input.default.unwrap_or(0.0),
            range: [None, None],
        })
    }
}

/// SI unit of an input. A dimensionless one is an angle.
fn si_unit(input: &law::LawInput) -> String {
    match input.dimension.to_string().as_str() {
        "1" => "rad".to_owned(),
        "m s^-1" => "m/s".to_owned(),
        "s^-1" => "1/s".to_owned(),
        other => other.to_owned(),
    }
}

/// Range of an input: for the depth more than the draught, otherwise the range covered by trials.
fn valid_range(model: &Model, name: &str) -> [Option<f64>; 2] {
    if name == "depth" {
        return [particulars::particular_value(&model.particulars, "draught_m"), None];
    }
    let covered = |region: &Region| region.ranges.get(name).map(|range| range.map(Some));
    model.validity.as_ref().and_then(covered).unwrap_or([None, None])
}
