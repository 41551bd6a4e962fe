//! The query of the fleet page.

use sistership_jobs::search::standing::Class;
use sistership_jobs::search::{self, Search};
use sistership_store::{FactRange, ShipKey, ShipSearch};

use crate::cursor::key;
use crate::error::{PageError, Result};
use crate::form::Fields;

/// Fields of the form that select ships.
const FIELDS: [&str; 10] = [
    "standing",
    "category",
    "tag",
    "particular",
    "particular_min",
    "particular_max",
    "metric",
    "metric_min",
    "metric_max",
    "similar_to",
];

/// Order of the ships.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Sort {
    /// The ship that most needs attention first.
    Worst,
    /// Alphabetical by name.
    Name,
    /// Increasing in the particular or metric of the query.
    Value,
    /// The most similar first.
    Similar,
}

/// The query as it was written.
#[derive(Debug, Clone)]
pub(super) struct FleetQuery {
    pub sort: Sort,
    fields: Fields,
}

impl FleetQuery {
    pub fn read(fields: &Fields) -> Result<Self> {
        let sort = match (fields.text("similar_to"), fields.text("sort")) {
            (Some(_), _) => Sort::Similar,
            (None, None | Some("worst")) => Sort::Worst,
            (None, Some("name")) => Sort::Name,
            (None, Some("value")) => Sort::Value,
            (None, Some(other)) => {
                let message = format!("there are worst, name and value, not `{other}`");
                return Err(PageError::invalid("sort", message));
            }
        };
        Ok(Self { sort, fields: fields.clone() })
    }

    /// Text of a field, for the form that is shown again.
    pub fn shown(&self, name: &str) -> &str {
        self.fields.text(name).unwrap_or_default()
    }

    /// Returns true if the form has more than the order.
    pub fn is_open(&self) -> bool {
        FIELDS.iter().any(|name| self.fields.text(name).is_some())
    }

    /// Returns the search of the store.
    ///
    /// # Errors
    /// Returns an error if a field is wrong, or if the order does not suit the ranges.
    pub fn search(&self) -> Result<Search> {
        let class = self.class()?;
        let own = self.ranges()?;
        // The store sorts by the first range: for the worst first that is the condition, otherwise
        // the condition comes last.
        let first = match self.sort {
            Sort::Worst => Some(class.map_or_else(Class::every, Class::range)),
            _ => None,
        };
        let last = class.filter(|_| self.sort != Sort::Worst).map(Class::range);
        let ranges: Vec<FactRange> = first.into_iter().chain(own).chain(last).collect();
        match (self.sort, ranges.is_empty()) {
            (Sort::Name, false) => Err(PageError::invalid(
                "sort",
                "by name only where neither condition, particular nor metric is chosen; sort by \
                 these, or the worst first",
            )),
            (Sort::Value, true) => Err(PageError::invalid(
                "sort",
                "by value needs a particular or a metric with a range",
            )),
            _ => Ok(self.with(ranges)),
        }
    }

    fn with(&self, ranges: Vec<FactRange>) -> Search {
        let text = |name: &str| self.fields.text(name).map(str::to_owned);
        let ships = ShipSearch { category: text("category"), tag: text("tag"), ranges };
        Search { ships, similar_to: text("similar_to"), vector: None }
    }

    fn class(&self) -> Result<Option<Class>> {
        let read = |name: &str| {
            Class::by_name(name)
                .ok_or_else(|| PageError::invalid("standing", format!("there is no `{name}`")))
        };
        self.fields.text("standing").map(read).transpose()
    }

    /// Returns the ranges of particular and metric.
    fn ranges(&self) -> Result<Vec<FactRange>> {
        let mut ranges = Vec::new();
        for (kind, read) in [
            ("particular", search::particular as fn(&str) -> Result<FactRange, String>),
            ("metric", search::metric),
        ] {
            let Some(name) = self.fields.text(kind) else { continue };
            let end = |which: &str| self.fields.text(&format!("{kind}_{which}")).unwrap_or("");
            let text = format!("{name}:{}..{}", end("min"), end("max"));
            ranges.push(read(&text).map_err(|message| PageError::invalid(kind, message))?);
        }
        Ok(ranges)
    }

