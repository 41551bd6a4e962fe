#![allow(clippy::unwrap_used)]
use rand::SeedableRng;
use rand_chacha::ChaCha12Rng;
use rand_distr::{Distribution, StandardNormal};
use sistership_model::coefficient::Axis;

use super::*;
use crate::statistics::{self, RegressionStatistics, TrialStatistics};
use sistership_numerics::RegressionMoments;

/// Members with two coefficients that go together, `(1, -2)` in the mean, deviations 0.3 and 0.6,
/// correlation 0.8.
fn draw(rng: &mut ChaCha12Rng) -> [f64; 2] {
    let normal: [f64; 2] = std::array::from_fn(|_| StandardNormal.sample(rng));
    [1.0 + 0.3 * normal[0], -2.0 + 0.6 * (0.8 * normal[0] + 0.6 * normal[1])]
}

/// A trial that excites both, or the first only; noise is the same for `repeat` samples on end.
fn trial(
    rng: &mut ChaCha12Rng,
    own: [f64; 2],
    samples: usize,
    second: bool,
    repeat: usize,
) -> TrialStatistics {
    let mut columns = vec![Vec::new(); 3];
    let mut noise = [0.0; 3];
    for k in 0..samples {
        if k % repeat == 0 {
            noise = std::array::from_fn(|_| StandardNormal.sample(rng));
        }
        let (x, z) = (noise[0], if second { noise[1] } else { 0.0 });
        columns[0].push(x);
        columns[1].push(z);
        columns[2].push(own[0] * x + own[1] * z + 0.5 * noise[2]);
    }
    let regression = RegressionStatistics {
        axes: vec![Axis::N],
        names: vec![vec!["N_v".into(), "N_r".into()]],
        shrinkage: vec![1.0; 2],
        mixing: vec![vec![1.0]],
        moments: RegressionMoments::from_columns(&columns, 2),
    };
    TrialStatistics {
        format: statistics::FORMAT.into(),
        duration_s: samples as f64,
        regressions: vec![regression],
    }
}

fn family(
    rng: &mut ChaCha12Rng,
    members: usize,
    samples: usize,
    repeat: usize,
) -> Vec<(String, Vec<TrialStatistics>)> {
    let mut member = |index: usize| {
        let own = draw(rng);
        let second = !index.is_multiple_of(4);
        (
            format!("ship-{index:03}"),
            (0..3).map(|_| trial(rng, own, samples, second, repeat)).collect(),
        )
    };
    (0..members).map(&mut member).collect()
}

fn learned(family: &[(String, Vec<TrialStatistics>)]) -> Result<FamilyPrior, FamilyError> {
    let members: Vec<FamilyMember<'_>> =
        family.iter().map(|(name, trials)| FamilyMember { name, trials }).collect();
    learn_family(&members)
}

#[test]
fn mean_and_covariance_come_back_though_no_member_tells_all() {
    let mut rng = ChaCha12Rng::seed_from_u64(3);
    let prior = learned(&family(&mut rng, 300, 40, 1)).unwrap();
    let axis = &prior.axes[0];
    let near = |value: f64, truth: f64, within: f64| {
        assert!((value - truth).abs() < within, "{value} {truth} {axis:?}")
    };
    near(axis.mean[0], 1.0, 0.06);
    near(axis.mean[1], -2.0, 0.12);
    near(axis.deviation[0], 0.3, 0.05);
    near(axis.deviation[1], 0.6, 0.1);
    near(axis.correlation[0][1], 0.8, 0.12);
    assert!(prior.design_effect < 1.4, "{}", prior.design_effect);
    assert!(
        axis.told_by_trials[0] > axis.told_by_trials[1],
        "a quarter of the members do not excite the second"
    );
}

#[test]
fn samples_that_repeat_each_other_count_once() {
    let mut rng = ChaCha12Rng::seed_from_u64(4);
    let prior = learned(&family(&mut rng, 120, 400, 10)).unwrap();
    assert!((6.0..14.0).contains(&prior.design_effect), "{}", prior.design_effect);
    assert!((prior.axes[0].deviation[0] - 0.3).abs() < 0.06, "{:?}", prior.axes[0]);
}

#[test]
fn few_members_keep_little_of_their_correlations_and_a_document_comes_back() {
    let mut rng = ChaCha12Rng::seed_from_u64(5);
    let few = learned(&family(&mut rng, 4, 40, 1)).unwrap();
    assert!((few.correlations_kept - 4.0 / 7.0).abs() < 1e-12);
    let read: FamilyPrior = serde_json::from_str(&serde_json::to_string(&few).unwrap()).unwrap();
    assert!(read == few);
    let axis = &read.axis_priors().unwrap()[0];
    let variance = (&axis.root * axis.root.transpose())[(1, 1)];
    assert!((variance.sqrt() / few.axes[0].deviation[1] - 1.0).abs() < 1e-9);
}

#[test]
fn what_is_no_family_is_refused() {
    let mut rng = ChaCha12Rng::seed_from_u64(6);
    let mut all = family(&mut rng, 4, 40, 1);
    assert_eq!(learned(&all[..2]), Err(FamilyError::Few(2)));
    all[3].1.iter_mut().for_each(|trial| trial.regressions[0].names[0][1] = "N_vvv".into());
    let refusal = learned(&all).unwrap_err().to_string();
    assert!(refusal.contains("`ship-003` and"), "{refusal}");
    assert!(refusal.contains("have different coefficients"), "{refusal}");
}

/// A member whose axes cannot be told apart is named, not left out.
#[test]
fn statistics_that_cannot_be_unmixed_are_refused_with_their_member() {
    let mut rng = ChaCha12Rng::seed_from_u64(6);
    let mut all = family(&mut rng, 5, 40, 1);
    all[2].1.iter_mut().for_each(|trial| trial.regressions[0].mixing = vec![vec![0.0]]);
    let refusal = learned(&all).unwrap_err().to_string();
    assert!(refusal.contains("the statistics of `ship-002` cannot be used"), "{refusal}");
    assert!(refusal.contains("cannot be separated"), "{refusal}");
}
