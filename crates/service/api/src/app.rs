//! State shared by every handler and worker.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use sistership_model::{Law, Vessel, Zoo};
use sistership_store::{Actor, ObjectStorage, Store};
use tokio::sync::RwLock;

use crate::accounts::{Accounts, Credentials};
use crate::compute_pool::{ComputePool, ComputeTurn};
use crate::config::{Config, LeaseSettings, Limits};
use crate::metrics::ServerMetrics;
use crate::problem::{Problem, Result};
use crate::start_error::StartError;
use sistership_auth::openid::OpenIdProvider;
use sistership_jobs::archive::Archive;
use sistership_jobs::budget::{MemoryBudget, RequestMemory};
use sistership_jobs::catalogue::{KnownLaw, MAX_COMPARED_SHIPS, ZooCache};
use sistership_jobs::predictions::session::SessionTable;
use sistership_jobs::webhooks::MailSender;
use sistership_listener::{KeyThrottle, StopSignal, TrustedProxies};
use sistership_pages::Language;
use sistership_pages::ship::SIMILAR;
use sistership_pages::version::ManoeuvreCache;
use sistership_pages::version::turn::TurnCache;
use sistership_web_support::acting::current_actor;
use sistership_web_support::answers::AnswerCache;
use sistership_web_support::api_key::FormToken;
use sistership_web_support::drafts::DraftTable;
use sistership_web_support::payload::DocumentLimits;
use sistership_web_support::spool::SpoolFolder;
use sistership_web_support::upload::UploadPlace;

/// Largest file, bytes on disk, or memory that its reading takes, that does not count as large: it
/// is read in a tenth of a second.
const SMALL_FILE_BYTES: u64 = 8 << 20;

/// The shared state of a server. A clone is another handle on the same one.
#[derive(Clone)]
pub(crate) struct App(Arc<SharedState>, Arc<Archive>);

struct SharedState {
    catalogue: ZooCache,
    mail: Option<MailSender>,
    credentials: Credentials,
    form_token: FormToken,
    drafts: DraftTable,
    sessions: SessionTable,
    throttle: KeyThrottle,
    proxies: TrustedProxies,
    limits: Limits,
    leases: LeaseSettings,
    spool: Arc<SpoolFolder>,
    no_room: AtomicBool,
    numerics: ComputePool,
    small_files: ComputePool,
    files: ComputePool,
    turns: Arc<RwLock<()>>,
    metrics: ServerMetrics,
    answers: AnswerCache,
    manoeuvres: Arc<ManoeuvreCache>,
    turn_pictures: Arc<TurnCache>,
    stopping: StopSignal,
    requests: MemoryBudget,
    jobs: MemoryBudget,
}

impl axum::extract::FromRef<App> for DocumentLimits {
    fn from_ref(app: &App) -> Self {
        let Limits { document_bytes: json_bytes, yaml_bytes, .. } = *app.limits();
        Self { json_bytes, yaml_bytes }
    }
}

impl axum::extract::FromRef<App> for UploadPlace {
    fn from_ref(app: &App) -> Self {
        let Limits { upload_files: files, yaml_bytes, .. } = *app.limits();
        Self { spool: Arc::clone(&app.0.spool), files, yaml_bytes }
    }
}

