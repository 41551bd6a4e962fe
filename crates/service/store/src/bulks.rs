//! Bulk refinements of all members of a family: chunks of ships as jobs, and one outcome for each
//! ship.

use serde_json::json;

use crate::aliases::AliasMove;
use crate::arguments::{Arg, args};
use crate::checks;
use crate::database::AuditedTransaction;
use crate::error::{Result, StoreError};
use crate::job::{Job, JobState, NewJob, job};
use crate::jobs;
use crate::page::{ListPage, PageRequest};
use crate::record::record;
use crate::statements::{Statement, same, statements};
use crate::store::Store;
use crate::version::{NewVersion, VersionHead};
use crate::versions;
use crate::work;

statements! {
    INSERT = same("INSERT INTO bulk_refinements (id, family, request, ships, created_us) VALUES \
        ($1, $2, $3, $4, $5) RETURNING id, family, request, ships, created_us");
    GET = same("SELECT id, family, request, ships, created_us FROM bulk_refinements WHERE id = $1");
    // '~' sorts after every id (letters, digits and hyphens): without a cursor the list starts at
    // the latest one.
    LIST = same("SELECT id, family, request, ships, created_us FROM bulk_refinements \
        WHERE family = COALESCE($1, family) AND id < COALESCE($2, '~') ORDER BY id DESC LIMIT $3");
    CHUNK = same("INSERT INTO bulk_chunks (bulk, number, job) VALUES ($1, $2, $3)");
    CHUNKS = same("SELECT j.state, COUNT(*) AS jobs, MIN(j.started_us) AS started_us, \
        MAX(j.finished_us) AS finished_us FROM bulk_chunks c JOIN jobs j ON j.id = c.job WHERE \
        c.bulk = $1 GROUP BY j.state ORDER BY j.state");
    JOBS = same(job!("SELECT", "FROM jobs WHERE id IN (SELECT job FROM bulk_chunks WHERE bulk = \
        $1) AND state = COALESCE($2, state) ORDER BY id"));
    // A queued chunk is cancelled at once; a running one is only marked, and its worker stops it.
    CANCEL = same("UPDATE jobs SET cancel_requested = 1, \
        finished_us = CASE WHEN state = 'queued' THEN $2 ELSE finished_us END, \
        state = CASE WHEN state = 'queued' THEN 'cancelled' ELSE state END \
        WHERE id IN (SELECT job FROM bulk_chunks WHERE bulk = $1) AND state IN ('queued', \
        'running')");
    // Attempts and lost workers are reset, as for a new job; the fence stays and keeps old workers
    // out.
    RETRY = same("UPDATE jobs SET state = 'queued', attempt = 0, lost_workers = 0, progress = 0, \
        message = '', error = NULL, worker = NULL, finished_us = NULL, cancel_requested = 0 \
        WHERE id IN (SELECT job FROM bulk_chunks WHERE bulk = $1) AND state IN ('failed', \
        'cancelled')");
    KEEP = same("INSERT INTO bulk_outcomes (bulk, ship, outcome, version_id, worst_change, \
        document, created_us) VALUES ($1, $2, $3, $4, $5, $6, $7)");
    // Only a candidate can be promoted; any other outcome changes no row.
    PROMOTED = same("UPDATE bulk_outcomes SET outcome = 'champion' WHERE bulk = $1 AND ship = $2 \
        AND outcome = 'candidate'");
    // Outer join: outcomes without a version are listed too.
    OUTCOMES = same("SELECT o.bulk, o.ship, o.outcome, v.number AS version, o.worst_change, \
        o.document, o.created_us FROM bulk_outcomes o LEFT JOIN versions v ON v.id = o.version_id \
        WHERE o.bulk = $1 AND o.outcome = COALESCE($2, o.outcome) AND o.ship > COALESCE($3, '') \
        ORDER BY o.ship LIMIT $4");
    COUNTS = same("SELECT outcome, COUNT(*) AS ships FROM bulk_outcomes WHERE bulk = $1 GROUP BY \
        outcome ORDER BY outcome");
}

record! {
    /// A bulk refinement of a family.
    pub struct FamilyRefinement {
        /// Its id.
        pub id: String,
        /// The family.
        pub family: String,
        /// Request, JSON.
        pub request: String,
        /// Number of ships to refine.
        pub ships: i64,
        /// Time of the request, microseconds since 1970.
        pub created_us: i64,
    }
}

