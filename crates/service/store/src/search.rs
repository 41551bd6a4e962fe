//! Search of ships by category, tag and ranges of facts.
//!
//! Each statement starts at the index of its order, and tests the other conditions row by row: the
//! cost of a page does not depend on the number of ships, as long as most rows that it passes
//! fulfil the conditions. If only few ships meet one of the other conditions, those are selected
//! first and sorted.

use crate::arguments::{Arg, StatementArgs, args, names_list};
use crate::checks;
use crate::error::{Result, StoreError};
use crate::page::{ListPage, PageRequest};
use crate::record::{RowCount, record};
use crate::ships::ShipRepository;
use crate::statements::{Statement, pair, same, statements};

/// Maximum number of ranges of one search.
pub const MAX_RANGES: usize = 4;
/// Number of ships up to which a condition counts as selective: reading all of them costs no more
/// than the rows that a page may pass over.
const FEW: i64 = 2000;

/// One search statement with the conditions `$1` (category), `$2` (tag), `$3` to `$14` (four times
/// fact, minimum, maximum), each of which is skipped if NULL.
macro_rules! search {
    ($columns:literal, $from:literal, $order:literal) => {
        search!("", $columns, $from, $order)
    };
    ($with:expr, $columns:literal, $from:literal, $order:literal) => {
        same(concat!(
            $with,
            "SELECT s.name, s.title, s.category, s.revision, s.created_us, s.updated_us, ",
            $columns,
            " FROM ",
            $from,
            " AND s.deleted_us IS NULL AND (CAST($1 AS TEXT) IS NULL OR s.category = $1) \
            AND (CAST($2 AS TEXT) IS NULL OR EXISTS (SELECT 1 FROM ship_tags h WHERE h.ship = \
            s.name AND h.tag = $2)) AND (CAST($3 AS TEXT) IS NULL OR EXISTS (SELECT 1 FROM \
                ship_facts a WHERE a.ship = s.name AND a.fact = $3 AND a.value BETWEEN $4 AND $5)) \
            AND (CAST($6 AS TEXT) IS NULL OR EXISTS (SELECT 1 FROM ship_facts b \
                WHERE b.ship = s.name AND b.fact = $6 AND b.value BETWEEN $7 AND $8)) \
            AND (CAST($9 AS TEXT) IS NULL OR EXISTS (SELECT 1 FROM ship_facts c \
                WHERE c.ship = s.name AND c.fact = $9 AND c.value BETWEEN $10 AND $11)) \
            AND (CAST($12 AS TEXT) IS NULL OR EXISTS (SELECT 1 FROM ship_facts d \
                WHERE d.ship = s.name AND d.fact = $12 AND d.value BETWEEN $13 AND $14)) ",
            $order
        ))
    };
}

/// Search among few preselected ships, ordered by the value of the first range. The preselection is
/// materialised, so that no planner starts elsewhere.
macro_rules! of_few {
    ($few:literal) => {
        search!(
            concat!("WITH few AS MATERIALIZED (", $few, ") "),
            "f.value AS value",
            "few CROSS JOIN ship_facts f CROSS JOIN ships s WHERE f.ship = few.ship AND f.fact = \
            $3 AND s.name = few.ship AND (f.value, f.ship) > (CAST($17 AS DOUBLE PRECISION), $15)",
            "ORDER BY f.value, f.ship LIMIT $16"
        )
    };
}

