//! What ships are found by, kept up with them.
//!
//! Whatever changes what is known of a ship puts it in a queue, in the same transaction. Somebody
//! who can read documents takes it out again and writes down its facts.

use sha2::{Digest as _, Sha256};

use crate::arguments::args;
use crate::checks;
use crate::database::Transaction;
use crate::error::Result;
use crate::record::record;
use crate::statements::{same, statements};
use crate::store::Store;

/// The alias whose version tells facts of a ship.
const ALIAS: &str = "champion";

statements! {
    MARK = same("INSERT INTO search_queue (ship, mark) SELECT name, CAST($2 AS TEXT) FROM ships \
        WHERE name = $1 ON CONFLICT (ship) DO UPDATE SET mark = excluded.mark");
    WAITING = same("SELECT ship, mark FROM search_queue WHERE ship > $1 ORDER BY ship LIMIT $2");
    FACTS = same("SELECT fact, value FROM ship_facts WHERE ship = $1 ORDER BY fact");
    TAKE = same("DELETE FROM search_queue WHERE ship = $1 AND mark = $2");
    FORGET = same("DELETE FROM ship_facts WHERE ship = $1");
    FACT = same("INSERT INTO ship_facts (ship, fact, value) VALUES ($1, $2, $3)");
    VECTORS = same("INSERT INTO ship_vectors (ship, category, vectors, stamp) VALUES ($1, $2, $3, \
        $4) ON CONFLICT (ship) DO UPDATE \
        SET category = excluded.category, vectors = excluded.vectors, stamp = excluded.stamp");
}

record! {
    /// A ship whose facts are out of date.
    pub struct Waiting {
        /// The ship.
        pub ship: String,
        /// Tells this change from later ones.
        pub mark: String,
    }
}

record! {
    /// One fact of a ship.
    pub struct ShipFact {
        /// What it is.
        pub fact: String,
        /// Its value.
        pub value: f64,
    }
}

/// What is known of a ship.
#[derive(Debug, Clone, PartialEq)]
pub struct ShipFacts {
    /// The change that it follows.
    pub waiting: Waiting,
    /// Its category.
    pub category: String,
    /// Facts by name, each name once.
    pub facts: Vec<(String, f64)>,
    /// What tells how similar it is to others, JSON.
    pub vectors: String,
}

impl ShipFacts {
    /// Of a ship of which nothing is known, or which is deleted.
    pub fn none(waiting: Waiting) -> Self {
        Self { waiting, category: String::new(), facts: Vec::new(), vectors: "{}".to_owned() }
    }
}

/// What the ships of a store are found by.
#[derive(Debug, Clone, Copy)]
pub struct SearchIndex<'a>(pub(crate) &'a Store);

impl Store {
    /// What ships are found by.
    pub fn search_index(&self) -> SearchIndex<'_> {
        SearchIndex(self)
    }
}

impl SearchIndex<'_> {
    /// Ships that have changed since their facts were written, by name, at most `limit` of those
    /// after `after`.
    pub async fn waiting(&self, after: &str, limit: i64) -> Result<Vec<Waiting>> {
        self.0.database().all(WAITING, args![after: after, limit: limit]).await
    }

    /// The facts of a ship as they were last written, by name.
    pub async fn facts(&self, ship: &str) -> Result<Vec<ShipFact>> {
        self.0.database().all(FACTS, args![ship: ship]).await
    }

    /// Writes the facts of ships, all at once, and returns of how many. Of one that has changed
    /// again in the meantime nothing is written: it waits on.
    pub async fn write(&self, all: &[ShipFacts]) -> Result<usize> {
        let mut tx = self.0.begin().await?;
        let mut written = 0;
        for ship in all {
            checks::json("vectors", &ship.vectors)?;
            let taken =
                tx.execute(TAKE, args![ship: &ship.waiting.ship, mark: &ship.waiting.mark]).await?;
            if taken > 0 {
                write(&mut tx, ship).await?;
                written += 1;
            }
        }
        tx.commit().await?;
        Ok(written)
    }
}

async fn write(tx: &mut Transaction, facts: &ShipFacts) -> Result<()> {
    let ship = &facts.waiting.ship;
    tx.execute(FORGET, args![ship: ship]).await?;
    for (fact, value) in &facts.facts {
        tx.execute(FACT, args![ship: ship, fact: fact, value: *value]).await?;
    }
    let stamp = stamp(ship, &facts.vectors);
    tx.execute(
        VECTORS,
        args![ship: ship, category: &facts.category, vectors: &facts.vectors, stamp: stamp],
    )
    .await
    .map(drop)
}

/// Tells these vectors from others: 32 bits, so that those of 2^31 ships can be added.
fn stamp(ship: &str, vectors: &str) -> i64 {
    let hash = Sha256::digest(format!("{ship}\n{vectors}"));
    i64::from(u32::from_be_bytes([hash[0], hash[1], hash[2], hash[3]]))
}

/// Puts a ship in the queue within a transaction, if there is one of this name.
pub(crate) async fn mark(store: &Store, tx: &mut Transaction, ship: &str) -> Result<()> {
    let mark = store.new_id();
    tx.execute(MARK, args![ship: ship, mark: &mark]).await.map(drop)
}

/// Puts a ship in the queue where the alias that has moved tells facts of it.
pub(crate) async fn mark_moved(
    store: &Store,
    tx: &mut Transaction,
    model: &str,
    alias: &str,
) -> Result<()> {
    if alias == ALIAS { mark(store, tx, model).await } else { Ok(()) }
}