impl App {
    pub(crate) fn new(
        config: &Config,
        archive: Archive,
        catalogue: ZooCache,
        stopping: StopSignal,
    ) -> std::result::Result<Self, StartError> {
        let cores = std::thread::available_parallelism().map_or(2, std::num::NonZero::get);
        let provider = config.openid.clone().map(OpenIdProvider::new).transpose()?;
        let (key, people) = (config.api_key.as_deref(), config.accounts);
        let credentials = Credentials::new(key, people, provider);
        let mail = config.mail.as_ref().map(MailSender::new).transpose();
        let inner = SharedState {
            catalogue,
            mail: mail.map_err(StartError::Mail)?,
            form_token: FormToken::from_key(credentials.server_key()),
            drafts: DraftTable::default(),
            sessions: SessionTable::new(config.limits.sessions),
            credentials,
            throttle: KeyThrottle::default(),
            proxies: config.proxies.clone(),
            limits: config.limits,
            leases: config.leases,
            spool: Arc::new(SpoolFolder::with_root(config.data_dir.join("uploads"))),
            no_room: AtomicBool::new(false),
            numerics: ComputePool::new(cores),
            small_files: ComputePool::new(1),
            // Reading a file may take seconds; it leaves half of the cores to other requests.
            files: ComputePool::new(cores.div_ceil(2)),
            turns: Arc::default(),
            metrics: ServerMetrics::default(),
            answers: AnswerCache::default(),
            manoeuvres: Arc::default(),
            turn_pictures: Arc::default(),
            stopping,
            requests: MemoryBudget::new(config.limits.request_memory, "--request-memory-mb"),
            jobs: MemoryBudget::new(config.limits.job_memory, "--job-memory-mb"),
        };
        Ok(Self(Arc::new(inner), Arc::new(archive)))
    }

    /// Returns a handle on the same state with another store, such as that of a unit of work.
    pub(crate) fn with_store(&self, store: &Store) -> Self {
        let archive = Archive { store: store.clone(), objects: self.objects().clone() };
        Self(Arc::clone(&self.0), Arc::new(archive))
    }

    /// The zoo as it was last read from the store.
    pub(crate) fn catalogue(&self) -> &ZooCache {
        &self.0.catalogue
    }

    pub(crate) fn archive(&self) -> &Archive {
        &self.1
    }

    pub(crate) fn store(&self) -> &Store {
        &self.1.store
    }

    pub(crate) fn objects(&self) -> &ObjectStorage {
        &self.1.objects
    }

    /// Known credentials and the ways in which a caller is identified.
    pub(crate) fn credentials(&self) -> &Credentials {
        &self.0.credentials
    }

