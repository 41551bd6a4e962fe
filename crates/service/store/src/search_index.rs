//! Search index of ships.
//!
//! A change of a ship puts it in a queue, in the same transaction. A process that can read the
//! documents takes it out again and writes its facts.

use sha2::{Digest as _, Sha256};

use crate::arguments::args;
use crate::checks;
use crate::database::AuditedTransaction;
use crate::error::Result;
use crate::record::record;
use crate::statements::{same, statements};
use crate::store::Store;

/// The alias whose version determines facts of a ship.
const ALIAS: &str = "champion";

statements! {
    // A later change replaces the mark; selecting from `ships` skips names without a ship.
    MARK = same("INSERT INTO search_queue (ship, mark) SELECT name, CAST($2 AS TEXT) FROM ships \
        WHERE name = $1 ON CONFLICT (ship) DO UPDATE SET mark = excluded.mark");
    WAITING = same("SELECT ship, mark FROM search_queue WHERE ship > $1 ORDER BY ship LIMIT $2");
    FACTS = same("SELECT fact, value FROM ship_facts WHERE ship = $1 ORDER BY fact");
    // Only with the mark that was read: a ship that changed again stays in the queue.
    TAKE = same("DELETE FROM search_queue WHERE ship = $1 AND mark = $2");
    FORGET = same("DELETE FROM ship_facts WHERE ship = $1");
    FACT = same("INSERT INTO ship_facts (ship, fact, value) VALUES ($1, $2, $3)");
    VECTORS = same("INSERT INTO ship_vectors (ship, category, vectors, stamp) VALUES ($1, $2, $3, \
        $4) ON CONFLICT (ship) DO UPDATE \
        SET category = excluded.category, vectors = excluded.vectors, stamp = excluded.stamp");
}

record! {
    /// A ship whose facts are out of date.
    pub struct StaleShip {
        /// The ship.
        pub ship: String,
        /// Mark of the change, different for each change.
        pub mark: String,
    }
}

record! {
    /// One fact of a ship.
    pub struct ShipFact {
        /// Name of the fact.
        pub fact: String,
        /// Its value.
        pub value: f64,
    }
}

/// Facts of a ship, to be written to the index.
#[derive(Debug, Clone, PartialEq)]
pub struct ShipFacts {
    /// The queued change that they answer.
    pub waiting: StaleShip,
    /// Its category.
    pub category: String,
    /// Facts by name, each name once.
    pub facts: Vec<(String, f64)>,
    /// Vectors of the similarity to other ships, JSON.
    pub vectors: String,
}

impl ShipFacts {
    /// Creates the entry of a ship without facts, or of a deleted one.
    pub fn without_facts(waiting: StaleShip) -> Self {
        Self { waiting, category: String::new(), facts: Vec::new(), vectors: "{}".to_owned() }
    }
}

/// Repository of the search index.
#[derive(Debug, Clone, Copy)]
pub struct SearchIndex<'a>(pub(crate) &'a Store);

impl Store {
    /// Returns the search index.
    pub fn search_index(&self) -> SearchIndex<'_> {
        SearchIndex(self)
    }
}

impl SearchIndex<'_> {
    /// Returns up to `limit` ships that have changed since their facts were written, by name, after
    /// the name `after`.
    pub async fn list_stale(&self, after: &str, limit: i64) -> Result<Vec<StaleShip>> {
        self.0.database().fetch_all(WAITING, args![after: after, limit: limit]).await
    }

    /// Returns the facts of a ship as they were last written, by name.
    pub async fn ship_facts(&self, ship: &str) -> Result<Vec<ShipFact>> {
        self.0.database().fetch_all(FACTS, args![ship: ship]).await
    }

    /// Writes the facts of ships in one transaction, and returns the number of ships. A ship that
    /// has changed again meanwhile is skipped and stays in the queue.
    pub async fn write_facts(&self, all: &[ShipFacts]) -> Result<usize> {
        let mut tx = self.0.begin().await?;
        let mut written = 0;
        for ship in all {
            checks::check_json("vectors", &ship.vectors)?;
            // No row: the ship has changed again, or was indexed by another process.
            let taken =
                tx.execute(TAKE, args![ship: &ship.waiting.ship, mark: &ship.waiting.mark]).await?;
            if taken > 0 {
                write_ship(&mut tx, ship).await?;
                written += 1;
            }
        }
        tx.commit().await?;
        Ok(written)
    }
}

async fn write_ship(tx: &mut AuditedTransaction, facts: &ShipFacts) -> Result<()> {
    let ship = &facts.waiting.ship;
    // All facts are replaced: those that no longer apply must not be found.
    tx.execute(FORGET, args![ship: ship]).await?;
    for (fact, value) in &facts.facts {
        tx.execute(FACT, args![ship: ship, fact: fact, value: *value]).await?;
    }
    let stamp = vector_stamp(ship, &facts.vectors);
    tx.execute(
        VECTORS,
        args![ship: ship, category: &facts.category, vectors: &facts.vectors, stamp: stamp],
    )
    .await
    .map(drop)
}

/// Returns a hash of the vectors, of 32 bits, so that the stamps of 2^31 ships can be summed in 64
/// bits.
fn vector_stamp(ship: &str, vectors: &str) -> i64 {
    let hash = Sha256::digest(format!("{ship}\n{vectors}"));
    i64::from(u32::from_be_bytes([hash[0], hash[1], hash[2], hash[3]]))
}

/// Queues a ship within a transaction, if it exists.
pub(crate) async fn queue_ship(
    store: &Store,
    tx: &mut AuditedTransaction,
    ship: &str,
) -> Result<()> {
    let mark = store.new_id();
    tx.execute(MARK, args![ship: ship, mark: &mark]).await.map(drop)
}

/// Queues a ship if the moved alias determines facts of it.
pub(crate) async fn queue_moved(
    store: &Store,
    tx: &mut AuditedTransaction,
    model: &str,
    alias: &str,
) -> Result<()> {
    if alias == ALIAS { queue_ship(store, tx, model).await } else { Ok(()) }
}
