//! Database and object store of Sistership: ships, trials, laws, model versions with their aliases,
//! jobs and reports, in SQLite or PostgreSQL, and the samples of trials in a content-addressed
//! object store.
//!
//! Each table has one repository, reached from [`Store`]; time and ids are parameters ([`Clock`],
//! [`Ids`]), so that tests can fix both. Nothing is overwritten: versions and laws are insert-only,
//! aliases and ships keep their history, a deletion is a tombstone. Changes that belong together
//! are one transaction, see [`Store::commit_refinement`] and [`Store::commit_diagnosis`].

mod actor;
mod alias_lookups;
mod aliases;
mod arguments;
mod audit;
mod backup;
mod bulks;
mod chain;
mod changes;
mod checks;
mod clock;
mod commit;
mod commit_diagnosis;
mod connect;
mod connections;
mod current;
mod database;
mod diagnoses;
mod effects;
mod entry;
mod error;
mod families;
mod folders;
mod free_space;
mod garbage;
mod grants;
mod group;
mod idempotency;
mod identities;
mod integrity;
mod job;
mod jobs;
mod keys;
mod laws;
mod migrate;
mod notes;
mod object_list;
mod objects;
mod objects_error;
mod objects_place;
mod overviews;
mod page;
mod postgres_pool;
mod queue_order;
mod queue_signal;
mod record;
mod reports;
mod reserve;
mod row_seal;
mod seal_check;
mod search;
mod search_index;
mod sessions;
mod settings;
mod ships;
mod sign_offs;
mod staged;
mod statements;
mod statistics;
mod store;
mod tags;
mod templates;
#[cfg(all(unix, feature = "testing"))]
pub mod testing;
mod trial_conditions;
mod trials;
mod unit;
mod unit_of_work;
mod users;
mod version;
mod versions;
mod webhooks;
mod work;

pub use actor::Actor;
pub use alias_lookups::CurrentVersion;
pub use aliases::{Alias, AliasChange, AliasMove, AliasRepository, ExpectedRevision};
pub use audit::{AuditFilter, AuditLog};
pub use backup::{BackupManifest, DatabaseKind, FileHead, TableHead};
pub use bulks::{
    BulkOutcome, BulkRepository, ChunkCount, FamilyRefinement, NewOutcome, OutcomeCount,
};
pub use chain::AuditHead;
pub use changes::{ChangeKind, ShipChange};
pub use checks::{MAX_NAME_CHARS, MAX_TEXT_BYTES};
pub use clock::{Clock, IdGenerator, ManualClock, SequentialIds, SystemClock, UuidIds};
pub use commit::{CommittedRefinement, NewRefinement, RefinementRows};
pub use commit_diagnosis::{CommittedDiagnosis, NewDiagnosis, PartDiagnosis};
pub use diagnoses::{DiagnosisRepository, DiagnosisRow, NewDiagnosisRow};
pub use effects::{EffectLibraries, EffectLibrary};
pub use entry::AuditEntry;
pub use error::{Result, StoreError, is_out_of_space};
pub use families::{Family, FamilyMember, FamilyPrior, FamilyRepository};
pub use grants::{GrantRepository, GrantRow};
pub use idempotency::{
    IdempotencyRepository, KEEP_KEYS, PROLONG_EVERY, RequestClaim, RequestTicket, TAKE_OVER_AFTER,
};
pub use identities::{IdentityRepository, IdentityRow, SignIn};
pub use integrity::IntegrityFault;
pub use job::{Job, JobCount, JobFilter, JobState, NewJob};
pub use jobs::JobRepository;
pub use keys::{KeyRow, NewKey, ServiceKeys};
pub use laws::{Law, LawRepository};
pub use notes::{MAX_NOTE_CHARS, ShipNote};
pub use object_list::{ObjectHead, ObjectName};
pub use objects::{ObjectStorage, sha256_hex};
pub use objects_error::ObjectsError;
pub use objects_place::{ObjectsPlace, S3Place, provide_cryptography};
pub use overviews::ShipOverview;
pub use page::{ListPage, MAX_LIMIT, PageRequest, read_all_pages, visit_pages};
pub use queue_order::QueuePlace;
pub use queue_signal::QueueWatch;
pub use reports::{NewReport, Report, ReportHead, ReportRepository};
pub use search::{
    FactRange, FoundShip, MAX_RANGES, ShipKey, ShipSearch, ShipVectors, VectorsState,
};
pub use search_index::{SearchIndex, ShipFact, ShipFacts, StaleShip};
pub use sessions::{Session, SessionRepository};
pub use settings::StoreSettings;
pub use ships::{NewShip, Ship, ShipRepository, ShipRevision};
pub use sign_offs::{SIGN_OFF_ROLES, SignOff};
pub use staged::StagedObject;
pub use statistics::TrialStatistics;
pub use store::Store;
pub use tags::MAX_TAGS;
pub use templates::{ImportTemplateRow, MAX_TEMPLATES, TemplateRepository};
pub use trials::{InsertOutcome, NewTrial, Trial, TrialRepository};
#[cfg(feature = "testing")]
pub use unit::CrashPoint;
pub use unit_of_work::UnitOfWork;
pub use users::{User, UserRepository};
pub use version::{NewVersion, Version, VersionHead};
pub use versions::VersionRepository;
pub use webhooks::{
    CHAMPION_MOVED, DIAGNOSIS_FAILED, DRIFT, Delivery, EVENTS, NewWebhook, Webhook,
    WebhookRepository,
};
pub use work::{JobClaim, MAX_LOST_WORKERS, WorkerClaim};
