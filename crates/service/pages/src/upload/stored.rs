//! The page after an upload: what was stored, and the next step.

use askama::Template;

use crate::error::Result;
use crate::shell::PageShell;

/// Result of an upload.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StoredUpload {
    /// The ship.
    pub ship: String,
    /// Number of stored trials.
    pub trials: i64,
    /// Job that diagnoses the champion on them.
    pub job: Option<String>,
}

#[derive(Template)]
#[template(path = "stored.html")]
struct StoredPage<'a> {
    shell: &'a PageShell,
    of: &'a StoredUpload,
}

impl StoredUpload {
    /// Returns the address of the page.
    pub fn address(&self) -> String {
        let job = self.job.as_ref().map_or_else(String::new, |job| format!("&job={job}"));
        format!("/ships/{}/uploaded?trials={}{job}", self.ship, self.trials)
    }
}

/// Returns the page with the next step: a refinement.
///
/// # Errors
/// Returns an error if the page cannot be rendered.
pub fn stored_page(shell: &PageShell, of: &StoredUpload) -> Result<String> {
    Ok(StoredPage { shell, of }.render()?)
}