record! {
    /// Number of chunks in one state.
    pub struct ChunkCount {
        /// The state.
        pub state: JobState,
        /// Number of chunks.
        pub jobs: i64,
        /// Start of the earliest chunk, microseconds since 1970.
        pub started_us: Option<i64>,
        /// End of the latest chunk, microseconds since 1970.
        pub finished_us: Option<i64>,
    }
}

record! {
    /// Number of ships with one outcome.
    pub struct OutcomeCount {
        /// `champion`, `candidate`, `unchanged` or `refused`.
        pub outcome: String,
        /// Number of ships.
        pub ships: i64,
    }
}

record! {
    /// Outcome of a bulk refinement for one ship.
    pub struct BulkOutcome {
        /// The refinement.
        pub bulk: String,
        /// The ship.
        pub ship: String,
        /// `champion`, `candidate`, `unchanged` or `refused`.
        pub outcome: String,
        /// Number of the resulting version, if there is one.
        pub version: Option<i64>,
        /// Largest deterioration of a metric relative to the version before; negative if all
        /// improved.
        pub worst_change: Option<f64>,
        /// Metrics before and after, or the reason of a refusal, JSON.
        pub document: String,
        /// When.
        pub created_us: i64,
    }
}

/// Outcome of one ship, as a worker submits it.
#[derive(Debug, Clone, PartialEq)]
pub struct NewOutcome {
    /// The ship.
    pub ship: String,
    /// `champion`, `candidate`, `unchanged` or `refused`.
    pub outcome: String,
    /// The version and the aliases that move to it.
    pub version: Option<(NewVersion, Vec<AliasMove>)>,
    /// Largest deterioration of a metric relative to the version before.
    pub worst_change: Option<f64>,
    /// Metrics before and after, or the reason of a refusal, JSON.
    pub document: String,
}

/// Repository of bulk refinements.
#[derive(Debug, Clone, Copy)]
pub struct BulkRepository<'a>(pub(crate) &'a Store);

impl Store {
    /// Returns the repository of bulk refinements.
    pub fn bulks(&self) -> BulkRepository<'_> {
        BulkRepository(self)
    }
}

