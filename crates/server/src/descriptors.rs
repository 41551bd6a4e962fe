//! The descriptors that a process may open: as many as its connections need, or fewer connections.

use crate::config::Limits;
use crate::listen;

/// The least that a server is of use with.
const FEWEST: usize = 16;

/// The limits that the system has descriptors for. The process' own bound is raised as far as it may be.
pub(crate) fn suited(limits: Limits) -> Limits {
    let Some(have) = raised(listen::descriptors(&limits)) else { return limits };
    let fit = fitting(limits, have);
    if fit != limits {
        let needed = listen::descriptors(&limits);
        tracing::warn!(
            have,
            needed,
            connections = fit.connections,
            "too few file descriptors for the connections that are set; raise `ulimit -n`"
        );
    }
    fit
}

fn fitting(mut limits: Limits, have: usize) -> Limits {
    let lacking = listen::descriptors(&limits).saturating_sub(have);
    limits.connections = limits.connections.saturating_sub(lacking).max(FEWEST.min(limits.connections));
    limits.connections_per_address = limits.connections_per_address.min(limits.connections);
    limits
}

/// What the process may open; none for no bound. Raised to what it needs where the system lets it.
#[cfg(unix)]
fn raised(needed: usize) -> Option<usize> {
    use rustix::process::{Resource, getrlimit, setrlimit};
    let (mut limit, needed) = (getrlimit(Resource::Nofile), needed as u64);
    if limit.current.is_some_and(|current| current < needed) {
        limit.current = Some(limit.maximum.map_or(needed, |most| most.min(needed)));
        if let Err(error) = setrlimit(Resource::Nofile, limit) {
            tracing::warn!(%error, "the bound on file descriptors cannot be raised");
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
        let limits = Limits::default();
        assert_eq!(fitting(limits, 1 << 20), limits);
        let fit = fitting(limits, 600);
        assert_eq!(listen::descriptors(&fit), 600);
        assert!(fit.connections_per_address <= fit.connections);
        assert_eq!(fitting(limits, 10).connections, FEWEST);
    }
}
