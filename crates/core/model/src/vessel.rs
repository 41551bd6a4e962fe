//! Vessels of the zoo: particulars, conventions, and the published coefficients of their models,
//! with sources.

use std::collections::BTreeMap;

use indexmap::IndexMap;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::actuator::{self, Actuator, Actuators};
use crate::error::{ErrorContext, FileError};
use crate::free_running::FreeRunning;
use crate::manifest::RudderSign;
use crate::name::check_slug;
use crate::particulars::{self, Particulars};
use crate::quantity::{Quantity, Section};
use crate::source::Source;

/// A vessel as its file writes it; see `models/vessels/README.md`.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct VesselFile {
    /// Always `vessel`.
    pub kind: VesselKind,
    /// Name in the zoo: lower case, digits, hyphens.
    #[schemars(length(min = 1, max = 64), regex(pattern = "^[a-z0-9][a-z0-9-]*$"))]
    pub name: String,
    /// One line for readers.
    pub title: String,
    /// Ships are compared within a category: `tanker`, `dry-cargo`, `car-carrier`, ...
    #[schemars(length(min = 1, max = 64), regex(pattern = "^[a-z0-9][a-z0-9-]*$"))]
    pub category: String,
    /// A more specific type for readers.
    #[serde(default, rename = "type", skip_serializing_if = "Option::is_none")]
    pub ship_type: Option<String>,
    /// Full-scale length over model length, for models.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scale: Option<f64>,
    /// Publications by key.
    #[serde(default)]
    pub sources: BTreeMap<String, Source>,
    /// Licence of a source's own files, by its key: `MIT`, `CC BY 4.0`, `none stated`.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub licences: BTreeMap<String, String>,
    /// Sign conventions of the sources.
    #[serde(default)]
    pub conventions: VesselConventions,
    /// Particulars of the ship.
    pub particulars: Section,
    /// What moves and steers the ship, by name.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    #[schemars(with = "BTreeMap<String, Actuator>")]
    pub actuators: Actuators,
    /// Characteristic vectors exactly as a publication prints them, by the definition's name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub quoted_vectors: BTreeMap<String, QuotedVectorFile>,
    /// Its models; empty for a ship known by particulars only.
    #[serde(default)]
    pub models: Vec<PublishedModelFile>,
    /// Published free-running trials, against which the models are validated.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub free_running: Vec<FreeRunning>,
}

/// The word `vessel`.
#[derive(Debug, Clone, Copy, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum VesselKind {
    /// The only one.
    Vessel,
}

/// Sign conventions of the sources of a vessel.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct VesselConventions {
    /// Direction in which positive rudder turns the ship in the published coefficients.
    pub rudder_positive: RudderSign,
}

/// A characteristic vector as printed.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct QuotedVectorFile {
    /// Key of the source.
    pub source: String,
    /// A remark.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
    /// The components by name.
    pub values: BTreeMap<String, crate::quantity::ValueEntry>,
}

/// A published or estimated model as its file writes it, in the signs of the source.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PublishedModelFile {
    /// Its name among the vessel's models.
    pub name: String,
    /// The law it belongs to.
    pub law: String,
    /// Origin of the figures.
    pub status: Status,
    /// A remark.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
    /// The approach speed the figures belong to, m/s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed_m_s: Option<f64>,
    /// The propeller revolutions at that speed, 1/s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub revolutions_rps: Option<f64>,
    /// The steering gear.
    #[serde(default)]
    pub steering: Steering,
    /// Nonlinear parameters.
    #[serde(default)]
    pub parameters: Section,
    /// Coefficients.
    #[serde(default)]
    pub coefficients: Section,
}

/// Origin of a model's figures, and thus the trust that they deserve.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// As published from captive tests, computations or trials.
    Published,
    /// From particulars by regression formulas: a substitute until trials are available.
    Estimated,
    /// A source model transferred to another ship by the prime system, not fitted to it.
    Transferred,
    /// Fitted to trials.
    Refined,
}

/// The steering gear: `rate = clamp((order - angle) / time_constant, +-rate_limit)`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Steering {
    /// Largest rudder angle, deg.
    pub limit_deg: f64,
    /// Largest rudder rate, deg/s.
    pub rate_deg_s: f64,
    /// Time constant, s; zero for a gear that moves at its full rate until it reaches the order.
    pub time_constant_s: f64,
    /// Key of the source.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub source: Option<String>,
    /// A remark.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
}

