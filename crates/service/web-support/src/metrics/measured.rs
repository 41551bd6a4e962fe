//! Metrics read from the archive at each scrape: jobs, their age, and the size of the object store.

use std::time::{Duration, Instant};

use futures::TryStreamExt as _;
use prometheus_client::encoding::EncodeLabelSet;
use prometheus_client::metrics::family::Family;
use prometheus_client::metrics::gauge::Gauge;
use prometheus_client::registry::Registry;
use sistership_store::{JobCount, JobState, Result};
use tokio::sync::Mutex;

use sistership_jobs::archive::Archive;

/// Time for which a size is reused: measuring it lists every object.
const FRESH: Duration = Duration::from_secs(60);

/// Maximum time for counting the objects.
const LISTING_TIMEOUT: Duration = Duration::from_secs(5);

#[derive(Debug, Clone, PartialEq, Eq, Hash, EncodeLabelSet)]
struct JobLabels {
    kind: String,
    state: &'static str,
}

/// Number of objects, and their size in bytes.
type StoreSize = (i64, i64);

/// Metrics of the archive, with a cached size of the object store.
#[derive(Debug, Default)]
pub(super) struct ArchiveMetrics(Mutex<Option<(Instant, StoreSize)>>);

impl ArchiveMetrics {
    /// Returns a registry with the present values.
    pub(super) async fn current_registry(&self, archive: &Archive) -> Result<Registry> {
        let counts = archive.store.jobs().count_by_state().await?;
        let size = self.store_size(archive).await;
        let mut registry = Registry::with_prefix("sistership");
        registry.register("jobs", "Jobs by kind and state", job_gauges(&counts));
        let age = Gauge::<f64, std::sync::atomic::AtomicU64>::default();
        age.set(queue_age_s(&counts, archive.store.now_us()));
        registry.register("queue_age_seconds", "Waiting time of the oldest queued job", age);
        // Without an answer of the object store, the other metrics are still of use.
        for (name, help, value) in size.into_iter().flat_map(|(objects, bytes)| {
            [
                (
                    "object_store_objects",
                    "Objects in the object store, updated every minute",
                    objects,
                ),
                ("object_store_bytes", "Bytes in the object store, updated every minute", bytes),
            ]
        }) {
            let gauge = Gauge::<i64>::default();
            gauge.set(value);
            registry.register(name, help, gauge);
        }
        Ok(registry)
    }

    /// Returns the size of the object store; none if it does not answer in time.
    async fn store_size(&self, archive: &Archive) -> Option<StoreSize> {
        // The lock is held while measuring, so that concurrent scrapes list the objects once.
        let mut known = self.0.lock().await;
        if let Some((_, size)) = known.filter(|(when, _)| when.elapsed() < FRESH) {
            return Some(size);
        }
        let count = |(objects, bytes): StoreSize, head: sistership_store::ObjectHead| async move {
            Ok((objects + 1, bytes + i64::try_from(head.bytes).unwrap_or(i64::MAX)))
        };
        let listed = archive.objects.list().try_fold((0, 0), count);
        match tokio::time::timeout(LISTING_TIMEOUT, listed).await {
            Ok(Ok(size)) => {
                *known = Some((Instant::now(), size));
                Some(size)
            }
            Ok(Err(error)) => {
                tracing::warn!(%error, "the objects could not be counted");
                None
            }
            Err(_) => {
                tracing::warn!("the objects could not be counted in time");
                None
            }
        }
    }
}

fn job_gauges(counts: &[JobCount]) -> Family<JobLabels, Gauge> {
    let jobs = Family::<JobLabels, Gauge>::default();
    for count in counts {
        jobs.get_or_create(&JobLabels { kind: count.kind.clone(), state: count.state.as_str() })
            .set(count.jobs);
    }
    jobs
}

/// Returns the age of the oldest queued job, s; 0 if none is queued.
fn queue_age_s(counts: &[JobCount], now_us: i64) -> f64 {
    let oldest = counts
        .iter()
        .filter(|count| count.state == JobState::Queued)
        .map(|count| count.oldest_us)
        .min();
    oldest.map_or(0.0, |oldest| (now_us - oldest).max(0) as f64 / 1e6)
}
