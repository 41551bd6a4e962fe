#![allow(clippy::unwrap_used)]
use super::*;
use sistership_identification::testing::{mariner_model, simulated_trials};
use sistership_model::Model;

#[test]
fn a_document_keeps_every_bit_and_refuses_damage() {
    let (model, law) = mariner_model();
    let frame = RegressionFrame::new(&model, &law, "law", None).unwrap();
    let statistics =
        TrialStatistics::from_trial(&frame, &simulated_trials(&model, &law, 0.0)[0]).unwrap();
    let text = serde_json::to_string(&statistics).unwrap();
    let read: TrialStatistics = serde_json::from_str(&text).unwrap();
    assert!(read == statistics);
    read.check_consistency().unwrap();
    assert!(
        text.len() < 10_000,
        "{} bytes for {} coefficients",
        text.len(),
        model.coefficients.len()
    );
    assert!(
        serde_json::from_str::<TrialStatistics>(&text.replace("\"targets\":2", "\"targets\":1"))
            .is_err()
    );
    let mut short = read.clone();
    short.regressions[1].names[0].pop();
    assert!(
        short
            .check_consistency()
            .unwrap_err()
            .to_string()
            .contains("lengths of its lists do not match")
    );
}

#[test]
fn the_key_is_of_everything_that_shapes_a_row_and_of_nothing_else() {
    let (model, law) = mariner_model();
    let key = |model: &Model, law_sha256: &str, difference_s: Option<f64>, trial: &str| {
        RegressionFrame::new(model, &law, law_sha256, difference_s).unwrap().statistics_key(trial)
    };
    let own = key(&model, "a", None, "t");
    let mut refined = model.clone();
    refined.coefficients.values_mut().for_each(|quantity| quantity.value *= 2.0);
    assert_eq!(key(&refined, "a", None, "t"), own, "values of coefficients shape no row");
    let mut longer = model.clone();
    longer.parameters.get_mut("m").unwrap().value *= 1.01;
    let mut fewer = model.clone();
    fewer.coefficients.remove("N_uu");
    let others = [
        key(&model, "b", None, "t"),
        key(&model, "a", Some(1.0), "t"),
        key(&model, "a", None, "s"),
        key(&longer, "a", None, "t"),
        key(&fewer, "a", None, "t"),
    ];
    assert!(others.iter().all(|other| *other != own));
}

#[test]
fn the_true_coefficients_leave_what_the_difference_leaves() {
    let (model, law) = mariner_model();
    let frame = RegressionFrame::new(&model, &law, "law", Some(1.0)).unwrap();
    let statistics =
        TrialStatistics::from_trial(&frame, &simulated_trials(&model, &law, 0.0)[1]).unwrap();
    let values = |factor: f64| {
        model.coefficients.iter().map(|(name, q)| (name.clone(), factor * q.value)).collect()
    };
    let share = |factor: f64| -> Vec<f64> {
        statistics
            .axis_residuals(&values(factor))
            .unwrap()
            .iter()
            .map(|left| (left.residual / left.target).sqrt())
            .collect()
    };
    let (right, wrong) = (share(1.0), share(1.3));
    assert!(right.iter().all(|share| *share < 0.12), "{right:?}");
    assert!(
        right.iter().zip(&wrong).all(|(right, wrong)| wrong > &(2.0 * right)),
        "{right:?} {wrong:?}"
    );
}
