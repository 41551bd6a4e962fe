//! Permits of connections: bounded in total and for each address, with a reserve in which requests
//! without a permit are refused with an answer.
//!
//! A connection that waits for the server is never closed. When permits run out, the connection
//! that has waited longest for its other end is closed: for a body that does not arrive, an answer
//! that is not read, or a request that is not sent.

use std::collections::HashMap;
use std::net::IpAddr;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use tokio::sync::Notify;
use tokio::time::Instant;

use crate::limits::ConnectionLimits;
use crate::progress::ConnectionProgress;

/// Number of connections beyond the permits, for health checks and refusals.
pub(super) const RESERVE: usize = 128;
/// Time for which a wait for the other end is tolerated before the connection may be closed for
/// another: some round trips around the world.
const TOLERATED_WAIT: Duration = Duration::from_millis(500);
/// Maximum wait of a request for a permit before it is refused.
const MAX_PERMIT_WAIT: Duration = Duration::from_secs(1);
/// Interval at which a waiting request checks again for slow connections.
const POLL_INTERVAL: Duration = Duration::from_millis(50);

/// The connections of a listener.
pub(super) struct ConnectionSlots {
    connections: usize,
    share: usize,
    table: Mutex<SlotTable>,
    freed: Notify,
}

#[derive(Default)]
struct SlotTable {
    next: u64,
    entries: HashMap<u64, SlotEntry>,
    /// Number of permits by address.
    shares: HashMap<IpAddr, usize>,
    seated: usize,
}

struct SlotEntry {
    party: IpAddr,
    seated: bool,
    pace: Arc<ConnectionProgress>,
}

/// An entry of the table, removed when this is dropped.
pub(super) struct Permit {
    id: u64,
    seats: Arc<ConnectionSlots>,
}

impl ConnectionSlots {
    pub(super) fn new(limits: &ConnectionLimits) -> Arc<Self> {
        let (connections, share) = (limits.connections, limits.connections_per_address);
        Arc::new(Self { connections, share, table: Mutex::default(), freed: Notify::new() })
    }

    fn lock_table(&self) -> MutexGuard<'_, SlotTable> {
        self.table.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Admits a new connection: with a permit, else in the reserve; none if all connections of the
    /// reserve wait for the server.
    pub(super) fn admit(
        self: &Arc<Self>,
        party: IpAddr,
        pace: &Arc<ConnectionProgress>,
    ) -> Option<Permit> {
        let mut table = self.lock_table();
        let seated = self.free_permit(&mut table, party);
        let crowded = || table.entries.len() - table.seated >= RESERVE;
        if !seated && crowded() && !table.evict_waiting(Duration::ZERO, |entry| !entry.seated) {
            return None;
        }
        let id = table.insert(party, seated, pace);
        Some(Permit { id, seats: Arc::clone(self) })
    }

    /// Frees a permit for an address, if possible; returns true if there is one.
    fn free_permit(&self, table: &mut SlotTable, party: IpAddr) -> bool {
        // An address at its limit can only replace a connection of its own.
        if table.shares.get(&party).copied().unwrap_or(0) >= self.share {
            return table
                .evict_waiting(TOLERATED_WAIT, |entry| entry.seated && entry.party == party);
        }
        if table.seated < self.connections {
            return true;
        }
        // The address with the most permits gives one up first.
        let most = table.shares.iter().max_by_key(|(_, seats)| **seats).map(|(party, _)| *party);
        table.evict_waiting(TOLERATED_WAIT, |entry| entry.seated && Some(entry.party) == most)
            || table.evict_waiting(TOLERATED_WAIT, |entry| entry.seated)
    }

    /// Closes the connection that has waited longest, when the system has no more sockets.
    pub(super) fn evict_longest(&self) -> bool {
        self.lock_table().evict_waiting(Duration::ZERO, |_| true)
    }

    /// Closes all remaining connections.
    pub(super) fn cut_all(&self) {
        self.lock_table().entries.values().for_each(|entry| entry.pace.cut_connection());
    }
}

impl SlotTable {
    fn insert(&mut self, party: IpAddr, seated: bool, pace: &Arc<ConnectionProgress>) -> u64 {
        self.next += 1;
        self.entries.insert(self.next, SlotEntry { party, seated, pace: Arc::clone(pace) });
        if seated {
            self.count_permit(party);
        }
        self.next
    }

    fn count_permit(&mut self, party: IpAddr) {
        self.seated += 1;
        *self.shares.entry(party).or_default() += 1;
    }

    fn remove(&mut self, id: u64) {
        let Some(entry) = self.entries.remove(&id).filter(|entry| entry.seated) else { return };
        self.seated -= 1;
        if let Some(seats) = self.shares.get_mut(&entry.party) {
            *seats -= 1;
            if *seats == 0 {
                self.shares.remove(&entry.party);
            }
        }
    }

