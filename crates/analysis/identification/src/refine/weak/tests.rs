#![allow(clippy::unwrap_used)]
use super::*;
use sistership_model::trial::Channel;

fn uneven() -> Vec<f64> {
    (0..400).map(|k| 0.1 * f64::from(k) + 0.02 * (0.7 * f64::from(k)).sin()).collect()
}

#[test]
fn a_rate_by_parts_is_the_mean_rate_under_the_bump() {
    let trial = Trial { t_s: uneven(), ..Trial::default() };
    let column = |f: &dyn Fn(f64) -> f64| trial.t_s.iter().map(|t| f(*t)).collect::<Vec<f64>>();
    let (wave, slope) = (column(&|t| (0.5 * t).sin()), column(&|t| 0.5 * (0.5 * t).cos()));
    let (mass, moving) =
        (column(&|t| 2.0 + 0.1 * t), column(&|t| (2.0 + 0.1 * t) * 0.5 * (0.5 * t).cos()));
    for bump in (WindowSpacing { length_s: 10.0, hop_s: 1.0 }).bumps_over(&trial) {
        assert!((bump.mean_rate(None, &wave) - bump.mean(&slope)).abs() < 2e-4);
        assert!((bump.mean_rate(Some(&mass), &wave) - bump.mean(&moving)).abs() < 1e-3);
        assert!(bump.mean_rate(None, &vec![3.0; 400]).abs() < 1e-12);
        assert!((bump.mean(&vec![3.0; 400]) - 3.0).abs() < 1e-12);
    }
}

#[test]
fn windows_do_not_reach_over_gaps() {
    let t_s: Vec<f64> = (0..100).map(|k| f64::from(k) + if k < 40 { 0.0 } else { 30.0 }).collect();
    let trial = Trial { t_s, ..Trial::default() };
    let windows = WindowSpacing { length_s: 10.0, hop_s: 2.0 };
    assert_eq!(windows.bumps_over(&trial).len(), 15 + 25);
    let short = Trial { t_s: vec![0.0, 1.0, 2.0], ..Trial::default() };
    assert!(windows.bumps_over(&short).is_empty());
}

/// A ship of one axis whose speed decays by a known law, with noise that ruins differences.
#[test]
fn a_known_resistance_is_found_through_noise() {
    use sistership_model::{Law, Model, Zoo};
    let zoo = Zoo::load_embedded().unwrap();
    let model: Model = zoo.find_model("mariner").unwrap();
    let law: &Law = zoo.law(&model.law).unwrap();
    let blocks = RegressionBlocks::new(&model, law).unwrap();
    let mut trial =
        Trial { t_s: (0..3000).map(|k| 0.1 * f64::from(k)).collect(), ..Trial::default() };
    let noise = |k: usize| 0.02 * (12.9898 * k as f64).sin();
    trial
        .channels
        .insert(Channel::U, (0..3000).map(|k| 7.0 + (0.02 * k as f64).cos() + noise(k)).collect());
    for channel in [Channel::V, Channel::R, Channel::Delta] {
        trial.channels.insert(channel, vec![0.0; 3000]);
    }
    let table =
        &weak_tables(&blocks, &trial, WindowSpacing { length_s: 10.0, hop_s: 1.0 }).unwrap()[0];
    let target = table.last().unwrap();
    // The rate of cos(0.2 t) in the mean under each bump.
    let worst = target.iter().enumerate().map(|(k, rate)| {
        let centre = 5.0 + k as f64;
        let shrunk = -0.2 * (0.2 * centre).sin() * mean_of_cosine(0.2 * 5.0);
        (rate - shrunk).abs()
    });
    assert!(worst.fold(0.0, f64::max) < 2e-3);
}

/// The mean of `cos(a s)` under `(1 - s^2)^3` on [-1, 1].
fn mean_of_cosine(a: f64) -> f64 {
    let sum = |f: &dyn Fn(f64) -> f64| {
        (0..2000).map(|k| f(-1.0 + (f64::from(k) + 0.5) / 1000.0)).sum::<f64>()
    };
    let bump = |s: f64| (1.0 - s * s).powi(3);
    sum(&|s| bump(s) * (a * s).cos()) / sum(&bump)
}
