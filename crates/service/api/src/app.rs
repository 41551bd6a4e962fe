//! What every handler and worker shares.

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

    /// The same whose store is another handle: that of a unit of work.
    pub(crate) fn within(&self, store: &Store) -> Self {
        let archive = Archive { store: store.clone(), objects: self.objects().clone() };
        Self(Arc::clone(&self.0), Arc::new(archive))
    }

    /// The zoo as it was last seen.
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

    /// Who is known, and how they show who they are.
    pub(crate) fn credentials(&self) -> &Credentials {
        &self.0.credentials
    }

    /// The same with the store.
    pub(crate) fn accounts(&self) -> Accounts<'_> {
        self.credentials().of(self.store())
    }

    /// What forms of pages send along.
    pub(crate) fn form_token(&self) -> &FormToken {
        &self.0.form_token
    }

    /// Uploads that a person looks over.
    pub(crate) fn drafts(&self) -> &Drafts {
        &self.0.drafts
    }

    /// Ships under way.
    pub(crate) fn sessions(&self) -> &Sessions {
        &self.0.sessions
    }

    /// Who has presented wrong keys.
    pub(crate) fn throttle(&self) -> &Throttle {
        &self.0.throttle
    }

    /// The proxies whose word for a client's address is taken.
    pub(crate) fn proxies(&self) -> &TrustedProxies {
        &self.0.proxies
    }

    pub(crate) fn limits(&self) -> &Limits {
        &self.0.limits
    }

    pub(crate) fn leases(&self) -> &Leases {
        &self.0.leases
    }

    /// Where uploads lie until they have been read.
    pub(crate) fn spool(&self) -> &Spool {
        &self.0.spool
    }

    /// Whether there was no room to write when somebody last tried.
    pub(crate) fn no_room(&self) -> &AtomicBool {
        &self.0.no_room
    }

    /// What a worker holds while it has a job: for itself alone where a process has ended during
    /// the job before.
    pub(crate) fn turns(&self) -> &Arc<RwLock<()>> {
        &self.0.turns
    }

    /// Wakes this process' workers.
    pub(crate) fn wake(&self) -> &Notify {
        &self.0.wake
    }

    /// Wakes all of them, also one that is about to rest.
    pub(crate) fn wake_all(&self) {
        self.wake().notify_waiters();
        self.wake().notify_one();
    }

    pub(crate) fn metrics(&self) -> &Metrics {
        &self.0.metrics
    }

    /// Champions as they were answered before.
    pub(crate) fn answers(&self) -> &Answers {
        &self.0.answers
    }

    /// The word that the server shall stop.
    pub(crate) fn stopping(&self) -> Stopping {
        self.0.stopping.clone()
    }

    /// Memory for a request.
    pub(crate) fn held(&self) -> Held {
        Held::new(self.0.requests.clone(), self.0.limits.memory_wait)
    }

    /// Memory of jobs.
    pub(crate) fn job_memory(&self) -> &Budget {
        &self.0.jobs
    }

    /// The laws of the database, and no ships.
    pub(crate) async fn laws(&self) -> sistership_store::Result<Arc<Zoo>> {
        self.0.catalogue.laws(self.store()).await
    }

    /// The laws of the database, with the ships that a ship is compared with: all of them where
    /// they are few, else those of its category that are most similar to it.
    pub(crate) async fn zoo_around(&self, target: &Vessel) -> Result<Arc<Zoo>> {
        Ok(self.0.catalogue.around(self.archive(), target, MOST).await?)
    }

    /// The same with no more ships than a page shows, where they are many.
    pub(crate) async fn zoo_shown(&self, target: &Vessel) -> Result<Arc<Zoo>> {
        Ok(self.0.catalogue.around(self.archive(), target, SIMILAR).await?)
    }

    /// What versions say of the standard manoeuvres, as pages show it.
    pub(crate) fn manoeuvres(&self) -> Arc<KnownManoeuvres> {
        Arc::clone(&self.0.manoeuvres)
    }

    /// A law of the database.
    pub(crate) async fn law(&self, name: &str) -> Result<Arc<Law>> {
        let known = self.find_law(name).await?;
        known
            .map(|known| known.law)
            .ok_or_else(|| Problem::internal(format!("the law `{name}` does not read")))
    }

    /// A law that may not be there.
    pub(crate) async fn find_law(&self, name: &str) -> Result<Option<KnownLaw>> {
        Ok(self.0.catalogue.law(self.store(), name).await?)
    }

    /// Runs numerics away from the threads that serve; as many at a time as there are cores.
    pub(crate) async fn compute<T: Send + 'static>(
        &self,
        work: impl FnOnce() -> T + Send + 'static,
    ) -> Result<T> {
        let seat = Arc::clone(&self.0.seats).acquire_owned().await.map_err(Problem::internal)?;
        let task = tokio::task::spawn_blocking(budget::carried(move || {
            let _seat = seat;
            work()
        }));
        task.await.map_err(Problem::internal)
    }
}
