//! The steady parts of turning circles.

use std::f64::consts::{FRAC_PI_2, PI};
use std::ops::Range;

use sistership_model::trial::{Channel, Trial};

/// Changes of heading after which a turn may be steady: speed and yaw rate are after 90 to 180 degrees
/// (MSC/Circ.1053, appendix), those of large ships later.
const UNSTEADY_RAD: [f64; 3] = [FRAC_PI_2, PI, 1.5 * PI];
/// Least change of heading in the steady part.
const LEAST_RAD: f64 = 1.25 * PI;
/// Largest deviation of the yaw rate from its upper quartile within a turn, as a fraction of it.
const UNEVEN: f64 = 0.35;

/// Samples of a steady turn, and the change of heading over them.
pub(super) struct SteadyTurn {
    pub samples: Range<usize>,
    pub turned_rad: f64,
}

/// Returns the turns of a trial, in which the heading changes in one direction at an even rate; of
/// each the parts that may be steady, the earliest first.
pub(super) fn steady_turns(trial: &Trial) -> Vec<Vec<SteadyTurn>> {
    let (Some(psi), Some(r)) = (trial.channel(Channel::Psi), trial.channel(Channel::R)) else {
        return Vec::new();
    };
    let turns = trial.segments().into_iter().flat_map(|segment| even_runs(r, segment));
    let parts = turns.map(|turn| {
        let part = |unsteady_rad: f64| {
            let begun = turn.clone().find(|&k| (psi[k] - psi[turn.start]).abs() > unsteady_rad)?;
            let turned_rad = (psi[turn.end - 1] - psi[begun]).abs();
            // Whole turns are not needed: the velocity that turns with the ship is fitted as well.
            (turned_rad > LEAST_RAD).then_some(SteadyTurn { samples: begun..turn.end, turned_rad })
        };
        UNSTEADY_RAD.into_iter().filter_map(part).collect()
    });
    parts.collect()
}

/// Returns the runs of samples that turn to one side at around the usual rate.
fn even_runs(r: &[f64], segment: Range<usize>) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    for side in [1.0, -1.0] {
        // The approach and the pull-out are in the record too, so that a mean would be too small.
        let usual = upper_quartile(r[segment.clone()].iter().map(|r| side * r));
        let turns = |k: &usize| usual > 0.0 && side * r[*k] > (1.0 - UNEVEN) * usual;
        for k in segment.clone().filter(turns) {
            match runs.last_mut().filter(|last| last.end == k) {
                // The next sample of the same run.
                Some(last) => last.end = k + 1,
                None => runs.push(k..k + 1),
            }
        }
    }
    runs
}

fn upper_quartile(values: impl Iterator<Item = f64>) -> f64 {
    let mut sorted: Vec<f64> = values.filter(|value| value.is_finite()).collect();
    sorted.sort_unstable_by(f64::total_cmp);
    sorted.get(sorted.len() * 3 / 4).copied().unwrap_or(0.0)
}
