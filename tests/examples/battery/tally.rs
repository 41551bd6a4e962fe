//! What an attack counts.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

/// Findings that begin with so many equal characters are alike.
const ALIKE: usize = 40;
/// Findings that are alike and are said.
const SAID: usize = 3;

/// The counts of one attack. All of it may be written from many tasks.
#[derive(Debug, Default)]
pub struct Tally {
    tried: AtomicU64,
    lost: AtomicU64,
    wrong: AtomicU64,
    server_errors: AtomicU64,
    aborted: AtomicU64,
    peak_kb: AtomicU64,
    said: Mutex<BTreeMap<(&'static str, String), usize>>,
    remarks: Mutex<Vec<String>>,
}

/// The counts at one moment.
#[derive(Debug, Clone, Copy, Default)]
pub struct Counts {
    /// Attempts: requests, kills or crash points, as the attack's own remark says.
    pub tried: u64,
    /// Acknowledged, and not there afterwards.
    pub lost: u64,
    /// Answers or records that are not what they must be.
    pub wrong: u64,
    /// Answers of 5xx other than 503 and 507.
    pub server_errors: u64,
    /// Processes that ended by themselves.
    pub aborted: u64,
    /// The highest resident memory of any process of the attack, MB.
    pub peak_mb: u64,
}

impl Tally {
    /// Counts attempts.
    pub fn tried(&self, count: u64) {
        self.tried.fetch_add(count, Ordering::Relaxed);
    }

    /// Something acknowledged is not there.
    pub fn lost(&self, what: impl Into<String>) {
        self.lost.fetch_add(1, Ordering::Relaxed);
        self.find("lost", what.into());
    }

    /// An answer or a record is not what it must be.
    pub fn wrong(&self, what: impl Into<String>) {
        self.wrong.fetch_add(1, Ordering::Relaxed);
        self.find("wrong", what.into());
    }

    /// A process has ended by itself.
    pub fn aborted(&self, what: impl Into<String>) {
        self.aborted.fetch_add(1, Ordering::Relaxed);
        self.find("aborted", what.into());
    }

    /// Judges a status by itself: 5xx other than 503 and 507 is never right.
    pub fn status(&self, status: u16, what: impl FnOnce() -> String) {
        if status >= 500 && status != 503 && status != 507 {
            self.server_errors.fetch_add(1, Ordering::Relaxed);
            self.find("5xx", format!("{status}: {}", what()));
        }
    }

    /// The resident memory of a process, kB.
    pub fn memory(&self, kb: u64) {
        self.peak_kb.fetch_max(kb, Ordering::Relaxed);
    }

    /// A word for the last column.
    pub fn remark(&self, what: impl Into<String>) {
        self.remarks.lock().unwrap_or_else(PoisonError::into_inner).push(what.into());
    }

    /// The counts as they are now.
    pub fn counts(&self) -> Counts {
        let of = |count: &AtomicU64| count.load(Ordering::Relaxed);
        Counts {
            tried: of(&self.tried),
            lost: of(&self.lost),
            wrong: of(&self.wrong),
            server_errors: of(&self.server_errors),
            aborted: of(&self.aborted),
            peak_mb: of(&self.peak_kb).div_ceil(1024),
        }
    }

    /// The last column.
    pub fn remarks(&self) -> String {
        self.remarks.lock().unwrap_or_else(PoisonError::into_inner).join("; ")
    }

    /// A finding is said at once, so that it is not lost with the battery; of those that begin
    /// alike, the first few.
    fn find(&self, kind: &'static str, what: String) {
        let mut said = self.said.lock().unwrap_or_else(PoisonError::into_inner);
        let times = said.entry((kind, what.chars().take(ALIKE).collect())).or_insert(0);
        *times += 1;
        if *times <= SAID {
            eprintln!("  {kind}: {what}");
        }
    }
}
