//! Database and object store of Sistership: ships, trials, laws, model versions with their aliases,
//! jobs and reports, in SQLite or PostgreSQL, and the samples of trials in a content-addressed
//! object store.
//!
//! Each table has one repository, reached from [`Store`]; time and ids are parameters ([`Clock`],
//! [`Ids`]), so that tests can fix both. Nothing is overwritten: versions and laws are insert-only,
//! aliases and ships keep their history, a deletion is a tombstone. Changes that belong together
//! are one transaction, see [`Store::commit_refinement`] and [`Store::commit_diagnosis`].

mod actor;
mod aliases;
mod arguments;
mod audit;
mod backup;
mod bulks;
mod chain;
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
mod page;
mod postgres_pool;
mod questions;
mod record;
mod reports;
mod reserve;
mod room;
mod search;
mod search_index;
mod sessions;
mod settings;
mod ships;
mod staged;
mod standings;
mod statements;
mod statistics;
mod store;
mod tags;
#[cfg(all(unix, feature = "testing"))]
pub mod testing;
mod trials;
mod unit;
mod unit_of_work;
mod users;
mod version;
mod versions;
mod webhooks;
mod work;

pub use actor::Actor;
pub use aliases::{Alias, AliasChange, AliasMove, Aliases, Expect};
pub use audit::{Audit, AuditFilter};
pub use backup::{BackupManifest, DatabaseKind, FileHead, TableHead};
pub use bulks::{Bulk, BulkOutcome, Bulks, ChunkCount, NewOutcome, OutcomeCount};
pub use chain::AuditHead;
pub use checks::{MAX_NAME_CHARS, MAX_TEXT_BYTES};
pub use clock::{Clock, Ids, ManualClock, SequentialIds, SystemClock, UuidIds};
pub use commit::{Committed, Kept, Refinement};
pub use commit_diagnosis::{CommittedDiagnosis, Diagnosis, PartDiagnosis};
pub use diagnoses::{Diagnosed, Diagnoses, NewDiagnosed};
pub use effects::{EffectLibraries, EffectLibrary};
pub use entry::AuditEntry;
pub use error::{Result, StoreError, is_out_of_space};
pub use families::{Families, Family, FamilyMember, FamilyPrior};
pub use grants::{GrantRow, Grants};
pub use idempotency::{Begun, Idempotency, KEEP_KEYS, PROLONG_EVERY, TAKE_OVER_AFTER, Ticket};
pub use identities::{Identities, Identity, SignIn};
pub use integrity::Fault;
pub use job::{Job, JobCount, JobFilter, JobState, NewJob};
pub use jobs::Jobs;
pub use keys::{KeyRow, NewKey, ServiceKeys};
pub use laws::{Law, Laws};
pub use notes::{MAX_NOTE_CHARS, Note};
pub use object_list::{ObjectHead, ObjectName};
pub use objects::{Objects, sha256_hex};
pub use objects_error::ObjectsError;
pub use objects_place::{ObjectsPlace, S3Place, provide_cryptography};
pub use page::{List, MAX_LIMIT, Page};
pub use questions::CurrentVersion;
pub use reports::{NewReport, Report, ReportHead, Reports};
pub use search::{
    FactRange, FoundShip, MAX_RANGES, ShipKey, ShipSearch, ShipVectors, VectorsState,
};
pub use search_index::{SearchIndex, ShipFact, ShipFacts, Waiting};
pub use sessions::{Session, Sessions};
pub use settings::StoreSettings;
pub use ships::{NewShip, Ship, ShipRevision, Ships};
pub use staged::Staged;
pub use standings::ShipStanding;
pub use statistics::TrialStatistics;
pub use store::Store;
pub use tags::MAX_TAGS;
pub use trials::{Inserted, NewTrial, Trial, Trials};
#[cfg(feature = "testing")]
pub use unit::Moment;
pub use unit_of_work::UnitOfWork;
pub use users::{User, Users};
pub use version::{NewVersion, Version, VersionHead};
pub use versions::Versions;
pub use webhooks::{
    CHAMPION_MOVED, DIAGNOSIS_FAILED, DRIFT, Delivery, EVENTS, NewWebhook, Webhook, Webhooks,
};
pub use work::{Claimed, MAX_LOST_WORKERS};
