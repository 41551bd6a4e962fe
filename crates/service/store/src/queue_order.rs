//! Order of the queue: fair shares of its authors.
//!
//! Authors take turns, those with the fewest running jobs first, and among them the one whose last
//! start is the longest ago. Within the share of an author its ships take turns in the same way.
//! Within a ship the jobs follow each other by their time of request, to which a large job adds ten
//! minutes: small jobs precede it, but not those that are requested more than ten minutes later. A
//! job whose lease has run out had its turn already and precedes all others.

use crate::arguments::args;
use crate::error::Result;
use crate::jobs::JobRepository;
use crate::record::record;
use crate::statements::{same, statements};

/// Number of candidates that a worker reads at a time: others may claim some of them meanwhile.
const CANDIDATES: i64 = 16;
/// Largest number of jobs whose place is computed.
const MOST_PLACES: i64 = 10_000;

/// The queue in its order, by `$1`, the present time.
macro_rules! in_line {
    ($select:literal) => {
        same(concat!(
            "WITH waiting AS (SELECT id, author, COALESCE(ship, '') AS ship, state, small, \
             created_us + CASE small WHEN 1 THEN 0 ELSE 600000000 END AS due_us FROM jobs \
             WHERE state IN ('queued', 'running') AND (state = 'queued' OR lease_until_us < $1)), \
             busy AS (SELECT author, COUNT(*) AS jobs FROM jobs WHERE state = 'running' \
             AND lease_until_us >= $1 GROUP BY author), \
             authors AS (SELECT DISTINCT author FROM waiting), \
             people AS (SELECT a.author, COALESCE(b.jobs, 0) AS busy, COALESCE((SELECT \
             MAX(h.started_us) FROM jobs h WHERE h.author = a.author), 0) AS served_us \
             FROM authors a LEFT JOIN busy b ON b.author = a.author), \
             pairs AS (SELECT DISTINCT author, ship FROM waiting), \
             shares AS (SELECT p.author, p.ship, COALESCE((SELECT MAX(h.started_us) FROM jobs h \
             WHERE h.author = p.author AND h.ship = p.ship), 0) AS served_us FROM pairs p), \
             turns AS (SELECT w.id, w.author, w.ship, w.state, w.small, w.due_us, ROW_NUMBER() \
             OVER (PARTITION BY w.author, w.ship ORDER BY w.due_us, w.id) AS turn FROM waiting w), \
             rounds AS (SELECT t.id, t.author, t.state, t.small, t.due_us, ROW_NUMBER() OVER \
             (PARTITION BY t.author ORDER BY t.turn, s.served_us, t.due_us, t.id) AS round \
             FROM turns t JOIN shares s ON s.author = t.author AND s.ship = t.ship), \
             line AS (SELECT r.id, r.small, ROW_NUMBER() OVER (ORDER BY \
             CASE r.state WHEN 'running' THEN 0 ELSE 1 END, r.round + p.busy, p.served_us, \
             r.due_us, r.id) AS place FROM rounds r JOIN people p ON p.author = r.author) ",
            $select
        ))
    };
}

statements! {
    FIRST = in_line!("SELECT id, place FROM line WHERE small >= $2 ORDER BY place LIMIT $3");
    PLACES = in_line!("SELECT id, place FROM line ORDER BY place LIMIT $2");
}

record! {
    /// Place of a waiting job in the queue; 1 is the next one to begin.
    pub struct QueuePlace {
        /// The job's id.
        pub id: String,
        /// Its place.
        pub place: i64,
    }
}

impl JobRepository<'_> {
    /// Returns the places of the waiting jobs, in order; at most ten thousand.
    pub async fn queue_places(&self) -> Result<Vec<QueuePlace>> {
        let values = args![now_us: self.0.now_us(), limit: MOST_PLACES];
        self.0.database().fetch_all(PLACES, values).await
    }

    /// Returns the first jobs of the queue, of small ones only if `small` is set.
    pub(crate) async fn first_in_line(&self, small: bool) -> Result<Vec<QueuePlace>> {
        let values = args![now_us: self.0.now_us(), small: i64::from(small), limit: CANDIDATES];
        self.0.database().fetch_all(FIRST, values).await
    }
}
