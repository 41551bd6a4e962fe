//! State shared by every handler and worker.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use sistership_model::{Law, Vessel, Zoo};
use sistership_store::{Objects, Store};
use tokio::sync::{Notify, RwLock, Semaphore};

use crate::accounts::{Accounts, Credentials};
use crate::config::{Config, Leases, Limits};
use crate::metrics::Metrics;
use crate::problem::{Problem, Result};
use sistership_auth::openid::Provider;
use sistership_jobs::archive::Archive;
use sistership_jobs::budget::{self, Budget, Held};
use sistership_jobs::catalogue::{Catalogue, KnownLaw, MOST};
use sistership_jobs::predictions::session::Sessions;
use sistership_listener::{Stopping, Throttle, TrustedProxies};
use sistership_pages::ship::SIMILAR;
use sistership_pages::version::KnownManoeuvres;
use sistership_web_support::answers::Answers;
use sistership_web_support::api_key::FormToken;
use sistership_web_support::drafts::Drafts;
use sistership_web_support::payload::DocumentLimits;
use sistership_web_support::spool::Spool;
use sistership_web_support::upload::UploadPlace;

/// The shared state of a server. A clone is another handle on the same one.
#[derive(Clone)]
pub(crate) struct App(Arc<Inner>, Arc<Archive>);

