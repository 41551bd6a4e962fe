use super::*;

fn near(own: f64, other: f64) {
    assert!((own - other).abs() < 1e-12 * (1.0 + other.abs()), "{own} not {other}");
}

#[test]
fn a_point_outside_pays_by_the_square_of_how_far() {
    let mut bounds = BoundPenalty::new(&[1.0, 2.0, 3.0]);
    bounds.weights = vec![2.0, 3.0, 5.0];
    assert_eq!(bounds.nearest_inside(&[-4.0, 1.5, 3.5]), [-1.0, 1.5, 3.0]);
    // (2 * 3^2 + 3 * 0 + 5 * 0.5^2) / 3.
    near(bounds.penalty_at(&[-4.0, 1.5, 3.5]), (18.0 + 1.25) / 3.0);
    assert_eq!(bounds.penalty_at(&[1.0, -2.0, 3.0]), 0.0);
}

#[test]
fn the_distance_between_quartiles() {
    near(interquartile_range(&[8.0, 1.0, 7.0, 2.0, 6.0, 3.0, 5.0, 4.0]), 7.0 - 3.0);
    near(interquartile_range(&[5.0, 1.0, 2.0]), 5.0 - 2.0);
    assert_eq!(interquartile_range(&[]), 0.0);
}

/// Costs of which the quartiles are so far apart.
fn costs(apart: f64) -> Vec<f64> {
    (1..=8).map(|k| 0.25 * apart * f64::from(k)).collect()
}

/// Weights begin at twice the spread of the costs by the variance of the coordinates, once the mean
/// is outside.
#[test]
fn weights_begin_when_the_mean_is_outside() {
    let mut bounds = BoundPenalty::new(&[1.0, 1.0]);
    bounds.adapt_weights(&EvolutionStrategy::new(&[0.5, 1.0], 0.5, 8, 1), &costs(3.0));
    assert_eq!((bounds.weights.clone(), bounds.begun), (vec![1.0, 1.0], false));
    bounds.adapt_weights(&EvolutionStrategy::new(&[0.5, -1.25], 0.5, 8, 1), &costs(3.0));
    assert!(bounds.begun);
    // The variance of each coordinate is 0.25.
    bounds.weights.iter().for_each(|weight| near(*weight, 2.0 * 3.0 / 0.25));
}

/// What is far outside weighs more from generation to generation, what weighs too much less.
#[test]
fn weights_grow_where_the_mean_is_far_outside_and_fall_from_five_spreads() {
    let strategy = EvolutionStrategy::new(&[9.0, 0.0], 0.5, 8, 1);
    let mut bounds = BoundPenalty::new(&[1.0, 1.0]);
    bounds.adapt_weights(&strategy, &costs(1.0));
    let (mass, typical) = (strategy.selection_mass(), 1.0 / 0.25);
    let damping = (mass / 20.0).min(1.0);
    let allowed = 3.0 * (2.0_f64.sqrt() / mass).max(1.0);
    // The mean is 8 outside, 16 deviations.
    let grown = (0.5 * damping * ((16.0 - allowed) / 3.0).tanh()).exp();
    near(bounds.weights[0], 2.0 * typical * grown);
    near(bounds.weights[1], 2.0 * typical);
    bounds.weights[1] = 5.5 * typical;
    bounds.adapt_weights(&strategy, &costs(1.0));
    near(bounds.weights[0], 2.0 * typical * grown * grown);
    near(bounds.weights[1], 5.5 * typical * (-damping / 3.0).exp());
}

/// The typical spread is the median of so many; what is no number is none.
#[test]
fn spreads_are_remembered_for_a_while() {
    let mut bounds = BoundPenalty::new(&[1.0; 4]);
    let strategy = EvolutionStrategy::new(&[0.0; 4], 1.0, 8, 1);
    bounds.adapt_weights(&strategy, &[f64::INFINITY; 8]);
    bounds.adapt_weights(&strategy, &[2.0; 8]);
    assert!(bounds.spreads.is_empty());
    for apart in 1..=30 {
        bounds.adapt_weights(&strategy, &costs(f64::from(apart)));
    }
    // 20 + 3 n / count.
    assert_eq!(bounds.spreads.len(), 21);
    near(bounds.spreads[0], 30.0);
    bounds.adapt_weights(&EvolutionStrategy::new(&[2.0, 0.0, 0.0, 0.0], 1.0, 8, 1), &costs(31.0));
    bounds.weights.iter().for_each(|weight| near(*weight, 2.0 * 21.0));
}
