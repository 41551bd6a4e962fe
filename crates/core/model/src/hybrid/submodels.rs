//! Published conditions: Miyauchi 2024, Algorithms 1 to 3, and the quadrants of Miyauchi 2021 (as
//! cited there).
//!
//! The first set of each algorithm, ahead with unstalled rudders, is the shared one.

use indexmap::IndexMap;

use super::actuators::side_suffixes;
use super::file::{ActuatorKind, HybridFile, Scheme, StallFile, SubmodelsFile};
use crate::law::SubmodelFile;

/// Returns the submodels of a declaration.
///
/// # Errors
/// Returns an error if the ship lacks what the scheme needs.
pub fn build_submodels(file: &HybridFile) -> Result<IndexMap<String, SubmodelFile>, String> {
    let ahead = || "u >= 0".to_owned();
    let astern = || "u < 0".to_owned();
    let listed: Vec<(&str, &str, Vec<String>)> = match &file.submodels {
        SubmodelsFile::Declared(declared) => return Ok(declared.clone()),
        SubmodelsFile::Scheme(Scheme::One) => Vec::new(),
        SubmodelsFile::Scheme(Scheme::AheadAstern) => {
            vec![("astern", "moving astern", vec![astern()])]
        }
        SubmodelsFile::Scheme(Scheme::AheadStalledAstern) => vec![
            ("stalled", "ahead, a rudder stalled", vec![ahead(), stall_condition(file, ">=")?]),
            ("astern", "moving astern", vec![astern()]),
        ],
        SubmodelsFile::Scheme(Scheme::AheadAsternStalled) => vec![
            (
                "ahead-stalled",
                "ahead, a rudder stalled",
                vec![ahead(), stall_condition(file, ">=")?],
            ),
            ("astern", "astern, no rudder stalled", vec![astern(), stall_condition(file, "<")?]),
            (
                "astern-stalled",
                "astern, a rudder stalled",
                vec![astern(), stall_condition(file, ">=")?],
            ),
        ],
        SubmodelsFile::Scheme(Scheme::Quadrants) => quadrant_conditions(&single_propeller(file)?),
    };
    let named = |(name, meaning, when): (&str, &str, Vec<String>)| {
        (
            name.to_owned(),
            SubmodelFile { when, meaning: meaning.to_owned(), shrinkage: file.shrinkage },
        )
    };
    Ok(listed.into_iter().map(named).collect())
}

fn quadrant_conditions(n: &str) -> Vec<(&'static str, &'static str, Vec<String>)> {
    let when = |u: &str, sign: &str| vec![format!("u {u} 0"), format!("{n} {sign} 0")];
    vec![
        ("crash-astern", "ahead, the propeller reversed", when(">=", "<")),
        ("backing", "astern, the propeller reversed", when("<", "<")),
        ("crash-ahead", "astern, the propeller ahead", when("<", ">=")),
    ]
}

/// Returns the input of the revolutions that distinguish the quadrants.
fn single_propeller(file: &HybridFile) -> Result<String, String> {
    let propellers: Vec<&String> = file
        .actuators
        .iter()
        .filter(|(_, a)| a.kind == ActuatorKind::Propeller && !a.pair)
        .map(|(name, _)| name)
        .collect();
    match propellers.as_slice() {
        [one] => Ok((*one).clone()),
        _ => {
            Err("`quadrants` needs one single propeller; declare the conditions by name instead"
                .into())
        }
    }
}

/// Condition of stall, `max(|delta_s| - stall_s, |delta_p| - stall_p) >= 0`: at least one rudder is
/// beyond its stall angle. The paper's Algorithms 2 and 3 print the starboard rudder in both
/// comparisons; the port one is meant in the second.
fn stall_condition(file: &HybridFile, comparison: &str) -> Result<String, String> {
    let beyond = |(name, angle): (String, f64)| format!("abs({name}) - {angle}*pi/180");
    let excess = stall_angles(file).into_iter().map(beyond).reduce(|a, b| format!("max({a}, {b})"));
    let excess = excess
        .ok_or("this scheme distinguishes rudders by their stall: give a rudder `stall_deg`")?;
    Ok(format!("{excess} {comparison} 0"))
}

/// Rudders with their stall angles, deg.
fn stall_angles(file: &HybridFile) -> Vec<(String, f64)> {
    let mut angles = Vec::new();
    for (name, actuator) in &file.actuators {
        let Some(stall) = actuator.stall_deg else { continue };
        for side in side_suffixes(actuator) {
            angles.push((format!("{name}{side}"), stall.side_angle(side)));
        }
    }
    angles
}

impl StallFile {
    /// Angle of a side, deg.
    pub(crate) fn side_angle(self, side: &str) -> f64 {
        match self {
            Self::Both(angle) => angle,
            Self::Sides { port, .. } if side == "_p" => port,
            Self::Sides { starboard, .. } => starboard,
        }
    }
}
