//! Pages of the jobs: the list, and one job with its request and state.

use askama::Template;
use serde_json::Value;
use sistership_jobs::Archive;
use sistership_store::{Job, JobFilter, JobState, PageRequest};

use crate::cursor::{decode_cursor, encode_cursor};
use crate::date::format_date;
use crate::error::{PageError, Result};
use crate::form::FormFields;
use crate::language::{Message, say};
use crate::rows::JobRow;
use crate::shell::PageShell;

/// Number of jobs on one page.
const JOBS_PER_PAGE: i64 = 50;
const STATES: [JobState; 5] = [
    JobState::Queued,
    JobState::Running,
    JobState::Succeeded,
    JobState::Failed,
    JobState::Cancelled,
];

#[derive(Template)]
#[template(path = "jobs.html")]
struct JobsPage {
    shell: PageShell,
    ship: String,
    state: String,
    states: Vec<&'static str>,
    jobs: Vec<JobRow>,
    next: Option<String>,
}

/// Returns the list, the latest first; `ship` and `state` filter.
///
/// # Errors
/// Returns an error if a field is wrong or the store fails.
pub async fn jobs_page(archive: &Archive, shell: PageShell, query: &FormFields) -> Result<String> {
    let state = query.get_text("state").map(parse_state).transpose()?;
    let filter = JobFilter { ship: query.get_text("ship").map(str::to_owned), state };
    let page = PageRequest { after: decode_cursor(query.get_text("after"))?, limit: JOBS_PER_PAGE };
    let jobs = archive.store.jobs().list(&filter, &page).await?;
    let next = encode_cursor(jobs.next.as_ref());
    let page = JobsPage {
        shell: shell.at_place("/jobs"),
        ship: filter.ship.unwrap_or_default(),
        state: state.map_or_else(String::new, |state| state.as_str().to_owned()),
        states: STATES.map(JobState::as_str).to_vec(),
        jobs: jobs.items.into_iter().map(JobRow::from_job).collect(),
        next,
    };
    Ok(page.render()?)
}

fn parse_state(name: &str) -> Result<JobState> {
    let known = STATES.into_iter().find(|state| state.as_str() == name);
    known.ok_or_else(|| PageError::invalid_field("state", say("job-no-state").with("name", name)))
}

#[derive(Template)]
#[template(path = "job.html")]
struct JobPage {
    shell: PageShell,
    row: JobRow,
    progress: f64,
    goes_on: bool,
    may_retry: bool,
    cancelling: bool,
    error: Option<String>,
    times: Vec<(Message, String)>,
    attempt: i64,
    version: Option<i64>,
    report: Option<String>,
    request: String,
}

/// Returns the page of one job.
///
/// # Errors
/// Returns an error if there is no job of this id or the store fails.
pub async fn job_page(archive: &Archive, shell: PageShell, id: &str) -> Result<String> {
    let job = archive.store.jobs().get(id).await?;
    Ok(JobPage::from_job(shell, job).render()?)
}

impl JobPage {
    /// Kind of the job, and its ship.
    fn title(&self) -> String {
        match self.row.ship.as_str() {
            "" => self.row.kind_words(),
            ship => {
                say("job-of-ship").with("kind", self.row.kind_words()).with("ship", ship).into()
            }
        }
    }

    fn from_job(shell: PageShell, job: Job) -> Self {
        let result: Value = job
            .result
            .as_deref()
            .and_then(|text| serde_json::from_str(text).ok())
            .unwrap_or_default();
        // Times that have not been reached have no row.
        let times = [
            (say("jobs-requested"), Some(job.created_us)),
            (say("jobs-begun"), job.started_us),
            (say("jobs-ended"), job.finished_us),
        ];
        Self {
            shell: shell.at_place("/jobs"),
            progress: job.progress.clamp(0.0, 1.0),
            goes_on: !job.state.is_final(),
            may_retry: matches!(job.state, JobState::Failed | JobState::Cancelled),
            cancelling: job.cancel_requested && !job.state.is_final(),
            error: job.error.clone(),
            times: times
                .into_iter()
                .filter_map(|(what, at)| Some((what, format_date(at?))))
                .collect(),
            attempt: job.attempt,
            version: result["version"].as_i64(),
            report: result["report"].as_str().map(str::to_owned),
            request: format_request(&job.request),
            row: JobRow::from_job(job),
        }
    }
}

/// Formats the stored request.
fn format_request(request: &str) -> String {
    let asked: Value = serde_json::from_str(request).unwrap_or_default();
    serde_json::to_string_pretty(&asked).unwrap_or_default()
}
