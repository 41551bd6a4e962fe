//! Reports on versions and ships, as data and as HTML pages.

use crate::arguments::args;
use crate::checks;
use crate::database::AuditedTransaction;
use crate::error::{Result, StoreError};
use crate::page::{ListPage, PageRequest};
use crate::record::record;
use crate::statements::{same, statements};
use crate::store::Store;
use crate::version;

statements! {
    INSERT = same("INSERT INTO reports (id, version_id, ship, kind, document, html, created_us) \
        VALUES ($1, $2, $3, $4, $5, $6, $7) RETURNING id, version_id, ship, kind, created_us");
    GET = same("SELECT id, version_id, ship, kind, document, html, created_us FROM reports WHERE \
        id = $1");
    // '~' sorts after every id: without a cursor the list starts at the latest one.
    BY_VERSION = same("SELECT id, version_id, ship, kind, created_us FROM reports \
        WHERE version_id = $1 AND id < COALESCE($2, '~') ORDER BY id DESC LIMIT $3");
}

record! {
    /// A report without its texts.
    pub struct ReportHead {
        /// Its id.
        pub id: String,
        /// Id of the version that it is about, if there is one.
        pub version_id: Option<String>,
        /// The ship it is about.
        pub ship: String,
        /// Kind of report: `refinement`, `diagnosis`, ...
        pub kind: String,
        /// When it was made.
        pub created_us: i64,
    }
}

record! {
    /// A report.
    pub struct Report {
        flatten head: ReportHead,
        /// Its data, JSON.
        pub document: String,
        /// HTML page.
        pub html: String,
    }
}

/// A report to be stored.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NewReport {
    /// Id of the version that it is about, if there is one.
    pub version_id: Option<String>,
    /// The ship it is about.
    pub ship: String,
    /// Kind of report.
    pub kind: String,
    /// Its data, JSON.
    pub document: String,
    /// HTML page.
    pub html: String,
}

/// Repository of reports.
#[derive(Debug, Clone, Copy)]
pub struct ReportRepository<'a>(pub(crate) &'a Store);

impl Store {
    /// Returns the repository of reports.
    pub fn reports(&self) -> ReportRepository<'_> {
        ReportRepository(self)
    }
}

impl ReportRepository<'_> {
    /// Inserts a report.
    pub async fn insert(&self, new: &NewReport) -> Result<ReportHead> {
        let mut tx = self.0.begin().await?;
        let report = insert_report(self.0, &mut tx, new).await?;
        tx.commit().await?;
        Ok(report)
    }

    /// Returns the report of an id.
    pub async fn get(&self, id: &str) -> Result<Report> {
        let report = self.0.database().fetch_optional(GET, args![id: id]).await?;
        report.ok_or_else(|| StoreError::not_found("report", id))
    }

    /// Lists the reports on a version, the latest first.
    pub async fn by_version(
        &self,
        version_id: &str,
        page: &PageRequest,
    ) -> Result<ListPage<ReportHead>> {
        let values = args![version_id: version_id, after: &page.after, limit: page.fetch_limit()?];
        let reports = self.0.database().fetch_all(BY_VERSION, values).await?;
        Ok(page.build_page(reports, |report: &ReportHead| report.id.clone()))
    }
}

/// Inserts a report within a transaction.
pub(crate) async fn insert_report(
    store: &Store,
    tx: &mut AuditedTransaction,
    new: &NewReport,
) -> Result<ReportHead> {
    checks::check_name("ship", &new.ship)?;
    checks::check_name("kind", &new.kind)?;
    checks::check_json("document", &new.document)?;
    if let Some(version) = &new.version_id {
        version::check_id(tx, "version_id", version).await?;
    }
    let id = store.new_id();
    let values = args![id: &id, version_id: &new.version_id, ship: &new.ship, kind: &new.kind,
        document: &new.document,
        html: &new.html, created_us: store.now_us()];
    tx.fetch_one(INSERT, values).await
}