impl Default for Steering {
    /// The minimum of SOLAS II-1/29 for a main steering gear: 35 deg, 65 deg in 28 s.
    fn default() -> Self {
        Self { limit_deg: 35.0, rate_deg_s: 2.32, time_constant_s: 0.0, source: None, note: None }
    }
}

/// Vessel, read and checked.
#[derive(Debug, Clone)]
pub struct Vessel {
    /// The file in which it is defined.
    pub file: VesselFile,
    /// Its particulars with sources.
    pub particulars: Particulars,
    /// Vectors as printed, by definition and component.
    pub quoted_vectors: BTreeMap<String, BTreeMap<String, f64>>,
}

impl Vessel {
    /// Reads and checks a vessel; its models are checked against their laws when they are used.
    ///
    /// # Errors
    /// Returns an error with file, line and field of every fault.
    pub fn parse(file: &str, text: &str) -> Result<Self, FileError> {
        let blame = ErrorContext::new(file, text);
        Self::check_file(blame.deserialize()?, &blame)
    }

    /// Checks a vessel that was given as a document; `name` is its name in errors.
    ///
    /// # Errors
    /// The errors of [`Vessel::parse`].
    pub fn from_file(name: &str, raw: VesselFile) -> Result<Self, FileError> {
        Self::check_file(raw, &ErrorContext::new(name, ""))
    }

    fn check_file(raw: VesselFile, blame: &ErrorContext<'_>) -> Result<Self, FileError> {
        let keys: Vec<&str> = raw.sources.keys().map(String::as_str).collect();
        // All sections are checked before the result, so that one answer lists every fault.
        let mut faults = check_header(&raw);
        let mut add = |section: &str, found: Vec<FieldError>| {
            let at = |(name, message)| (format!("{section}.{name}"), message);
            faults.extend(found.into_iter().map(at));
        };
        add("licences", check_licences(&raw.licences, &keys));
        let (mut particulars, unread) = raw.particulars.resolve_all(&keys);
        add("particulars.values", unread);
        add("actuators", actuator::find_faults(&raw.actuators, &keys));
        actuator::add_particulars(&mut particulars, &raw.actuators);
        add("particulars.values", particulars::find_faults(&particulars));
        // A faulty section is replaced by an empty one, so that the other checks continue.
        let quoted_vectors = read_quoted_vectors(&raw, &keys).unwrap_or_else(|fault| {
            add("quoted_vectors", vec![fault]);
            BTreeMap::new()
        });
        for (index, model) in raw.models.iter().enumerate() {
            let found = check_model(model, raw.models.iter().take(index));
            add("models", found.err().into_iter().collect());
        }
        for (index, trials) in raw.free_running.iter().enumerate() {
            let found = trials.check_figures(&keys);
            add(&format!("free_running.{index}"), found.err().into_iter().collect());
        }
        let at = |(field, message): &FieldError| blame.field_error(field, message);
        match FileError::from_faults(faults.iter().map(at)) {
            Some(error) => Err(error),
            None => Ok(Self { file: raw, particulars, quoted_vectors }),
        }
    }

    /// Name in the zoo.
    pub fn name(&self) -> &str {
        &self.file.name
    }

    /// Particular, stated or derived, in SI units.
    pub fn particular(&self, name: &str) -> Option<f64> {
        particulars::particular_value(&self.particulars, name)
    }

    /// Keys of its sources.
    pub fn source_keys(&self) -> Vec<&str> {
        self.file.sources.keys().map(String::as_str).collect()
    }
}

type FieldError = (String, String);

/// Longest name of a licence, bytes; anything longer is a text.
const MAX_LICENCE_LENGTH: usize = 80;

/// Faults of the names and the scale.
fn check_header(raw: &VesselFile) -> Vec<FieldError> {
    let slug =
        |field: &str, name: &str| Some((field.to_owned(), check_slug(name).err()?.to_string()));
    let is_scale = raw.scale.is_none_or(|scale| (1.0..=1000.0).contains(&scale));
    let scale = (!is_scale).then(|| {
        let message = "is full-scale length over model length, from 1 to 1000";
        ("scale".to_owned(), message.to_owned())
    });
    let slugs = [slug("name", &raw.name), slug("category", &raw.category)];
    slugs.into_iter().chain([scale]).flatten().collect()
}

