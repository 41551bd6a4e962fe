//! Budget of a search.

use std::time::Instant;

/// Limits of a search; the first limit that is reached ends it after the current generation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SearchBudget {
    /// Number of evaluations.
    pub evaluations: usize,
    /// Largest elapsed time, s.
    pub wall_s: Option<f64>,
    /// Largest processor time of this process on all cores, s, including its other work; ignored if
    /// the system does not report it.
    pub cpu_s: Option<f64>,
}

/// Resources that a search has used.
#[derive(Debug, Clone, Copy)]
pub struct SearchUsage {
    /// Largest number of evaluations.
    pub evaluations: usize,
    begun: Instant,
    cpu_s: Option<f64>,
}

impl SearchUsage {
    /// Starts counting, without any evaluation.
    pub fn start_now() -> Self {
        Self { evaluations: 0, begun: Instant::now(), cpu_s: process_s() }
    }

    /// Elapsed time since the start, s.
    pub fn wall_s(&self) -> f64 {
        self.begun.elapsed().as_secs_f64()
    }

    /// Processor time of this process since the start, s; `None` if the system does not report it.
    pub fn cpu_s(&self) -> Option<f64> {
        Some(process_s()? - self.cpu_s?)
    }

    /// Used share of the budget: 1 or more when it is used up.
    pub fn used_share(&self, budget: &SearchBudget) -> f64 {
        let wall = budget.wall_s.map_or(0.0, |limit| self.wall_s() / limit);
        let cpu = budget.cpu_s.zip(self.cpu_s()).map_or(0.0, |(limit, spent)| spent / limit);
        (self.evaluations as f64 / budget.evaluations.max(1) as f64).max(wall).max(cpu)
    }
}

/// Processor time of this process on all cores, s.
#[cfg(unix)]
fn process_s() -> Option<f64> {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    Some(time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64)
}

#[cfg(not(unix))]
fn process_s() -> Option<f64> {
    None
}
