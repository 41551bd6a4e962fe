//! Search criteria for ships, and their text form.

use std::sync::LazyLock;

use regex::Regex;
use sistership_model::particulars;
use sistership_priors::similarity::VectorDefinition;
use sistership_store::{FactRange, ShipSearch};

use super::metrics::metric_names;

/// Search criteria for ships; all must be satisfied.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SearchCriteria {
    /// Category, tag and ranges; the first range orders the result.
    pub ships: ShipSearch,
    /// Ship whose similarity orders the result, which has only ships of its category.
    pub similar_to: Option<String>,
    /// The definition of the vector by which ships are similar.
    pub vector: Option<VectorDefinition>,
}

/// Message about an invalid range, with the correct form.
pub type RangeFault = String;

/// Parses `lpp_m:100..200`, in SI; either end may be left out.
///
/// # Errors
/// Returns the correct form, with the known names.
pub fn particular(text: &str) -> Result<FactRange, RangeFault> {
    parse_range(text, "particular", &particulars::particular_names().collect::<Vec<_>>())
}

/// Parses `turn_35.tactical_diameter_m:..900`.
///
/// # Errors
/// Same as [`particular`].
pub fn metric(text: &str) -> Result<FactRange, RangeFault> {
    parse_range(text, "metric", &metric_names().collect::<Vec<_>>())
}

/// Returns the names of particulars of a search.
pub fn particular_names() -> impl Iterator<Item = &'static str> {
    particulars::particular_names()
}

/// Returns the names of metrics of a search.
pub fn searchable_metrics() -> impl Iterator<Item = &'static str> {
    metric_names()
}

/// Regular expression of an end of a range.
const RANGE_END: &str = r"[+-]?[0-9]{1,15}(\.[0-9]{1,15})?(e[+-]?[0-9]{1,2})?";
static RANGE_REGEX: LazyLock<Option<Regex>> =
    LazyLock::new(|| Regex::new(&format!(r"^({RANGE_END})?\.\.({RANGE_END})?$")).ok());

/// Returns the regular expression of a range of one of these names.
pub fn range_pattern(names: impl Iterator<Item = &'static str>) -> String {
    let names = names.collect::<Vec<_>>().join("|").replace('.', "\\.");
    format!(r"^({names}):({RANGE_END})?\.\.({RANGE_END})?$")
}

fn parse_range(text: &str, kind: &str, known: &[&str]) -> Result<FactRange, RangeFault> {
    let form = || {
        format!(
            "write {}:MIN..MAX instead of `{text}`; either end may be omitted",
            known.first().unwrap_or(&"")
        )
    };
    let (name, ends) = text.split_once(':').ok_or_else(form)?;
    if !known.contains(&name) {
        return Err(format!("there is no {kind} `{name}`; choose one of {}", known.join(", ")));
    }
    let (min, max) = ends
        .split_once("..")
        // The same expression as in the API description, so that both accept the same text.
        .filter(|_| RANGE_REGEX.as_ref().is_some_and(|form| form.is_match(ends)))
        .ok_or_else(form)?;
    let end = |text: &str, open: f64| match text {
        "" => Ok(open),
        number => number.parse().ok().filter(|number: &f64| number.is_finite()).ok_or_else(form),
    };
    // An open end is the largest finite number, because JSON and SQL have no infinity.
    let (min, max) = (end(min, f64::MIN)?, end(max, f64::MAX)?);
    match min <= max {
        true => Ok(FactRange { fact: fact_name(kind, name), min, max }),
        false => Err(format!("`{text}` is empty: {min} is above {max}")),
    }
}

/// Returns the name of a particular or a metric in the store.
pub(super) fn fact_name(kind: &str, name: &str) -> String {
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
                .contains("there is no particular `length_m`; choose one of lpp_m, ")
        );
        assert!(metric("lpp_m:1..2").unwrap_err().contains("turn_35.advance_m"));
        assert!(particular("lpp_m:2..1").unwrap_err().contains("2 is above 1"));
        for wrong in ["lpp_m", "lpp_m:", "lpp_m:1", "lpp_m:a..b", "lpp_m:NaN..1", "lpp_m:..inf"] {
            assert!(particular(wrong).unwrap_err().contains("lpp_m:MIN..MAX"), "{wrong}");
        }
    }
}