    /// Closes the selected connection that has waited longest for its other end, if it has waited
    /// for at least `patience`; returns true if there was one.
    fn evict_waiting(&mut self, patience: Duration, of: impl Fn(&SlotEntry) -> bool) -> bool {
        let now = Instant::now();
        let waited = self.entries.iter().filter(|(_, entry)| of(entry));
        // Connections for which the server works have no waiting time and are never chosen.
        let waited = waited.filter_map(|(id, entry)| Some((entry.pace.stuck_time(now)?, *id)));
        let Some((_, id)) = waited.filter(|(waited, _)| *waited >= patience).max() else {
            return false;
        };
        // Tested again under the lock of the connection: it may have made progress meanwhile.
        let cut = self.entries.get(&id).is_some_and(|entry| entry.pace.cut_if_stuck());
        if cut {
            self.remove(id);
        }
        cut
    }
}

impl Permit {
    /// Returns true if a request may be processed. A connection in the reserve waits a while for a
    /// permit.
    pub(super) async fn wait_for_permit(&self) -> bool {
        let until = Instant::now() + MAX_PERMIT_WAIT;
        loop {
            match self.try_promote() {
                Some(true) => return true,
                Some(false) if Instant::now() < until => {}
                _ => return false,
            }
            // A freed permit wakes this early; the timeout finds connections that have become slow.
            drop(tokio::time::timeout(POLL_INTERVAL, self.seats.freed.notified()).await);
        }
    }

    /// Tries to get a permit: true with one, false if waiting may help, none otherwise.
    fn try_promote(&self) -> Option<bool> {
        let mut table = self.seats.lock_table();
        let entry = table.entries.get(&self.id)?;
        let (party, seated) = (entry.party, entry.seated);
        if seated {
            return Some(true);
        }
        if !self.seats.free_permit(&mut table, party) {
            // With half of the reserve in use, further requests are refused at once.
            return (table.entries.len() - table.seated <= RESERVE / 2).then_some(false);
        }
        table.entries.get_mut(&self.id)?.seated = true;
        table.count_permit(party);
        Some(true)
    }
}

impl Drop for Permit {
    fn drop(&mut self) {
        self.seats.lock_table().remove(self.id);
        self.seats.freed.notify_one();
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn seats(connections: usize, share: usize) -> (ConnectionLimits, Arc<ConnectionSlots>) {
        let limits = ConnectionLimits {
            connections,
            connections_per_address: share,
            ..ConnectionLimits::default()
        };
        (limits, ConnectionSlots::new(&limits))
    }

    fn from(last: u8) -> IpAddr {
        [10, 0, 0, last].into()
    }

    #[tokio::test]
    async fn who_lets_the_server_wait_longest_gives_way_and_who_waits_for_it_never() {
        let (limits, seats) = seats(2, 2);
        let paces: Vec<_> = (0..3).map(|_| Arc::new(ConnectionProgress::new(&limits))).collect();
        let busy = seats.admit(from(1), &paces[0]).unwrap();
        paces[0].begin_request();
        let idle = seats.admit(from(1), &paces[1]).unwrap();
        assert!(busy.wait_for_permit().await && idle.wait_for_permit().await);
        tokio::time::sleep(TOLERATED_WAIT).await;
        let new = seats.admit(from(2), &paces[2]).unwrap();
        paces[2].begin_request();
        assert!(new.wait_for_permit().await && paces[1].is_cut() && !paces[0].is_cut());
        let refused = seats.admit(from(3), &Arc::new(ConnectionProgress::new(&limits))).unwrap();
        assert!(!refused.wait_for_permit().await, "both seats are at work");
        drop(busy);
        assert!(refused.wait_for_permit().await);
    }

    #[tokio::test]
    async fn an_address_has_its_share_and_no_more() {
        let (limits, seats) = seats(4, 2);
        let pace = |begun: bool| {
            let pace = Arc::new(ConnectionProgress::new(&limits));
            if begun {
                pace.begin_request();
            }
            pace
        };
        let held: Vec<_> = (0..3).map(|_| seats.admit(from(1), &pace(true)).unwrap()).collect();
        assert!(!held[2].wait_for_permit().await, "the third of two");
        let other = seats.admit(from(2), &pace(true)).unwrap();
        assert!(other.wait_for_permit().await, "others have their seats");
    }

    #[tokio::test]
    async fn the_reserve_is_bounded() {
        let (limits, seats) = seats(1, 1);
        let busy = || {
            let pace = Arc::new(ConnectionProgress::new(&limits));
            pace.begin_request();
            pace
        };
        let held: Vec<_> = (0..=RESERVE).map(|_| seats.admit(from(1), &busy()).unwrap()).collect();
        assert!(seats.admit(from(1), &busy()).is_none());
        let start = Instant::now();
        assert!(
            !held[RESERVE].wait_for_permit().await && start.elapsed() < MAX_PERMIT_WAIT / 2,
            "where many wait, nobody waits longer"
        );
    }
}
