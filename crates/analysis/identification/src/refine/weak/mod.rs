//! The weak form: the equations of motion multiplied by a smooth bump function and integrated by
//! parts, so that no measurement error is differentiated (Messenger and Bortz 2021, Multiscale
//! Model Simul 19, 1474-1497, Eqs. 2.4-2.6).
//!
//! With a bump `b(t)` that vanishes with its slope at both ends of a window, `M dv/dt = sum c_i
//! phi_i + rest` becomes `-int v d(b M)/dt dt = sum c_i int b phi_i dt + int b rest dt`: a linear
//! regression with one row a window.

mod averaging;
mod bump;
mod estimator;
mod samples;
mod thresholds;

use sistership_model::trial::Trial;

pub use bump::WindowSpacing;
pub(super) use estimator::{WeakForm, resolve_windows, window_form};

use super::blocks::{RegressionBlock, RegressionBlocks};
use super::outcome::RefineError;
use super::rows::RegressionTable;
use averaging::average_samples;
use bump::BumpFunction;
use samples::{SampledRegression, sample_columns};
use sistership_numerics::RegressionMoments;

/// Returns the statistics of one trial in weak form about zero, one set for each regression; no
/// window crosses a gap. Windows overlap, so that each counts as its own share of time.
///
/// # Errors
/// Returns an error with the channel that the trial lacks.
pub fn weak_moments(
    blocks: &RegressionBlocks,
    trial: &Trial,
    windows: WindowSpacing,
) -> Result<Vec<RegressionMoments>, RefineError> {
    let tables = weak_tables(blocks, trial, windows)?;
    let share = windows.effective_share(trial.interval_s());
    let of = |(block, table): (&RegressionBlock, &RegressionTable)| {
        RegressionMoments::about_zero(table, block.regressor_count(), share)
    };
    Ok(blocks.blocks.iter().zip(&tables).map(of).collect())
}

/// Returns the rows behind [`weak_moments`]: for each regression its columns over the windows,
/// regressors then targets, in the mean over the bump.
///
/// # Errors
/// As [`weak_moments`].
pub fn weak_tables(
    blocks: &RegressionBlocks,
    trial: &Trial,
    windows: WindowSpacing,
) -> Result<Vec<RegressionTable>, RefineError> {
    let averaged = average_samples(trial, windows.length_s);
    let trial = averaged.as_ref().unwrap_or(trial);
    let sampled = sample_columns(blocks, trial)?;
    let mut tables: Vec<RegressionTable> =
        blocks.blocks.iter().map(|b| vec![Vec::new(); b.column_count()]).collect();
    for bump in windows.bumps_over(trial) {
        sampled
            .iter()
            .zip(&mut tables)
            .for_each(|(columns, table)| append_window(columns, &bump, table));
    }
    Ok(tables)
}

/// Appends the row of one window.
fn append_window(
    columns: &SampledRegression<'_>,
    bump: &BumpFunction,
    table: &mut RegressionTable,
) {
    let (regressors, targets) = table.split_at_mut(columns.regressors.len());
    for (out, column) in regressors.iter_mut().zip(&columns.regressors) {
        out.push(bump.mean(column));
    }
    for (out, target) in targets.iter_mut().zip(&columns.targets) {
        let momentum: f64 = target
            .inertia
            .iter()
            .map(|(mass, velocity)| bump.mean_rate(mass.as_deref(), velocity))
            .sum();
        out.push(momentum - bump.mean(&target.rest));
    }
}

#[cfg(test)]
mod tests;