statements! {
    // The first four statements differ in the index that gives their order: of names, of names in a
    // category, of names with a tag, of values of the first range.
    BY_NAME = search!("CAST(NULL AS DOUBLE PRECISION) AS value", "ships s WHERE s.name > $15", "ORDER BY s.name LIMIT $16");
    BY_CATEGORY = search!("CAST(NULL AS DOUBLE PRECISION) AS value", "ships s WHERE s.category = \
        $1 AND s.name > $15",
        "ORDER BY s.name LIMIT $16");
    BY_TAG = search!("CAST(NULL AS DOUBLE PRECISION) AS value",
        "ship_tags t JOIN ships s ON s.name = t.ship WHERE t.tag = $2 AND t.ship > $15", "ORDER BY t.ship LIMIT $16");
    BY_VALUE = search!("f.value AS value", "ship_facts f JOIN ships s ON s.name = f.ship WHERE \
        f.fact = $3 AND f.value <= $5 AND (f.value, f.ship) > (CAST($17 AS DOUBLE PRECISION), $15)", "ORDER BY f.value, f.ship LIMIT $16");
    // The next three start with the ships that meet a selective condition, and sort them.
    OF_TAG = of_few!("SELECT t.ship FROM ship_tags t WHERE t.tag = $2");
    OF_CATEGORY = of_few!("SELECT c.name AS ship FROM ships c WHERE c.category = $1");
    OF_RANGE = of_few!("SELECT r.ship FROM ship_facts r WHERE r.fact = $18 AND r.value BETWEEN $19 \
        AND $20");
    // A row exists at this offset if more than so many ships meet the condition.
    MORE_OF_TAG = same("SELECT CAST(1 AS BIGINT) AS rows FROM ship_tags WHERE tag = $1 LIMIT 1 \
        OFFSET $2");
    MORE_OF_CATEGORY = same("SELECT CAST(1 AS BIGINT) AS rows FROM ships WHERE category = $1 LIMIT \
        1 OFFSET $2");
    MORE_OF_RANGE = same("SELECT CAST(1 AS BIGINT) AS rows FROM ship_facts WHERE fact = $1 AND \
        value BETWEEN $2 AND $3 LIMIT 1 OFFSET $4");
    // All vectors of a category, in no order, for a comparison in memory.
    VECTORS = search!("CAST(NULL AS DOUBLE PRECISION) AS value, v.vectors",
        "ship_vectors v JOIN ships s ON s.name = v.ship WHERE v.category = $1", "");
    COUNT_OF_RANGE = same("SELECT CAST(COUNT(*) AS BIGINT) AS rows FROM ship_facts WHERE fact = $1 \
        AND value BETWEEN $2 AND $3");
    STATE = same("SELECT CAST(COUNT(*) AS BIGINT) AS ships, CAST(COALESCE(SUM(stamp), 0) AS \
        BIGINT) AS stamps FROM ship_vectors WHERE category = $1");
    // The next distinct category after `$1`, by one step in the index.
    NEXT_CATEGORY = same("SELECT category FROM ship_vectors WHERE category > $1 ORDER BY category \
        LIMIT 1");
    // The limit keeps PostgreSQL from joining all ships.
    NAMED = pair(
        "SELECT s.name, s.title, s.category, s.revision, s.created_us, s.updated_us, \
        CAST(NULL AS DOUBLE PRECISION) AS value FROM json_each($1) n CROSS JOIN ships s \
        WHERE s.name = n.value AND s.deleted_us IS NULL",
        "SELECT s.name, s.title, s.category, s.revision, s.created_us, s.updated_us, \
        CAST(NULL AS DOUBLE PRECISION) AS value \
        FROM json_array_elements_text(CAST($1 AS JSON)) AS n(value) CROSS JOIN LATERAL \
        (SELECT o.* FROM ships o WHERE o.name = n.value AND o.deleted_us IS NULL LIMIT 1) s"
    );
}

record! {
    /// A ship as a search result.
    pub struct FoundShip {
        /// Its name.
        pub name: String,
        /// Display title.
        pub title: String,
        /// Its kind.
        pub category: String,
        /// 1 when created, one more with each update.
        pub revision: i64,
        /// When it was created.
        pub created_us: i64,
        /// When the present revision was made.
        pub updated_us: i64,
        /// Value of the fact of the first range, if there is a range.
        pub value: Option<f64>,
    }
}

record! {
    /// A ship with the vectors of its similarity.
    pub struct ShipVectors {
        flatten head: FoundShip,
        /// Vectors as [`crate::SearchIndex`] has stored them, JSON.
        pub vectors: String,
    }
}

record! {
    /// Fingerprint of the vectors of a category; changes when one of them does.
    pub struct VectorsState {
        /// Number of ships.
        pub ships: i64,
        /// Sum of the stamps of their vectors.
        pub stamps: i64,
    }
}

