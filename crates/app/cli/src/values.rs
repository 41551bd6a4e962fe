//! Parsers of values of the command line.

use std::net::SocketAddr;
use std::time::Duration;

use clap::ValueEnum;
use sistership_export::{FORMATS, ModelFormat, by_name};
use sistership_identification::refine::{EstimationMethod, Prior};
use sistership_model_selection::Preference;
use sistership_priors::similarity::VectorDefinition;
use sistership_simulation::Method as Integrator;

/// Error of a value.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ValueError {
    /// No number at all.
    #[error("`{0}` is not a number")]
    NotANumber(String),
    /// Infinite, or not a number by IEEE 754.
    #[error("`{0}` is not a finite number")]
    NotFinite(String),
    /// Zero or less.
    #[error("must be above 0, not {0}")]
    NotPositive(f64),
    /// Less than zero.
    #[error("must be 0 or above, not {0}")]
    Negative(f64),
    /// No rudder angle, deg.
    #[error(
        "must be a rudder angle from -90 to 90 deg other than 0 (positive turns to starboard), not \
         {0}"
    )]
    NoRudderAngle(f64),
    /// One figure where a zigzag has two.
    #[error("write rudder angle and change of heading as `20/20`")]
    NoZigzag,
    /// Error of the rudder angle of a zigzag.
    #[error("rudder: {0}")]
    Rudder(Box<ValueError>),
    /// Error of the change of heading of a zigzag.
    #[error("change of heading: {0}")]
    ChangeOfHeading(Box<ValueError>),
    /// More than half a turn, deg.
    #[error("must be at most 180 deg, not {0}")]
    BeyondHalfATurn(f64),
    /// A name that is not among the known ones.
    #[error("choose one of {known}")]
    UnknownName {
        /// The known names.
        known: String,
    },
    /// No name with a number.
    #[error("write an effect and its odds, such as `wind=2`")]
    NoOdds,
    /// No version of a ship's model.
    #[error("write ship and number, such as `sr108/2`")]
    NoVersion,
    /// No address to listen on.
    #[error("write an address and a port, such as 127.0.0.1:8080 or [::1]:8080")]
    NoAddress,
    /// No number of hours.
    #[error("`{0}` is not a number of hours")]
    NotHours(String),
    /// More than a million hours, or less than none, h.
    #[error("must be from 0 to 1000000 h, not {0}")]
    HoursOutOfRange(f64),
}

/// Integration methods.
#[derive(Debug, Clone, Copy, Default, ValueEnum)]
pub enum IntegrationMethod {
    /// Classical Runge-Kutta of fourth order.
    #[default]
    Rk4,
    /// Explicit Euler.
    Euler,
}

impl From<IntegrationMethod> for Integrator {
    fn from(method: IntegrationMethod) -> Self {
        match method {
            IntegrationMethod::Rk4 => Self::Rk4,
            IntegrationMethod::Euler => Self::Euler,
        }
    }
}

/// Parses a finite number above zero.
pub fn positive(text: &str) -> Result<f64, ValueError> {
    match number(text)? {
        value if value > 0.0 => Ok(value),
        value => Err(ValueError::NotPositive(value)),
    }
}

/// Parses a finite number, zero or above.
pub fn not_negative(text: &str) -> Result<f64, ValueError> {
    match number(text)? {
        value if value >= 0.0 => Ok(value),
        value => Err(ValueError::Negative(value)),
    }
}

/// Parses an effect and its prior odds: `wind=2`.
pub fn odds(text: &str) -> Result<(String, f64), ValueError> {
    let (name, odds) = text.split_once('=').ok_or(ValueError::NoOdds)?;
    Ok((name.to_owned(), positive(odds)?))
}

/// Parses a rudder angle in degrees other than zero.
pub fn rudder_deg(text: &str) -> Result<f64, ValueError> {
    match number(text)? {
        value if value != 0.0 && value.abs() <= 90.0 => Ok(value),
        value => Err(ValueError::NoRudderAngle(value)),
    }
}

/// Parses `DEG/DEG`: rudder angle and change of heading.
pub fn zigzag_deg(text: &str) -> Result<(f64, f64), ValueError> {
    // The sign of the rudder angle gives the side of the first execute.
    let (rudder, switch) = text.split_once('/').ok_or(ValueError::NoZigzag)?;
    let switch =
        change_of_heading(switch).map_err(|error| ValueError::ChangeOfHeading(error.into()))?;
    Ok((rudder_deg(rudder).map_err(|error| ValueError::Rudder(error.into()))?, switch))
}

fn change_of_heading(text: &str) -> Result<f64, ValueError> {
    match positive(text)? {
        value if value > 180.0 => Err(ValueError::BeyondHalfATurn(value)),
        value => Ok(value),
    }
}

