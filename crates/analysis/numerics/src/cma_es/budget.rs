//! When a search has had enough.

use std::time::Instant;

/// Limits of a search; the first that is reached ends it after the generation in which that
/// happens.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Budget {
    /// Evaluations.
    pub evaluations: usize,
    /// Time on the wall, s.
    pub wall_s: Option<f64>,
    /// Time of this process on all cores, s, whatever else the process does meanwhile; not kept
    /// where the system does not say.
    pub cpu_s: Option<f64>,
}

/// What a search has spent.
#[derive(Debug, Clone, Copy)]
pub struct Spent {
    /// Evaluations.
    pub evaluations: usize,
    begun: Instant,
    cpu_s: Option<f64>,
}

impl Spent {
    /// Nothing yet.
    pub fn nothing() -> Self {
        Self { evaluations: 0, begun: Instant::now(), cpu_s: process_s() }
    }

    /// Time on the wall since the beginning, s.
    pub fn wall_s(&self) -> f64 {
        self.begun.elapsed().as_secs_f64()
    }

    /// Time of this process since the beginning, s; none where the system does not say.
    pub fn cpu_s(&self) -> Option<f64> {
        Some(process_s()? - self.cpu_s?)
    }

    /// The share of the budget that is gone: 1 or more where it is used up.
    pub fn share(&self, budget: &Budget) -> f64 {
        let wall = budget.wall_s.map_or(0.0, |limit| self.wall_s() / limit);
        let cpu = budget.cpu_s.zip(self.cpu_s()).map_or(0.0, |(limit, spent)| spent / limit);
        (self.evaluations as f64 / budget.evaluations.max(1) as f64).max(wall).max(cpu)
    }
}

/// Time of this process on all cores, s.
#[cfg(unix)]
fn process_s() -> Option<f64> {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    Some(time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64)
}

#[cfg(not(unix))]
fn process_s() -> Option<f64> {
    None
}