impl BulkRepository<'_> {
    /// Queues a bulk refinement with its chunks, all or nothing. `chunk` writes the request of a
    /// chunk from the id of the bulk refinement and the ships of the chunk.
    pub async fn create(
        &self,
        family: &str,
        request: &str,
        kind: &str,
        chunks: &[Vec<String>],
        chunk: impl Fn(&str, &[String]) -> String,
    ) -> Result<FamilyRefinement> {
        checks::check_json("request", request)?;
        let id = self.0.new_id();
        let ships = i64::try_from(chunks.iter().map(Vec::len).sum::<usize>()).unwrap_or(i64::MAX);
        let mut tx = self.0.begin().await?;
        let values = args![id: &id, family: family, request: request, ships: ships,
            created_us: self.0.now_us()];
        let bulk: FamilyRefinement = tx.fetch_one(INSERT, values).await?;
        for (number, ships) in (1..).zip(chunks) {
            let request = chunk(&id, ships);
            let new = NewJob { kind: kind.to_owned(), ship: None, request, small: false };
            let job = jobs::insert_job(self.0, &mut tx, &new).await?;
            tx.execute(CHUNK, args![bulk: &id, number: number, job: &job.id]).await?;
        }
        let after = json!({ "family": family, "ships": bulk.ships });
        tx.record_audit_event(
            self.0.now_us(),
            "bulk-refinement.create",
            audit_subject(&id),
            None,
            Some(after),
        );
        tx.commit().await?;
        Ok(bulk)
    }

    /// A refinement.
    pub async fn get(&self, id: &str) -> Result<FamilyRefinement> {
        let bulk = self.0.database().fetch_optional(GET, args![id: id]).await?;
        bulk.ok_or_else(|| StoreError::not_found("bulk refinement", id))
    }

    /// Refinements, the latest first.
    pub async fn list(
        &self,
        family: Option<&str>,
        page: &PageRequest,
    ) -> Result<ListPage<FamilyRefinement>> {
        let values = args![family: family, after: &page.after, limit: page.fetch_limit()?];
        let bulks = self.0.database().fetch_all(LIST, values).await?;
        Ok(page.build_page(bulks, |bulk: &FamilyRefinement| bulk.id.clone()))
    }

    /// Counts the chunks by state.
    pub async fn count_chunks(&self, id: &str) -> Result<Vec<ChunkCount>> {
        self.0.database().fetch_all(CHUNKS, args![bulk: id]).await
    }

    /// Returns the jobs of the chunks, optionally of one state only.
    pub async fn chunk_jobs(&self, id: &str, state: Option<JobState>) -> Result<Vec<Job>> {
        self.0.database().fetch_all(JOBS, args![bulk: id, state: state.map(JobState::as_str)]).await
    }

    /// Cancels the chunks that wait, and asks the workers of those that run to stop.
    pub async fn request_cancel(&self, id: &str) -> Result<u64> {
        let values = &[("bulk", id.into()), ("finished_us", self.0.now_us().into())];
        let mut tx = self.0.begin().await?;
        let changed =
            self.update_chunks(&mut tx, (CANCEL, "bulk-refinement.cancel"), id, values).await?;
        tx.commit().await?;
        Ok(changed)
    }

    /// Queues the failed and cancelled chunks again; ships that have an outcome keep it.
    pub async fn retry_chunks(&self, id: &str) -> Result<u64> {
        let mut tx = self.0.begin().await?;
        let values = &[("bulk", id.into())];
        let changed =
            self.update_chunks(&mut tx, (RETRY, "bulk-refinement.retry"), id, values).await?;
        if changed > 0 {
            tx.mark_queued();
        }
        tx.commit().await?;
        Ok(changed)
    }

    async fn update_chunks(
        &self,
        tx: &mut AuditedTransaction,
        (statement, action): (Statement, &'static str),
        id: &str,
        values: &[(&'static str, Arg<'_>)],
    ) -> Result<u64> {
        let changed = tx.execute(statement, values).await?;
        if changed > 0 {
            let after = json!({ "chunks": changed });
            tx.record_audit_event(self.0.now_us(), action, audit_subject(id), None, Some(after));
        }
        Ok(changed)
    }

    /// Lists the outcomes, ordered by ship.
    pub async fn list_outcomes(
        &self,
        id: &str,
        outcome: Option<&str>,
        page: &PageRequest,
    ) -> Result<ListPage<BulkOutcome>> {
        let values =
            args![bulk: id, outcome: outcome, after: &page.after, limit: page.fetch_limit()?];
        let outcomes = self.0.database().fetch_all(OUTCOMES, values).await?;
        Ok(page.build_page(outcomes, |outcome: &BulkOutcome| outcome.ship.clone()))
    }

    /// Counts the ships by outcome.
    pub async fn count_outcomes(&self, id: &str) -> Result<Vec<OutcomeCount>> {
        self.0.database().fetch_all(COUNTS, args![bulk: id]).await
    }

    /// Promotes a candidate of this bulk refinement to champion, on the decision of a person.
    pub async fn promote_candidate(
        &self,
        id: &str,
        ship: &str,
        version: i64,
        change: &AliasMove,
    ) -> Result<()> {
        let mut tx = self.0.begin().await?;
        crate::aliases::move_alias(self.0, &mut tx, ship, version, change).await?;
        // Without a candidate the transaction is dropped, and the move of the alias with it.
        if tx.execute(PROMOTED, args![bulk: id, ship: ship]).await? == 0 {
            return Err(StoreError::conflict(
                "outcome",
                ship,
                "is not a candidate of this refinement",
            ));
        }
        tx.commit().await
    }

    /// Stores the outcomes of a chunk and completes its job, all or nothing: a worker that has lost
    /// the job to another one (its `fence` is older) changes nothing, and no ship gets two
    /// outcomes.
    pub async fn commit_chunk(
        &self,
        bulk: &str,
        job: (&str, i64),
        outcomes: &[NewOutcome],
        result: &str,
    ) -> Result<Job> {
        let mut tx = self.0.begin().await?;
        for outcome in outcomes {
            insert_outcome(self.0, &mut tx, bulk, outcome).await?;
        }
        let job = work::complete_job(&mut tx, job.0, job.1, result, self.0.now_us()).await?;
        tx.commit().await?;
        Ok(job)
    }
}

/// Returns the subject of audit entries about a bulk refinement.
fn audit_subject(id: &str) -> String {
    format!("bulk-refinement:{id}")
}

async fn insert_outcome(
    store: &Store,
    tx: &mut AuditedTransaction,
    bulk: &str,
    new: &NewOutcome,
) -> Result<()> {
    checks::check_json("document", &new.document)?;
    let version: Option<VersionHead> = match &new.version {
        Some((version, moves)) => Some(versions::insert_version(store, tx, version, moves).await?),
        None => None,
    };
    let version_id = version.as_ref().map(|version| version.id.as_str());
    let values = args![bulk: bulk, ship: &new.ship, outcome: &new.outcome, version_id: version_id,
        worst_change: new.worst_change, document: &new.document, created_us: store.now_us()];
    tx.execute(KEEP, values).await.map(drop)
}