struct Inner {
    catalogue: Catalogue,
    credentials: Credentials,
    form_token: FormToken,
    drafts: Drafts,
    sessions: Sessions,
    throttle: Throttle,
    proxies: TrustedProxies,
    limits: Limits,
    leases: Leases,
    spool: Arc<Spool>,
    no_room: AtomicBool,
    seats: Arc<Semaphore>,
    wake: Notify,
    turns: Arc<RwLock<()>>,
    metrics: Metrics,
    answers: Answers,
    manoeuvres: Arc<KnownManoeuvres>,
    stopping: Stopping,
    requests: Budget,
    jobs: Budget,
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
        catalogue: Catalogue,
        stopping: Stopping,
    ) -> sistership_auth::openid::Result<Self> {
        // As many numerical tasks and password hashes run at a time as there are cores; both take
        // their permits from the same semaphore.
        let seats = std::thread::available_parallelism().map_or(2, std::num::NonZero::get);
        let seats = Arc::new(Semaphore::new(seats));
        let provider = config.openid.clone().map(Provider::new).transpose()?;
        let (key, people) = (config.api_key.as_deref(), config.accounts);
        let credentials = Credentials::new(key, people, provider, Arc::clone(&seats));
        let inner = Inner {
            catalogue,
            form_token: FormToken::of(credentials.key()),
            drafts: Drafts::default(),
            sessions: Sessions::new(config.limits.sessions),
            credentials,
            throttle: Throttle::default(),
            proxies: config.proxies.clone(),
            limits: config.limits,
            leases: config.leases,
            spool: Arc::new(Spool::below(config.data_dir.join("uploads"))),
            no_room: AtomicBool::new(false),
            seats,
            wake: Notify::new(),
            turns: Arc::default(),
            metrics: Metrics::default(),
            answers: Answers::default(),
            manoeuvres: Arc::default(),
            stopping,
            requests: Budget::new(config.limits.request_memory, "--request-memory-mb"),
            jobs: Budget::new(config.limits.job_memory, "--job-memory-mb"),
        };
        Ok(Self(Arc::new(inner), Arc::new(archive)))
    }

    /// Returns a handle on the same state with another store, such as that of a unit of work.
    pub(crate) fn within(&self, store: &Store) -> Self {
        let archive = Archive { store: store.clone(), objects: self.objects().clone() };
        Self(Arc::clone(&self.0), Arc::new(archive))
    }

    /// The zoo as it was last read from the store.
    pub(crate) fn catalogue(&self) -> &Catalogue {
        &self.0.catalogue
    }

    pub(crate) fn archive(&self) -> &Archive {
        &self.1
    }

    pub(crate) fn store(&self) -> &Store {
        &self.1.store
    }

    pub(crate) fn objects(&self) -> &Objects {
        &self.1.objects
    }

    /// Known credentials and the ways in which a caller is identified.
    pub(crate) fn credentials(&self) -> &Credentials {
        &self.0.credentials
    }

    /// The accounts of the store, with the credentials of this process.
    pub(crate) fn accounts(&self) -> Accounts<'_> {
        self.credentials().of(self.store())
    }

    /// Token that the forms of the pages carry.
    pub(crate) fn form_token(&self) -> &FormToken {
        &self.0.form_token
    }

    /// Uploads that a person reviews before they are kept.
    pub(crate) fn drafts(&self) -> &Drafts {
        &self.0.drafts
    }

    /// Simulation sessions that are open.
    pub(crate) fn sessions(&self) -> &Sessions {
        &self.0.sessions
    }

    /// Addresses that have presented wrong keys.
    pub(crate) fn throttle(&self) -> &Throttle {
        &self.0.throttle
    }

    /// Proxies whose statement of a client's address is trusted.
    pub(crate) fn proxies(&self) -> &TrustedProxies {
        &self.0.proxies
    }

    pub(crate) fn limits(&self) -> &Limits {
        &self.0.limits
    }

    pub(crate) fn leases(&self) -> &Leases {
        &self.0.leases
    }

    /// Folder of uploads until they have been read.
    pub(crate) fn spool(&self) -> &Spool {
        &self.0.spool
    }

    /// True if the last attempt to write found no space.
    pub(crate) fn no_room(&self) -> &AtomicBool {
        &self.0.no_room
    }

    /// Lock that a worker holds while it has a job: shared as a rule, exclusive if a process ended
    /// during an earlier attempt at the job.
    pub(crate) fn turns(&self) -> &Arc<RwLock<()>> {
        &self.0.turns
    }

    /// Signal that wakes the workers of this process.
    pub(crate) fn wake(&self) -> &Notify {
        &self.0.wake
    }

    /// Wakes all workers of this process, including one that is about to wait.
    pub(crate) fn wake_all(&self) {
        // `notify_waiters` reaches only those that wait already; `notify_one` leaves a permit for
        // one that begins to wait just now.
        self.wake().notify_waiters();
        self.wake().notify_one();
    }

    pub(crate) fn metrics(&self) -> &Metrics {
        &self.0.metrics
    }

    /// Cache of the answers with champions.
    pub(crate) fn answers(&self) -> &Answers {
        &self.0.answers
    }

    /// Signal that the server is to stop.
    pub(crate) fn stopping(&self) -> Stopping {
        self.0.stopping.clone()
    }

    /// Memory budget of one request.
    pub(crate) fn held(&self) -> Held {
        Held::new(self.0.requests.clone(), self.0.limits.memory_wait)
    }

    /// Memory budget of the jobs.
    pub(crate) fn job_memory(&self) -> &Budget {
        &self.0.jobs
    }

    /// Returns the laws of the database, without ships.
    pub(crate) async fn laws(&self) -> sistership_store::Result<Arc<Zoo>> {
        self.0.catalogue.laws(self.store()).await
    }

    /// Returns the laws of the database with the ships that a ship is compared with: all ships if
    /// they are few, otherwise the most similar ones of its category.
    pub(crate) async fn zoo_around(&self, target: &Vessel) -> Result<Arc<Zoo>> {
        Ok(self.0.catalogue.around(self.archive(), target, MOST).await?)
    }

    /// Returns the same with at most as many ships as a page lists, if they are many.
    pub(crate) async fn zoo_shown(&self, target: &Vessel) -> Result<Arc<Zoo>> {
        Ok(self.0.catalogue.around(self.archive(), target, SIMILAR).await?)
    }

    /// Cache of the standard manoeuvres of versions, as pages show them.
    pub(crate) fn manoeuvres(&self) -> Arc<KnownManoeuvres> {
        Arc::clone(&self.0.manoeuvres)
    }

    /// Returns a law of the database.
    ///
    /// # Errors
    /// Returns an internal error if the law is missing or cannot be parsed.
    pub(crate) async fn law(&self, name: &str) -> Result<Arc<Law>> {
        let known = self.find_law(name).await?;
        known
            .map(|known| known.law)
            .ok_or_else(|| Problem::internal(format!("the law `{name}` does not read")))
    }

    /// Returns a law, or `None` if there is none of this name.
    pub(crate) async fn find_law(&self, name: &str) -> Result<Option<KnownLaw>> {
        Ok(self.0.catalogue.law(self.store(), name).await?)
    }

    /// Runs numerical work on a blocking thread; at most as many tasks at a time as there are
    /// cores.
    pub(crate) async fn compute<T: Send + 'static>(
        &self,
        work: impl FnOnce() -> T + Send + 'static,
    ) -> Result<T> {
        let seat = Arc::clone(&self.0.seats).acquire_owned().await.map_err(Problem::internal)?;
        let task = tokio::task::spawn_blocking(budget::carried(move || {
            // Held until the work ends, also if the request that waits for it is dropped.
            let _seat = seat;
            work()
        }));
        task.await.map_err(Problem::internal)
    }
}