record! {
    /// A category that has ships with vectors.
    pub struct CategoryRow {
        /// Its name.
        pub category: String,
    }
}

/// Conditions of a search, all of which must hold.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ShipSearch {
    /// Its category.
    pub category: Option<String>,
    /// A tag that it has.
    pub tag: Option<String>,
    /// Ranges of facts, at most [`MAX_RANGES`]. The first one orders the results.
    pub ranges: Vec<FactRange>,
}

/// Range of a fact, limits included.
#[derive(Debug, Clone, PartialEq)]
pub struct FactRange {
    /// The fact's name.
    pub fact: String,
    /// Lower limit.
    pub min: f64,
    /// Upper limit.
    pub max: f64,
}

/// Cursor of a list of ships: the value of the fact of the first range, if there is one, and the
/// name.
pub type ShipKey = (Option<f64>, String);

/// A condition in addition to the range that orders.
#[derive(Clone, Copy)]
enum FurtherCondition<'a> {
    Tag(&'a str),
    Category(&'a str),
    Range(&'a FactRange),
}

impl FurtherCondition<'_> {
    /// Returns the statement that starts with the ships that meet the condition.
    fn selective_statement(self) -> Statement {
        match self {
            Self::Tag(_) => OF_TAG,
            Self::Category(_) => OF_CATEGORY,
            Self::Range(_) => OF_RANGE,
        }
    }
}

impl ShipSearch {
    fn further_conditions(&self) -> impl Iterator<Item = FurtherCondition<'_>> {
        let ranges = self.ranges.iter().skip(1).map(FurtherCondition::Range);
        self.tag
            .as_deref()
            .map(FurtherCondition::Tag)
            .into_iter()
            .chain(self.category.as_deref().map(FurtherCondition::Category))
            .chain(ranges)
    }

    /// Returns the statement whose index has the order of the results: of the first range, if there
    /// is one, else of the names.
    fn ordered_statement(&self) -> Statement {
        match self {
            Self { ranges, .. } if !ranges.is_empty() => BY_VALUE,
            Self { tag: Some(_), .. } => BY_TAG,
            Self { category: Some(_), .. } => BY_CATEGORY,
            _ => BY_NAME,
        }
    }

    fn check_ranges(&self) -> Result<()> {
        if self.ranges.len() > MAX_RANGES {
            return Err(StoreError::invalid(
                "ranges",
                format!("at most {MAX_RANGES} ranges can be given at once"),
            ));
        }
        for range in &self.ranges {
            checks::check_finite("min", range.min)?;
            checks::check_finite("max", range.max)?;
        }
        Ok(())
    }

    /// Returns the arguments of the conditions, followed by `others`.
    fn statement_values<'a>(&'a self, others: StatementArgs<'a>) -> Vec<(&'static str, Arg<'a>)> {
        let mut values: Vec<(&'static str, Arg<'a>)> =
            args![category: &self.category, tag: &self.tag].to_vec();
        // Absent ranges: the fact is NULL, and the limits are not used.
        for index in 0..MAX_RANGES {
            let range = self.ranges.get(index);
            let (min, max) = range.map_or((0.0, 0.0), |range| (range.min, range.max));
            values.extend_from_slice(
                args![fact: range.map(|range| &*range.fact), min: min, max: max],
            );
        }
        values.extend_from_slice(others);
        values
    }
}