    /// Returns the key after which the page begins.
    pub fn after(&self) -> Result<Option<ShipKey>> {
        if let Some(name) = self.fields.text("from").filter(|_| self.sort == Sort::Name) {
            return Ok(Some((None, before(name))));
        }
        key(self.fields.text("after"))
    }

    /// Heading of the column with the value that sorts the ships, if no other column has it.
    pub fn value_name(&self) -> Option<String> {
        match self.sort {
            Sort::Similar => Some("Correlation".to_owned()),
            Sort::Value => {
                self.fields.text("particular").or(self.fields.text("metric")).map(str::to_owned)
            }
            Sort::Worst | Sort::Name => None,
        }
    }

    /// Address of the next page.
    pub fn address(&self, after: &str) -> String {
        let own = FIELDS.into_iter().chain(["sort"]);
        let pairs =
            own.filter_map(|name| Some(format!("{name}={}", quoted(self.fields.text(name)?))));
        let pairs = pairs.chain([format!("after={after}")]).collect::<Vec<_>>();
        format!("/?{}", pairs.join("&"))
    }

    /// Name of the order in the form.
    pub fn sort_name(&self) -> &'static str {
        match self.sort {
            Sort::Worst => "worst",
            Sort::Name => "name",
            Sort::Value | Sort::Similar => "value",
        }
    }
}

/// Returns a text that sorts before all names with this prefix, and after all smaller ones.
fn before(name: &str) -> String {
    let mut text = name.to_owned();
    match text.pop() {
        // Names consist of ASCII letters, digits, dots and dashes, which all sort before `~`: no
        // name lies between.
        Some(last) if last > ' ' => {
            text.push(char::from_u32(last as u32 - 1).unwrap_or(' '));
            text + "~"
        }
        _ => String::new(),
    }
}

/// Percent-encodes a text for an address (RFC 3986).
fn quoted(text: &str) -> String {
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"-._~".contains(&byte);
    let each = text.bytes().map(|byte| match plain(byte) {
        true => char::from(byte).to_string(),
        false => format!("%{byte:02X}"),
    });
    each.collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn query(pairs: &[(&str, &str)]) -> FleetQuery {
        let pairs = pairs.iter().map(|(name, text)| ((*name).to_owned(), (*text).to_owned()));
        FleetQuery::read(&Fields::from(pairs.collect::<Vec<_>>())).unwrap()
    }

    #[test]
    fn the_worst_come_first_unless_something_else_is_asked() {
        let search = query(&[]).search().unwrap();
        assert_eq!(search.ships.ranges, [Class::every()]);
        let asked = query(&[
            ("standing", "holds"),
            ("particular", "lpp_m"),
            ("particular_min", "100"),
            ("sort", "value"),
        ]);
        let ranges = asked.search().unwrap().ships.ranges;
        assert_eq!((ranges[0].fact.as_str(), ranges[0].min), ("particular lpp_m", 100.0));
        assert_eq!(ranges[1], Class::Holds.range());
        assert_eq!(asked.value_name().as_deref(), Some("lpp_m"));
        let named = query(&[("sort", "name"), ("standing", "holds")]);
        assert!(named.search().unwrap_err().to_string().starts_with("sort: "));
        assert!(query(&[("particular", "lpp")]).search().is_err());
    }

    #[test]
    fn addresses_carry_the_query_and_names_can_be_jumped_to() {
        let asked = query(&[("tag", "a b&c"), ("sort", "name"), ("from", "kv")]);
        assert_eq!(asked.address("x"), "/?tag=a%20b%26c&sort=name&after=x");
        let (_, start) = asked.after().unwrap().unwrap();
        assert!(*"ku-9" < *start && *start < *"kv", "{start}");
    }
}
