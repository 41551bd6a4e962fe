//! The query of the fleet page.

use sistership_jobs::search::urgency::{ShipCollection, UrgencyClass};
use sistership_jobs::search::{self, SearchCriteria};
use sistership_store::{FactRange, ShipKey, ShipSearch};

use crate::cursor::decode_cursor;
use crate::error::{PageError, Result};
use crate::form::FormFields;
use crate::language::say;

/// Fields of the form that select ships.
const FILTER_FIELDS: [&str; 11] = [
    "ships",
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
pub(super) enum SortOrder {
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
    pub sort: SortOrder,
    /// Ships of the fleet or of the library alone; without a query those of the fleet.
    pub collection: Option<ShipCollection>,
    fields: FormFields,
}

impl FleetQuery {
    pub fn from_fields(fields: &FormFields) -> Result<Self> {
        let sort = match (fields.get_text("similar_to"), fields.get_text("sort")) {
            (Some(_), _) => SortOrder::Similar,
            (None, None | Some("worst")) => SortOrder::Worst,
            (None, Some("name")) => SortOrder::Name,
            (None, Some("value")) => SortOrder::Value,
            (None, Some(other)) => {
                let message = say("search-wrong-order").with("text", other);
                return Err(PageError::invalid_field("sort", message));
            }
        };
        let collection = match fields.get_text("ships") {
            Some("library") => Some(ShipCollection::Library),
            Some("fleet") => Some(ShipCollection::Fleet),
            None if fields.is_empty() => Some(ShipCollection::Fleet),
            _ => None,
        };
        Ok(Self { sort, collection, fields: fields.clone() })
    }

    /// Value of the collection in the form.
    pub fn collection_name(&self) -> &'static str {
        match self.collection {
            Some(ShipCollection::Fleet) => "fleet",
            Some(ShipCollection::Library) => "library",
            None => "all",
        }
    }

    /// Text of a field, for the form that is shown again.
    pub fn field_text(&self, name: &str) -> &str {
        self.fields.get_text(name).unwrap_or_default()
    }

    /// Returns true if the form has more than the order.
    pub fn has_filter(&self) -> bool {
        FILTER_FIELDS[1..].iter().any(|name| self.fields.get_text(name).is_some())
    }

    /// Returns true if the page does not begin with the first ship.
    pub fn is_continued(&self) -> bool {
        self.fields.get_text("after").is_some()
    }

    /// Returns the search of the store.
    ///
    /// # Errors
    /// Returns an error if a field is wrong, or if the order does not suit the ranges.
    pub fn to_search(&self) -> Result<SearchCriteria> {
        let class = self.selected_class()?;
        let own = self.fact_ranges()?;
        // The store sorts by the first range: for the worst first that is the condition, otherwise
        // the condition comes last.
        let first = match self.sort {
            SortOrder::Worst => {
                Some(class.map_or_else(UrgencyClass::full_range, UrgencyClass::class_range))
            }
            _ => None,
        };
        let last = class.filter(|_| self.sort != SortOrder::Worst).map(UrgencyClass::class_range);
        let ranges: Vec<FactRange> = first.into_iter().chain(own).chain(last).collect();
        let by_name_of_some = self.sort == SortOrder::Name && !ranges.is_empty();
        // All ships of a collection have the same value: they are in the order of their names.
        let collection = self.collection.map(ShipCollection::fact_range);
        match (by_name_of_some, self.sort == SortOrder::Value && ranges.is_empty()) {
            (true, _) => Err(PageError::invalid_field("sort", say("search-order-by-name"))),
            (_, true) => Err(PageError::invalid_field("sort", say("search-order-by-value"))),
            _ => Ok(self.with_ranges(ranges.into_iter().chain(collection).collect())),
        }
    }

    fn with_ranges(&self, ranges: Vec<FactRange>) -> SearchCriteria {
        let text = |name: &str| self.fields.get_text(name).map(str::to_owned);
        let ships = ShipSearch { category: text("category"), tag: text("tag"), ranges };
        SearchCriteria { ships, similar_to: text("similar_to"), vector: None }
    }

    fn selected_class(&self) -> Result<Option<UrgencyClass>> {
        let read = |name: &str| {
            UrgencyClass::by_name(name).ok_or_else(|| {
                PageError::invalid_field("standing", say("search-no-class").with("name", name))
            })
        };
        self.fields.get_text("standing").map(read).transpose()
    }

    /// Returns the ranges of particular and metric.
    fn fact_ranges(&self) -> Result<Vec<FactRange>> {
        let mut ranges = Vec::new();
        for (kind, read) in [
            ("particular", search::particular as fn(&str) -> Result<FactRange, String>),
            ("metric", search::metric),
        ] {
            let Some(name) = self.fields.get_text(kind) else { continue };
            let end = |which: &str| self.fields.get_text(&format!("{kind}_{which}")).unwrap_or("");
            let text = format!("{name}:{}..{}", end("min"), end("max"));
            ranges.push(read(&text).map_err(|message| PageError::invalid_field(kind, message))?);
        }
        Ok(ranges)
    }

    /// Returns the key after which the page begins.
    pub fn start_key(&self) -> Result<Option<ShipKey>> {
        if let Some(name) = self.fields.get_text("from").filter(|_| self.sort == SortOrder::Name) {
            return Ok(Some((None, key_before(name))));
        }
        decode_cursor(self.fields.get_text("after"))
    }

    /// Heading of the column with the value that sorts the ships, if no other column has it.
    pub fn value_name(&self) -> Option<String> {
        match self.sort {
            SortOrder::Similar => Some(say("search-correlation").into()),
            SortOrder::Value => self
                .fields
                .get_text("particular")
                .or(self.fields.get_text("metric"))
                .map(str::to_owned),
            SortOrder::Worst | SortOrder::Name => None,
        }
    }

    /// Address of the next page.
    pub fn next_address(&self, after: &str) -> String {
        let collection = self.collection.map(|_| format!("ships={}", self.collection_name()));
        let own = FILTER_FIELDS[1..].iter().copied().chain(["sort"]);
        let pairs = own.filter_map(|name| {
            Some(format!("{name}={}", percent_encode(self.fields.get_text(name)?)))
        });
        let pairs = collection
            .into_iter()
            .chain(pairs)
            .chain([format!("after={after}")])
            .collect::<Vec<_>>();
        format!("/?{}", pairs.join("&"))
    }

    /// Name of the order in the form.
    pub fn sort_name(&self) -> &'static str {
        match self.sort {
            SortOrder::Worst => "worst",
            SortOrder::Name => "name",
            SortOrder::Value | SortOrder::Similar => "value",
        }
    }
}