    /// The accounts of the store, with the credentials of this process.
    pub(crate) fn accounts(&self) -> Accounts<'_> {
        self.credentials().with_store(self.store())
    }

    /// Token that the forms of the pages carry.
    pub(crate) fn form_token(&self) -> &FormToken {
        &self.0.form_token
    }

    /// Uploads that a person reviews before they are kept.
    pub(crate) fn drafts(&self) -> &DraftTable {
        &self.0.drafts
    }

    /// Simulation sessions that are open.
    pub(crate) fn sessions(&self) -> &SessionTable {
        &self.0.sessions
    }

    /// Addresses that have presented wrong keys.
    pub(crate) fn throttle(&self) -> &KeyThrottle {
        &self.0.throttle
    }

    /// Proxies whose statement of a client's address is trusted.
    pub(crate) fn proxies(&self) -> &TrustedProxies {
        &self.0.proxies
    }

    /// Sender of mail, if the server has one.
    pub(crate) fn mail(&self) -> Option<&MailSender> {
        self.0.mail.as_ref()
    }

    pub(crate) fn limits(&self) -> &Limits {
        &self.0.limits
    }

    pub(crate) fn leases(&self) -> &LeaseSettings {
        &self.0.leases
    }

    /// Folder of uploads until they have been read.
    pub(crate) fn spool(&self) -> &SpoolFolder {
        &self.0.spool
    }

    /// True if the last attempt to write found no space.
    pub(crate) fn is_out_of_space(&self) -> &AtomicBool {
        &self.0.no_room
    }

    /// Lock that a worker holds while it has a job: shared as a rule, exclusive if a process ended
    /// during an earlier attempt at the job.
    pub(crate) fn worker_turns(&self) -> &Arc<RwLock<()>> {
        &self.0.turns
    }

    pub(crate) fn metrics(&self) -> &ServerMetrics {
        &self.0.metrics
    }

    /// Cache of the answers with champions.
    pub(crate) fn champion_cache(&self) -> &AnswerCache {
        &self.0.answers
    }

    /// Signal that the server is to stop.
    pub(crate) fn stop_signal(&self) -> StopSignal {
        self.0.stopping.clone()
    }

    /// Memory budget of one request.
    pub(crate) fn request_memory(&self) -> RequestMemory {
        RequestMemory::new(self.0.requests.clone(), self.0.limits.memory_wait)
    }

    /// Memory budget of the jobs.
    pub(crate) fn job_memory(&self) -> &MemoryBudget {
        &self.0.jobs
    }

    /// Returns the laws of the database, without ships.
    pub(crate) async fn stored_laws(&self) -> sistership_store::Result<Arc<Zoo>> {
        self.0.catalogue.zoo_of_laws(self.store()).await
    }

    /// Returns the laws of the database with the ships that a ship is compared with: all ships if
    /// they are few, otherwise the most similar ones of its category.
    pub(crate) async fn zoo_around(&self, target: &Vessel) -> Result<Arc<Zoo>> {
        Ok(self.0.catalogue.zoo_for_target(self.archive(), target, MAX_COMPARED_SHIPS).await?)
    }

    /// Returns the same with at most as many ships as a page lists, if they are many.
    pub(crate) async fn zoo_shown(&self, target: &Vessel) -> Result<Arc<Zoo>> {
        Ok(self.0.catalogue.zoo_for_target(self.archive(), target, SIMILAR).await?)
    }

    /// Cache of the standard manoeuvres of versions, as pages show them.
    pub(crate) fn known_manoeuvres(&self) -> Arc<ManoeuvreCache> {
        Arc::clone(&self.0.manoeuvres)
    }

    /// Cache of small pictures of turning circles.
    pub(crate) fn turn_pictures(&self) -> Arc<TurnCache> {
        Arc::clone(&self.0.turn_pictures)
    }

    /// Returns a law of the database.
    ///
    /// # Errors
    /// Returns an internal error if the law is missing or cannot be parsed.
    pub(crate) async fn stored_law(&self, name: &str) -> Result<Arc<Law>> {
        let known = self.find_law(name).await?;
        known
            .map(|known| known.law)
            .ok_or_else(|| Problem::internal(format!("the law `{name}` does not read")))
    }

    /// Returns a law, or `None` if there is none of this name.
    pub(crate) async fn find_law(&self, name: &str) -> Result<Option<KnownLaw>> {
        Ok(self.0.catalogue.find_law(self.store(), name).await?)
    }

    /// Runs numerical work on a blocking thread; at most as many tasks at a time as there are
    /// cores.
    pub(crate) async fn run_blocking<T: Send + 'static>(
        &self,
        work: impl FnOnce() -> T + Send + 'static,
    ) -> Result<T> {
        // A page that is rendered on the other thread keeps its language.
        let language = Language::current();
        self.0.numerics.run(&caller_name(), move || language.run_blocking(work)).await
    }

    /// Waits for the turn to read a file of a size. Small files wait for no large one.
    pub(crate) async fn wait_file_turn(&self, bytes: u64) -> Result<ComputeTurn> {
        let is_small = bytes <= SMALL_FILE_BYTES;
        let pool = if is_small { &self.0.small_files } else { &self.0.files };
        pool.wait_turn(&caller_name()).await
    }

    /// Reads uploaded files on a blocking thread.
    pub(crate) async fn read_files<T: Send + 'static>(
        &self,
        work: impl FnOnce() -> T + Send + 'static,
    ) -> Result<T> {
        let language = Language::current();
        self.0.files.run(&caller_name(), move || language.run_blocking(work)).await
    }
}

/// Name under which a task waits for its turn: that of the caller, or of the author of the job.
fn caller_name() -> String {
    current_actor().map_or_else(|| Actor::current().name, |acting| acting.principal.name.clone())
}
