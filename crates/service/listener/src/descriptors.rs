//! File descriptors of the process: as many as its connections need, else fewer connections.

use crate::limits::ConnectionLimits;
use crate::slots::RESERVE;

/// Descriptors other than those of connections: database, samples, uploads, the log.
const OTHER_DESCRIPTORS: usize = 128;

/// Minimum number of connections of a useful server.
const FEWEST: usize = 16;

/// Returns the limits for which the system has file descriptors, after raising the limit of the
/// process as far as possible.
pub fn fit_to_descriptors(limits: ConnectionLimits) -> ConnectionLimits {
    let Some(have) = raised(needed_by(&limits)) else { return limits };
    let fit = reduced_limits(limits, have);
    if fit != limits {
        let needed = needed_by(&limits);
        tracing::warn!(
            have,
            needed,
            connections = fit.connections,
            "too few file descriptors for the configured number of connections; raise `ulimit -n`"
        );
    }
    fit
}

/// Returns the number of descriptors that a server with these limits needs.
fn needed_by(limits: &ConnectionLimits) -> usize {
    limits.connections + RESERVE + OTHER_DESCRIPTORS
}

fn reduced_limits(mut limits: ConnectionLimits, have: usize) -> ConnectionLimits {
    let lacking = needed_by(&limits).saturating_sub(have);
    // At least a minimum, unless fewer were configured.
    limits.connections =
        limits.connections.saturating_sub(lacking).max(FEWEST.min(limits.connections));
    limits.connections_per_address = limits.connections_per_address.min(limits.connections);
    limits
}

/// Raises the limit of descriptors to `needed` where possible; returns the limit, none if there is
/// no limit.
#[cfg(unix)]
fn raised(needed: usize) -> Option<usize> {
    use rustix::process::{Resource, getrlimit, setrlimit};
    let (mut limit, needed) = (getrlimit(Resource::Nofile), needed as u64);
    if limit.current.is_some_and(|current| current < needed) {
        limit.current = Some(limit.maximum.map_or(needed, |most| most.min(needed)));
        if let Err(error) = setrlimit(Resource::Nofile, limit) {
            tracing::warn!(%error, "the limit of file descriptors cannot be raised");
        }
    }
    getrlimit(Resource::Nofile).current.and_then(|current| usize::try_from(current).ok())
}

#[cfg(not(unix))]
fn raised(_: usize) -> Option<usize> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn connections_fit_the_descriptors() {
        let limits = ConnectionLimits::default();
        assert_eq!(reduced_limits(limits, 1 << 20), limits);
        let fit = reduced_limits(limits, 600);
        assert_eq!(needed_by(&fit), 600);
        assert!(fit.connections_per_address <= fit.connections);
        assert_eq!(reduced_limits(limits, 10).connections, FEWEST);
    }
}
