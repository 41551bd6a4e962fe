//! Drift of a champion over the newest trials since it was fitted.

use super::drift::{Drift, TrialResidual};
use crate::condition::{DRIFT_LIMIT, MAX_JOINT_TRIALS, RecentDrift};

impl Drift {
    /// Returns the drift over the newest trials; `None` if there are no new trials, or if the
    /// champion was fitted on none.
    pub fn over_newest(&self) -> Option<RecentDrift> {
        let last = self.trials.iter().rposition(|trial| trial.fitted)?;
        let new = &self.trials[last + 1..];
        let new = &new[new.len().saturating_sub(MAX_JOINT_TRIALS)..];
        // Per axis: RMS over the new trials divided by RMS over the fitted ones; the worst axis
        // counts.
        let ratios = self.ratio.keys().filter_map(|axis| {
            let fitted = self.trials.iter().filter(|trial| trial.fitted);
            let before = root_mean_square(fitted, axis).filter(|before| *before > 0.0)?;
            Some((axis, before, root_mean_square(new.iter(), axis)? / before))
        });
        let (axis, before, ratio) = ratios.max_by(|a, b| a.2.total_cmp(&b.2))?;
        let is_above = |trial: &&TrialResidual| {
            trial.residual.get(axis).is_some_and(|left| left / before > DRIFT_LIMIT)
        };
        let since = new.iter().find(is_above).filter(|_| ratio > DRIFT_LIMIT);
        let since = since.map(|trial| trial.trial.clone());
        Some(RecentDrift { ratio, axis: axis.clone(), since })
    }
}

fn root_mean_square<'a>(
    trials: impl Iterator<Item = &'a TrialResidual>,
    axis: &str,
) -> Option<f64> {
    let squares: Vec<f64> =
        trials.filter_map(|trial| trial.residual.get(axis)).map(|left| left * left).collect();
    (!squares.is_empty()).then(|| (squares.iter().sum::<f64>() / squares.len() as f64).sqrt())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use std::collections::BTreeMap;

    use super::*;

    fn drift(residuals: &[(bool, f64)]) -> Drift {
        let trial = |(at, &(fitted, left)): (usize, &(bool, f64))| TrialResidual {
            trial: format!("{at:02}"),
            name: String::new(),
            at_us: 0,
            fitted,
            residual: BTreeMap::from([("N".to_owned(), left)]),
        };
        Drift {
            ship: "kcs".into(),
            version: 1,
            ratio: BTreeMap::from([("N".to_owned(), 1.0)]),
            worst: None,
            trials: residuals.iter().enumerate().map(trial).collect(),
            reason: None,
        }
    }

    #[test]
    fn the_newest_trials_are_measured_by_the_fitted_ones() {
        let new = |residuals: &[(bool, f64)]| drift(residuals).over_newest();
        let found = new(&[(true, 0.1), (false, 0.1), (false, 0.5), (false, 0.5)]).unwrap();
        assert!(found.is_above_limit(), "{found:?}");
        assert_eq!((found.axis.as_str(), found.since.as_deref()), ("N", Some("02")));
        let holds = new(&[(true, 0.1), (false, 0.15)]).unwrap();
        assert!((holds.ratio - 1.5).abs() < 1e-12 && holds.since.is_none());
        assert_eq!(new(&[(false, 0.1)]), None, "fitted on none");
        assert_eq!(new(&[(false, 0.9), (true, 0.1)]), None, "nothing is new");
    }

    #[test]
    fn what_was_put_right_is_forgotten() {
        let mut residuals = vec![(true, 0.1), (false, 0.9)];
        residuals.extend([(false, 0.1); MAX_JOINT_TRIALS]);
        assert!(!drift(&residuals).over_newest().unwrap().is_above_limit());
    }
}