fn check_licences(licences: &BTreeMap<String, String>, sources: &[&str]) -> Vec<FieldError> {
    let one = |(key, licence): (&String, &String)| {
        let message = if !sources.contains(&key.as_str()) {
            format!("`{key}` is not listed under `sources`")
        } else if licence.trim().is_empty() || licence.len() > MAX_LICENCE_LENGTH {
            format!("name the licence in 1 to {MAX_LICENCE_LENGTH} bytes, or say `none stated`")
        } else {
            return None;
        };
        Some((key.clone(), message))
    };
    licences.iter().filter_map(one).collect()
}

fn read_quoted_vectors(
    raw: &VesselFile,
    keys: &[&str],
) -> Result<BTreeMap<String, BTreeMap<String, f64>>, FieldError> {
    let one = |(name, vector): (&String, &QuotedVectorFile)| {
        let section =
            Section { source: Some(vector.source.clone()), values: vector.values.clone() };
        let values: BTreeMap<String, Quantity> = section.resolve_values(keys)?;
        Ok((
            name.clone(),
            values.into_iter().map(|(name, quantity)| (name, quantity.value)).collect(),
        ))
    };
    raw.quoted_vectors.iter().map(one).collect()
}

fn check_model<'a>(
    model: &PublishedModelFile,
    mut earlier: impl Iterator<Item = &'a PublishedModelFile>,
) -> Result<(), FieldError> {
    let blame = |field: &str, message: &str| Err((field.to_owned(), message.to_owned()));
    if let Err(invalid) = check_slug(&model.name) {
        return Err(("name".into(), invalid.to_string()));
    }
    if earlier.any(|other| other.name == model.name) {
        return Err((
            model.name.clone(),
            "two models of one ship must have different names".into(),
        ));
    }
    let gear = &model.steering;
    if !(gear.limit_deg > 0.0 && gear.limit_deg <= 90.0) {
        return blame("steering.limit_deg", "must be above 0 and at most 90 deg");
    }
    if !(gear.rate_deg_s > 0.0
        && gear.rate_deg_s.is_finite()
        && gear.time_constant_s >= 0.0
        && gear.time_constant_s.is_finite())
    {
        return blame(
            "steering.rate_deg_s",
            "the rate must be above 0 deg/s and the time constant not below 0 s",
        );
    }
    if model.speed_m_s.is_some_and(|speed| !(speed > 0.0 && speed < 50.0)) {
        return blame("speed_m_s", "must be above 0 and below 50 m/s");
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::{Vessel, check_licences};

    /// The lines of a refusal, without the file's name.
    fn refused(text: &str) -> Vec<String> {
        let error = Vessel::parse("v", text).unwrap_err().to_string();
        error.lines().map(|line| line.trim_start_matches("v:").to_owned()).collect()
    }

    #[test]
    fn everything_that_is_missing_or_unknown_is_told() {
        let told = refused("kind: vessel\nname: [a]\nparticulars:\n  lpp_m: 100\n");
        let all = told.join("\n");
        assert_eq!(told.len(), 4, "{all}");
        for part in [
            "2: name: is a list, but should be text",
            "4: particulars.lpp_m: is not a field; the fields are source, values",
            "title: is missing",
            "category: is missing",
        ] {
            assert!(all.contains(part), "{part} in {all}");
        }
    }

    #[test]
    fn every_value_that_is_wrong_is_told() {
        let told = refused(
            "kind: vessel\nname: a\ntitle: A\ncategory: tanker!\nsources: { s: { citation: C } }\n\
             particulars:\n  source: s\n  values:\n    lpp_m: -100\n    lenght_m: 3\n    \
             beam_m: { value: 20, source: t }\n",
        );
        let all = told.join("\n");
        for field in ["category", "lpp_m", "lenght_m", "beam_m"] {
            assert!(told.iter().any(|line| line.contains(field)), "{field} in {all}");
        }
    }

    #[test]
    fn a_licence_is_of_a_listed_source_and_a_name() {
        let of = |key: &str, licence: &str| {
            let licences = [(key.to_owned(), licence.to_owned())].into();
            check_licences(&licences, &["a"])
                .into_iter()
                .map(|(field, _)| field)
                .collect::<Vec<_>>()
        };
        assert!(of("a", "MIT").is_empty());
        assert_eq!(of("b", "MIT"), ["b"]);
        assert_eq!(of("a", " "), ["a"]);
        assert_eq!(of("a", &"MIT".repeat(40)), ["a"]);
    }
}