/// Parses a finite number.
pub fn number(text: &str) -> Result<f64, ValueError> {
    let value: f64 = text.trim().parse().map_err(|_| ValueError::NotANumber(text.to_owned()))?;
    if value.is_finite() { Ok(value) } else { Err(ValueError::NotFinite(text.to_owned())) }
}

/// Returns the estimator with this name.
pub fn method(name: &str) -> Result<EstimationMethod, ValueError> {
    let known = || EstimationMethod::ALL.map(|method| format!("`{}`", method.name())).join(", ");
    EstimationMethod::by_name(name).ok_or_else(|| ValueError::UnknownName { known: known() })
}

/// Returns the prior with this name.
pub fn prior(name: &str) -> Result<Prior, ValueError> {
    let known = Prior::ALL.map(|prior| format!("`{}`", prior.name())).join(", ");
    Prior::by_name(name).ok_or(ValueError::UnknownName { known })
}

/// Returns the preference of a model selection with this name.
pub fn preference(name: &str) -> Result<Preference, ValueError> {
    let known = Preference::ALL.map(|preference| format!("`{}`", preference.name())).join(" and ");
    Preference::by_name(name).ok_or(ValueError::UnknownName { known })
}

/// Returns the definition of the characteristic vector with this name.
pub fn definition(name: &str) -> Result<VectorDefinition, ValueError> {
    let known: Vec<&str> = VectorDefinition::ALL.into_iter().map(VectorDefinition::name).collect();
    VectorDefinition::by_name(name)
        .ok_or_else(|| ValueError::UnknownName { known: known.join(" and ") })
}

/// Format of an export.
#[derive(Debug, Clone, Copy)]
pub enum ExportFormat {
    /// A model for another tool.
    Model(&'static dyn ModelFormat),
    /// A ship for another store.
    Bundle,
}

/// Returns the format of an export with this name.
pub fn export_format(name: &str) -> Result<ExportFormat, ValueError> {
    // A bundle is no format of a model, but is requested by the same flag.
    let known = || FORMATS.map(|format| format!("`{}`, ", format.name())).concat() + "`bundle`";
    match (name, by_name(name)) {
        ("bundle", _) => Ok(ExportFormat::Bundle),
        (_, Some(format)) => Ok(ExportFormat::Model(format)),
        (_, None) => Err(ValueError::UnknownName { known: known() }),
    }
}

/// Parses `SHIP/NUMBER`: a version of a ship's model.
pub fn version(text: &str) -> Result<(String, i64), ValueError> {
    // From the right: names of ships may contain no `/`, but the number is always last.
    let parts = text
        .rsplit_once('/')
        .and_then(|(ship, number)| Some((ship.to_owned(), number.parse().ok()?)));
    parts.filter(|(ship, number)| !ship.is_empty() && *number > 0).ok_or(ValueError::NoVersion)
}

/// Parses the address to listen on.
pub fn address(text: &str) -> Result<SocketAddr, ValueError> {
    text.parse().map_err(|_| ValueError::NoAddress)
}

/// Parses a number of hours.
pub fn hours(text: &str) -> Result<Duration, ValueError> {
    let hours: f64 = text.parse().map_err(|_| ValueError::NotHours(text.to_owned()))?;
    match (0.0..=1e6).contains(&hours) {
        true => Ok(Duration::from_secs_f64(hours * 3600.0)),
        false => Err(ValueError::HoursOutOfRange(hours)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zigzags_are_read_or_refused_with_the_reason() {
        assert_eq!(zigzag_deg("10/5"), Ok((10.0, 5.0)));
        assert_eq!(zigzag_deg("-20/20"), Ok((-20.0, 20.0)));
        for (text, part) in [
            ("20", "20/20"),
            ("0/10", "other than 0"),
            ("10/0", "above 0"),
            ("10/x", "`x`"),
            ("10/200", "180"),
        ] {
            assert!(zigzag_deg(text).is_err_and(|e| e.to_string().contains(part)), "{text}");
        }
    }

    #[test]
    fn numbers_are_finite() {
        assert_eq!(positive("1.5"), Ok(1.5));
        assert!(
            positive("inf").is_err()
                && positive("-1").is_err()
                && positive("NaN").is_err()
                && rudder_deg("91").is_err()
        );
    }

    #[test]
    fn versions_are_read() {
        assert_eq!(version("sr108/2"), Ok(("sr108".to_owned(), 2)));
        for wrong in ["sr108", "sr108/x", "/2", "sr108/0", "sr108/-1"] {
            assert!(version(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn definitions_have_names() {
        assert_eq!(definition("mei-2019"), Ok(VectorDefinition::Mei2019));
        assert!(definition("mei").is_err_and(|error| error.to_string().contains("kanazawa-2023")));
    }

    #[test]
    fn hours_are_read_or_refused() {
        assert_eq!(hours("0.5"), Ok(Duration::from_secs(1800)));
        assert!(hours("-1").is_err() && hours("NaN").is_err());
        assert!(hours("a day").is_err_and(|error| error.to_string().contains("a day")));
    }
}