/// Returns a text that sorts before all names with this prefix, and after all smaller ones.
fn key_before(name: &str) -> String {
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
fn percent_encode(text: &str) -> String {
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
        FleetQuery::from_fields(&FormFields::from(pairs.collect::<Vec<_>>())).unwrap()
    }

    #[test]
    fn the_worst_come_first_unless_something_else_is_asked() {
        let search = query(&[]).to_search().unwrap();
        let fleet = ShipCollection::Fleet.fact_range();
        assert_eq!(search.ships.ranges, [UrgencyClass::full_range(), fleet]);
        let asked = query(&[
            ("standing", "holds"),
            ("particular", "lpp_m"),
            ("particular_min", "100"),
            ("sort", "value"),
        ]);
        let ranges = asked.to_search().unwrap().ships.ranges;
        assert_eq!((ranges[0].fact.as_str(), ranges[0].min), ("particular lpp_m", 100.0));
        assert_eq!(ranges[1], UrgencyClass::Holds.class_range());
        assert_eq!(asked.value_name().as_deref(), Some("lpp_m"));
        let named = query(&[("sort", "name"), ("standing", "holds")]);
        assert!(named.to_search().unwrap_err().to_string().starts_with("sort: "));
        assert!(query(&[("particular", "lpp")]).to_search().is_err());
    }

    #[test]
    fn addresses_carry_the_query_and_names_can_be_jumped_to() {
        let asked = query(&[("tag", "a b&c"), ("sort", "name"), ("from", "kv")]);
        assert_eq!(asked.next_address("x"), "/?tag=a%20b%26c&sort=name&after=x");
        let (_, start) = asked.start_key().unwrap().unwrap();
        assert!(*"ku-9" < *start && *start < *"kv", "{start}");
    }
}
