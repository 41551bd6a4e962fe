//! The query of the list of ships.

use std::str::FromStr;

use serde::Deserialize;
use sistership_priors::similarity::VectorDefinition;
use sistership_store::{FactRange, MAX_RANGES, PageRequest, ShipKey};
use utoipa::IntoParams;
use utoipa::openapi::RefOr;
use utoipa::openapi::schema::{ArrayBuilder, ObjectBuilder, Schema, Type};

use crate::field::{Cursor, Limit, Name, Word, one_of};
use crate::page;
use crate::problem::{Fault, Problem, Result};
use sistership_jobs::search::{self, SearchCriteria, metric, particular};

/// Query of the list of ships. All conditions must hold.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[allow(dead_code, reason = "describes the query only; its parameters may be repeated")]
pub struct ShipSearchQuery {
    /// Maximum number of items to return.
    #[param(inline)]
    limit: Option<Limit>,
    /// `next` of the page before.
    #[param(inline)]
    after: Option<Cursor>,
    /// Ships of this category only.
    #[param(inline)]
    category: Option<Name>,
    /// Ships with this tag only.
    #[param(inline)]
    tag: Option<Word>,
    /// Ranges of particulars in SI, such as `lpp_m:100..200`, `beam_m:..32`; with those of metrics
    /// at most four.
    #[param(style = Form, explode, schema_with = particulars)]
    particular: Option<Vec<String>>,
    /// Ranges of the champion's metrics, such as `turn_35.tactical_diameter_m:..900`: `turn_35.`
    /// with `advance_m`, `transfer_m`, `tactical_diameter_m`, `steady_radius_m`; `zigzag_10.` and
    /// `zigzag_20.` with `first_overshoot_deg`, `second_overshoot_deg`, `period_s`;
    /// `initial_turning_m`. The greater of both sides counts.
    #[param(style = Form, explode, schema_with = metrics)]
    metric: Option<Vec<String>>,
    /// Ships of this ship's category, the most similar first.
    #[param(inline)]
    similar_to: Option<Name>,
    /// The vector by which ships are similar: `mei-2019` or `kanazawa-2023`.
    #[param(schema_with = vectors)]
    vector: Option<VectorDefinition>,
}

/// Parses the query, parameter by parameter.
///
/// # Errors
/// Returns an error that names the invalid parameter.
pub fn parse_query(pairs: Vec<(String, String)>) -> Result<(SearchCriteria, PageRequest<ShipKey>)> {
    // Parsed by hand, because `particular` and `metric` may occur several times.
    let (mut search, mut limit, mut after) = (SearchCriteria::default(), None, None);
    for (name, value) in pairs {
        match name.as_str() {
            "limit" => set_once(&name, &mut limit, parse_value::<Limit>(&name, &value)?)?,
            "after" => set_once(&name, &mut after, parse_value::<Cursor>(&name, &value)?)?,
            "category" => set_once(
                &name,
                &mut search.ships.category,
                parse_value::<Name>(&name, &value)?.into_string(),
            )?,
            "tag" => set_once(
                &name,
                &mut search.ships.tag,
                parse_value::<Word>(&name, &value)?.into_string(),
            )?,
            "particular" => add_range(&name, &mut search.ships.ranges, particular(&value))?,
            "metric" => add_range(&name, &mut search.ships.ranges, metric(&value))?,
            "similar_to" => set_once(
                &name,
                &mut search.similar_to,
                parse_value::<Name>(&name, &value)?.into_string(),
            )?,
            "vector" => set_once(&name, &mut search.vector, parse_definition(&value)?)?,
            _ => return Err(unknown_parameter(&name)),
        }
    }
    Ok((search, page::parse_page(limit, after.as_ref())?))
}

fn parse_value<T: FromStr<Err = String>>(name: &str, value: &str) -> Result<T> {
    value.parse().map_err(|message: String| parameter_problem(name, message))
}