impl ShipRepository<'_> {
    /// Returns the ships that meet the conditions, ordered by the fact of the first range, if there
    /// is one, else by name.
    pub async fn search_ships(
        &self,
        search: &ShipSearch,
        page: &PageRequest<ShipKey>,
    ) -> Result<ListPage<FoundShip, ShipKey>> {
        search.check_ranges()?;
        // The default cursor, an empty name, sorts before every ship.
        let (value, name) = page.after.clone().unwrap_or_default();
        let (limit, database) = (page.fetch_limit()?, self.0.database());
        let found = match search.ranges.first() {
            Some(first) => {
                // The pair (value, name) of the last row continues the order within equal values.
                let from = value.unwrap_or(first.min);
                let few = self.selective_condition(search).await?;
                let others = args![after: &name, limit: limit, from: from];
                let mut values = search.statement_values(others);
                if let Some(FurtherCondition::Range(FactRange { fact, min, max })) = few {
                    values.extend_from_slice(args![fact: fact, min: *min, max: *max]);
                }
                database
                    .fetch_all(
                        few.map_or(
                            search.ordered_statement(),
                            FurtherCondition::selective_statement,
                        ),
                        &values,
                    )
                    .await?
            }
            None => {
                database
                    .fetch_all(
                        search.ordered_statement(),
                        &search.statement_values(args![after: &name, limit: limit]),
                    )
                    .await?
            }
        };
        Ok(page.build_page(found, |ship: &FoundShip| (ship.value, ship.name.clone())))
    }

    /// Returns the first condition that few ships meet, if there is one.
    async fn selective_condition<'a>(
        &self,
        search: &'a ShipSearch,
    ) -> Result<Option<FurtherCondition<'a>>> {
        for condition in search.further_conditions() {
            if self.check_selectivity(condition).await?.is_none() {
                return Ok(Some(condition));
            }
        }
        Ok(None)
    }

    /// Returns a row if the condition is not selective: more than a fixed number of ships meet it.
    async fn check_selectivity(&self, condition: FurtherCondition<'_>) -> Result<Option<RowCount>> {
        let database = self.0.database();
        match condition {
            FurtherCondition::Tag(tag) => {
                database.fetch_optional(MORE_OF_TAG, args![tag: tag, few: FEW]).await
            }
            FurtherCondition::Category(category) => {
                database.fetch_optional(MORE_OF_CATEGORY, args![category: category, few: FEW]).await
            }
            FurtherCondition::Range(FactRange { fact, min, max }) => {
                database
                    .fetch_optional(
                        MORE_OF_RANGE,
                        args![fact: fact, min: *min, max: *max, few: FEW],
                    )
                    .await
            }
        }
    }

    /// Returns the ships of these names, in no order; names without a ship are skipped.
    pub async fn find_by_names(&self, names: &[String]) -> Result<Vec<FoundShip>> {
        self.0.database().fetch_all(NAMED, args![names: &names_list(names)]).await
    }

    /// Returns the fingerprint of the vectors of a category, without reading them.
    pub async fn vectors_state(&self, category: &str) -> Result<VectorsState> {
        let state = self.0.database().fetch_optional(STATE, args![category: category]).await?;
        Ok(state.unwrap_or(VectorsState { ships: 0, stamps: 0 }))
    }

    /// Returns the number of ships in a range, from the index of facts alone.
    pub async fn count_ships(&self, range: &FactRange) -> Result<i64> {
        let FactRange { fact, min, max } = range;
        let limits = args![fact: fact, min: *min, max: *max];
        let count: Option<RowCount> =
            self.0.database().fetch_optional(COUNT_OF_RANGE, limits).await?;
        Ok(count.map_or(0, |count| count.rows))
    }

    /// Returns the categories that have ships with vectors, by name. One statement for each skips
    /// along the index, which holds every ship, while categories are few.
    pub async fn vector_categories(&self) -> Result<Vec<String>> {
        let mut all: Vec<String> = Vec::new();
        loop {
            let last = all.last().map_or("", String::as_str);
            let next = self.0.database().fetch_optional(NEXT_CATEGORY, args![last: last]).await?;
            let Some(CategoryRow { category }) = next else { return Ok(all) };
            all.push(category);
        }
    }

    /// Returns the vectors of all ships of a category that meet the conditions, in no order.
    pub async fn similarity_vectors(&self, search: &ShipSearch) -> Result<Vec<ShipVectors>> {
        search.check_ranges()?;
        if search.category.is_none() {
            return Err(StoreError::invalid(
                "category",
                "is needed: similarity is computed within one category",
            ));
        }
        self.0.database().fetch_all(VECTORS, &search.statement_values(&[])).await
    }
}
