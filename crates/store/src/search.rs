//! Which ships there are: by category, tag and ranges of what is known of them.
//!
//! Each way of asking starts at the index that its order follows, and tests the other conditions row by row: a page costs
//! the same however many ships there are, as long as most of what it passes is what is wanted.

use crate::arguments::{Arg, Args, args};
use crate::checks;
use crate::error::{Result, StoreError};
use crate::page::{List, Page};
use crate::record::record;
use crate::ships::Ships;
use crate::statements::{Statement, same, statements};

/// The most ranges that one search may have.
pub const MAX_RANGES: usize = 4;

/// One text: what is found, and the conditions `$1` (category), `$2` (tag), `$3` to `$14` (four times fact, least, most),
/// each of which may be absent.
macro_rules! search {
    ($columns:literal, $from:literal, $order:literal) => {
        same(concat!(
            "SELECT s.name, s.title, s.category, s.revision, s.created_us, s.updated_us, ",
            $columns,
            " FROM ",
            $from,
            " AND s.deleted_us IS NULL AND (CAST($1 AS TEXT) IS NULL OR s.category = $1) \
            AND (CAST($2 AS TEXT) IS NULL OR EXISTS (SELECT 1 FROM ship_tags h WHERE h.ship = s.name AND h.tag = $2)) \
            AND (CAST($3 AS TEXT) IS NULL OR EXISTS (SELECT 1 FROM ship_facts a \
                WHERE a.ship = s.name AND a.fact = $3 AND a.value BETWEEN $4 AND $5)) \
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

statements! {
    BY_NAME = search!("CAST(NULL AS DOUBLE PRECISION) AS value", "ships s WHERE s.name > $15", "ORDER BY s.name LIMIT $16");
    BY_CATEGORY = search!("CAST(NULL AS DOUBLE PRECISION) AS value", "ships s WHERE s.category = $1 AND s.name > $15",
        "ORDER BY s.name LIMIT $16");
    BY_TAG = search!("CAST(NULL AS DOUBLE PRECISION) AS value",
        "ship_tags t JOIN ships s ON s.name = t.ship WHERE t.tag = $2 AND t.ship > $15", "ORDER BY t.ship LIMIT $16");
    BY_VALUE = search!("f.value AS value", "ship_facts f JOIN ships s ON s.name = f.ship WHERE f.fact = $3 AND f.value <= $5 \
        AND (f.value, f.ship) > (CAST($17 AS DOUBLE PRECISION), $15)", "ORDER BY f.value, f.ship LIMIT $16");
    VECTORS = search!("CAST(NULL AS DOUBLE PRECISION) AS value, v.vectors",
        "ship_vectors v JOIN ships s ON s.name = v.ship WHERE v.category = $1", "");
}

record! {
    /// A ship that was found.
    pub struct FoundShip {
        /// Its name.
        pub name: String,
        /// What people call it.
        pub title: String,
        /// Its kind.
        pub category: String,
        /// 1 when created, one more with each update.
        pub revision: i64,
        /// When it was created.
        pub created_us: i64,
        /// When the present revision was made.
        pub updated_us: i64,
        /// The value of the first range's fact, where there is a range.
        pub value: Option<f64>,
    }
}

record! {
    /// A ship with what tells how similar she is to others.
    pub struct ShipVectors {
        flatten head: FoundShip,
        /// What [`crate::SearchIndex`] was told of her, JSON.
        pub vectors: String,
    }
}

/// What is asked of a ship; everything must hold.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ShipSearch {
    /// Her category.
    pub category: Option<String>,
    /// A tag that she has.
    pub tag: Option<String>,
    /// Where her facts must lie, at most [`MAX_RANGES`]. The first one orders what is found.
    pub ranges: Vec<FactRange>,
}

/// Where a fact must lie.
#[derive(Debug, Clone, PartialEq)]
pub struct FactRange {
    /// The fact's name.
    pub fact: String,
    /// The least that it may be.
    pub min: f64,
    /// The most that it may be.
    pub max: f64,
}

/// Where a page of ships ends: the value of the first range's fact where there is one, and the name.
pub type ShipKey = (Option<f64>, String);

impl ShipSearch {
    /// The text whose index has the order: of the first range where there is one, else of the names.
    fn statement(&self) -> Statement {
        match self {
            Self { ranges, .. } if !ranges.is_empty() => BY_VALUE,
            Self { tag: Some(_), .. } => BY_TAG,
            Self { category: Some(_), .. } => BY_CATEGORY,
            _ => BY_NAME,
        }
    }

    fn check(&self) -> Result<()> {
        if self.ranges.len() > MAX_RANGES {
            return Err(StoreError::invalid("ranges", format!("at most {MAX_RANGES} ranges can be asked for at once")));
        }
        for range in &self.ranges {
            checks::finite("min", range.min)?;
            checks::finite("max", range.max)?;
        }
        Ok(())
    }

    /// The conditions, then what a statement has beside them.
    fn values<'a>(&'a self, others: Args<'a>) -> Vec<(&'static str, Arg<'a>)> {
        let mut values: Vec<(&'static str, Arg<'a>)> = args![category: &self.category, tag: &self.tag].to_vec();
        for index in 0..MAX_RANGES {
            let range = self.ranges.get(index);
            let (min, max) = range.map_or((0.0, 0.0), |range| (range.min, range.max));
            values.extend_from_slice(args![fact: range.map(|range| &*range.fact), min: min, max: max]);
        }
        values.extend_from_slice(others);
        values
    }
}

impl Ships<'_> {
    /// Ships that a search finds, by the value of its first range's fact where it has one, else by name.
    pub async fn search(&self, search: &ShipSearch, page: &Page<ShipKey>) -> Result<List<FoundShip, ShipKey>> {
        search.check()?;
        let (value, name) = page.after.clone().unwrap_or_default();
        let limit = page.fetch()?;
        let database = self.0.database();
        let found = match search.ranges.first() {
            Some(first) => {
                let from = value.unwrap_or(first.min);
                let values = args![after: &name, limit: limit, from: from];
                database.all(search.statement(), &search.values(values)).await?
            }
            None => database.all(search.statement(), &search.values(args![after: &name, limit: limit])).await?,
        };
        Ok(page.of(found, |ship: &FoundShip| (ship.value, ship.name.clone())))
    }

    /// The vectors of every ship of a category that a search finds, in no order.
    pub async fn vectors(&self, search: &ShipSearch) -> Result<Vec<ShipVectors>> {
        search.check()?;
        if search.category.is_none() {
            return Err(StoreError::invalid("category", "is needed: ships are compared within one"));
        }
        self.0.database().all(VECTORS, &search.values(&[])).await
    }
}