/// Returns the schema of the names of the vectors.
pub fn vectors() -> RefOr<Schema> {
    one_of(VectorDefinition::ALL.map(VectorDefinition::name))
}

fn particulars() -> RefOr<Schema> {
    range_schema(search::particular_names())
}

fn metrics() -> RefOr<Schema> {
    range_schema(search::searchable_metrics())
}

/// Returns the schema of ranges of facts with these names.
fn range_schema(names: impl Iterator<Item = &'static str>) -> RefOr<Schema> {
    let range = ObjectBuilder::new()
        .schema_type(Type::String)
        .pattern(Some(search::range_pattern(names)))
        .build();
    ArrayBuilder::new().items(range).min_items(Some(1)).max_items(Some(MAX_RANGES)).build().into()
}

fn set_once<T>(name: &str, slot: &mut Option<T>, value: T) -> Result<()> {
    // A repeated parameter is refused: it is unclear which value is meant.
    match slot.replace(value) {
        None => Ok(()),
        Some(_) => Err(parameter_problem(name, "may be given once only")),
    }
}

fn add_range(
    name: &str,
    ranges: &mut Vec<FactRange>,
    range: std::result::Result<FactRange, String>,
) -> Result<()> {
    ranges.push(range.map_err(|message| parameter_problem(name, message))?);
    match ranges.len() <= MAX_RANGES {
        true => Ok(()),
        false => Err(parameter_problem(
            name,
            format!("at most {MAX_RANGES} ranges can be given at once"),
        )),
    }
}

fn parse_definition(value: &str) -> Result<VectorDefinition> {
    let known = VectorDefinition::ALL.map(VectorDefinition::name).join(" and ");
    VectorDefinition::by_name(value)
        .ok_or_else(|| parameter_problem("vector", format!("choose one of {known}, not `{value}`")))
}

fn unknown_parameter(name: &str) -> Problem {
    parameter_problem(
        name,
        "is not a parameter; choose one of limit, after, category, tag, particular, metric, \
         similar_to, vector",
    )
}

/// Returns the problem of an invalid parameter.
pub fn parameter_problem(name: &str, message: impl Into<String>) -> Problem {
    let message = message.into();
    Problem::bad_request(format!("{name}: {message}")).with_fault(Fault::at_field(name, message))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn pairs(text: &str) -> Vec<(String, String)> {
        let pair = |pair: &str| {
            pair.split_once('=').map(|(name, value)| (name.to_owned(), value.to_owned()))
        };
        text.split('&').filter_map(pair).collect()
    }

    #[test]
    fn every_parameter_is_read() {
        let text = "category=tanker&tag=own&particular=lpp_m:1..2&metric=initial_turning_m:..9&similar_to=kcs&vector=mei-2019&limit=7";
        let (search, page) = parse_query(pairs(text)).unwrap();
        assert_eq!(
            (page.limit, search.ships.ranges.len(), search.vector),
            (7, 2, Some(VectorDefinition::Mei2019))
        );
        assert_eq!(search.ships.category.as_deref(), Some("tanker"));
        assert_eq!(
            (search.ships.tag.as_deref(), search.similar_to.as_deref()),
            (Some("own"), Some("kcs"))
        );
    }

    #[test]
    fn the_wrong_parameter_is_named() {
        let five = "particular=lpp_m:1..2&".repeat(5);
        for (text, field) in [
            ("limit=many", "limit"),
            ("after=7", "after"),
            ("tag=a&tag=b", "tag"),
            ("particular=length_m:1..2", "particular"),
            ("metric=speed", "metric"),
            (five.as_str(), "particular"),
            ("vector=other", "vector"),
            ("categorie=tanker", "categorie"),
        ] {
            let problem = parse_query(pairs(text)).unwrap_err();
            assert_eq!(
                (problem.status, problem.errors[0].field.as_deref()),
                (400, Some(field)),
                "{text}"
            );
        }
    }
}
