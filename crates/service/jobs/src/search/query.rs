//! What is asked of ships, and how it is written.

use std::sync::LazyLock;

use regex::Regex;
use sistership_model::particulars;
use sistership_priors::similarity::Definition;
use sistership_store::{FactRange, ShipSearch};

use super::metrics::names;

/// What is asked of ships; everything must hold.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Search {
    /// Category, tag and ranges; the first range orders what is found.
    pub ships: ShipSearch,
    /// Similarity to this ship orders what is found, and only ships of its category are.
    pub similar_to: Option<String>,
    /// The definition of the vector by which ships are similar.
    pub vector: Option<Definition>,
}

/// A fault of a range: what would be right.
pub type RangeFault = String;

/// Reads `lpp_m:100..200`, in SI; either end may be left out.
///
/// # Errors
/// Says what would be right, with the names that there are.
pub fn particular(text: &str) -> Result<FactRange, RangeFault> {
    range(text, "particular", &particulars::names().collect::<Vec<_>>())
}

/// Reads `turn_35.tactical_diameter_m:..900`.
///
/// # Errors
/// As [`particular`].
pub fn metric(text: &str) -> Result<FactRange, RangeFault> {
    range(text, "metric", &names().collect::<Vec<_>>())
}

/// The names of particulars by which ships are found.
pub fn particulars() -> impl Iterator<Item = &'static str> {
    particulars::names()
}

/// The names of metrics by which ships are found.
pub fn metrics() -> impl Iterator<Item = &'static str> {
    names()
}

/// An end of a range.
const END: &str = r"[+-]?[0-9]{1,15}(\.[0-9]{1,15})?(e[+-]?[0-9]{1,2})?";
static ENDS: LazyLock<Option<Regex>> =
    LazyLock::new(|| Regex::new(&format!(r"^({END})?\.\.({END})?$")).ok());

/// What a range of one of these names looks like, as a regular expression.
pub fn pattern(names: impl Iterator<Item = &'static str>) -> String {
    let names = names.collect::<Vec<_>>().join("|").replace('.', "\\.");
    format!(r"^({names}):({END})?\.\.({END})?$")
}

fn range(text: &str, kind: &str, known: &[&str]) -> Result<FactRange, RangeFault> {
    let form = || {
        format!(
            "write {}:MIN..MAX, with either end left out where it is open, not `{text}`",
            known.first().unwrap_or(&"")
        )
    };
    let (name, ends) = text.split_once(':').ok_or_else(form)?;
    if !known.contains(&name) {
        return Err(format!("there is no {kind} `{name}`; there are {}", known.join(", ")));
    }
    let (min, max) = ends
        .split_once("..")
        .filter(|_| ENDS.as_ref().is_some_and(|form| form.is_match(ends)))
        .ok_or_else(form)?;
    let end = |text: &str, open: f64| match text {
        "" => Ok(open),
        number => number.parse().ok().filter(|number: &f64| number.is_finite()).ok_or_else(form),
    };
    let (min, max) = (end(min, f64::MIN)?, end(max, f64::MAX)?);
    match min <= max {
        true => Ok(FactRange { fact: fact(kind, name), min, max }),
        false => Err(format!("`{text}` holds nothing: {min} is above {max}")),
    }
}

/// The name under which the store keeps a particular or a metric.
pub(super) fn fact(kind: &str, name: &str) -> String {
    format!("{kind} {name}")
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn ranges_are_read_or_refused_with_what_would_be_right() {
        let read = particular("lpp_m:100..200.5").unwrap();
        assert_eq!((read.fact.as_str(), read.min, read.max), ("particular lpp_m", 100.0, 200.5));
        assert_eq!(particular("x_g_m:-3..").unwrap().max, f64::MAX);
        assert_eq!(metric("turn_35.tactical_diameter_m:..900").unwrap().min, f64::MIN);
        assert!(
            particular("length_m:1..2")
                .unwrap_err()
                .contains("there is no particular `length_m`; there are lpp_m, ")
        );
        assert!(metric("lpp_m:1..2").unwrap_err().contains("turn_35.advance_m"));
        assert!(particular("lpp_m:2..1").unwrap_err().contains("2 is above 1"));
        for wrong in ["lpp_m", "lpp_m:", "lpp_m:1", "lpp_m:a..b", "lpp_m:NaN..1", "lpp_m:..inf"] {
            assert!(particular(wrong).unwrap_err().contains("lpp_m:MIN..MAX"), "{wrong}");
        }
    }
}
