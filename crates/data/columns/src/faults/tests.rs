//! Tests of the search for faults.

use std::f64::consts::TAU;

use super::*;

fn noise(k: usize) -> f64 {
    ((k * 7919 + 13) % 101) as f64 / 101.0 - 0.5
}

fn heading() -> (Vec<f64>, Vec<f64>) {
    let t: Vec<f64> = (0..2000).map(|k| 0.5 * k as f64).collect();
    let psi = t.iter().enumerate().map(|(k, t)| (0.03 * t + 0.005 * noise(k)).rem_euclid(TAU));
    (t.clone(), psi.collect())
}

fn faults(t: &[f64], values: &[f64], is_direction: bool) -> Vec<(usize, SampleFault)> {
    let channel =
        FilteredChannel { values, is_direction, impossible: 5e3, ..FilteredChannel::default() };
    sample_faults(t, &channel)
}

#[test]
fn a_clean_channel_has_no_fault_and_planted_ones_are_found() {
    let (t, mut psi) = heading();
    assert_eq!(faults(&t, &psi, true), []);
    let crossing = (1..psi.len()).find(|&k| psi[k] < psi[k - 1] - 3.0).unwrap_or(0);
    psi[crossing] = 0.5 * (psi[crossing - 1] + psi[crossing]);
    psi[700] += 0.8;
    psi[900] = -9999.0;
    let found = faults(&t, &psi, true);
    let wanted = [
        (crossing, SampleFault::WrappedAverage),
        (700, SampleFault::Spike),
        (900, SampleFault::Impossible),
    ];
    assert_eq!(found, wanted);
}

#[test]
fn jumps_and_frozen_sensors_are_found_and_manoeuvres_are_not() {
    let t: Vec<f64> = (0..2000).map(|k| 0.5 * k as f64).collect();
    let ramp = |k: usize| if k > 1000 { 0.4 * (k - 1000) as f64 } else { 0.0 };
    let mut x: Vec<f64> = (0..2000).map(|k| 2.0 * k as f64 + ramp(k) + 0.1 * noise(k)).collect();
    assert_eq!(faults(&t, &x, false), []);
    (500..520).for_each(|k| x[k] += 60.0);
    (1500..1530).for_each(|k| x[k] = x[1499]);
    let found = faults(&t, &x, false);
    assert!((500..520).all(|k| found.contains(&(k, SampleFault::Jump))), "{found:?}");
    let late = found.iter().filter(|(k, _)| *k >= 1500).count();
    assert!((25..=30).contains(&late), "{late}");
    assert!(found.len() <= 52, "{}", found.len());
}

#[test]
fn times_that_do_not_run_forward_are_named() {
    let mut t = vec![0.0, 1.0, 1.0, 2.0, 0.5, 3.0, 4.0, 99.0];
    t.extend((5..20).map(f64::from));
    assert_eq!(backward_times(&t), [2, 4, 7]);
}

/// Noise that is not a sawtooth.
fn rough_noise(k: usize) -> f64 {
    let mixed = (k as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(31);
    (mixed.wrapping_mul(0xbf58_476d_1ce4_e5b9) >> 40) as f64 / 16_777_216.0 - 0.5
}

fn half_seconds(count: usize) -> Vec<f64> {
    (0..count).map(|k| 0.5 * k as f64).collect()
}

#[test]
fn a_run_of_one_value_is_frozen_where_there_is_noise_and_not_where_readings_are_interpolated() {
    let t = half_seconds(1000);
    let mut noisy: Vec<f64> = (0..1000).map(|k| 0.01 * rough_noise(k)).collect();
    (300..310).for_each(|k| noisy[k] = noisy[299]);
    let frozen: Vec<_> = (300..310).map(|k| (k, SampleFault::Frozen)).collect();
    assert_eq!(faults(&t, &noisy, false), frozen);
    // Readings each 5 s, two of which are equal.
    let reading = |at: usize| if at == 31 { 0.0 } else { rough_noise(at.max(30)) };
    let between = |k: usize| {
        let share = (k % 10) as f64 / 10.0;
        (1.0 - share) * reading(k / 10) + share * reading(k / 10 + 1)
    };
    let mut interpolated: Vec<f64> = (0..1000).map(between).collect();
    (320..330).for_each(|k| interpolated[k] = interpolated[319]);
    assert_eq!(faults(&t, &interpolated, false), []);
}

#[test]
fn a_sudden_turn_that_the_heading_shows_is_no_fault() {
    let t = half_seconds(1000);
    let pulse = |k: usize| if (500..506).contains(&k) { 0.1 } else { 0.0 };
    let r: Vec<f64> = (0..1000).map(|k| pulse(k) + 1e-3 * rough_noise(k)).collect();
    let mut psi = vec![0.0];
    (1..1000).for_each(|k| psi.push(psi[k - 1] + 0.25 * (r[k - 1] + r[k])));
    let channel = FilteredChannel { values: &r, impossible: 5.0, ..FilteredChannel::default() };
    assert_eq!(sample_faults(&t, &channel).len(), 6);
    let turned = FilteredChannel { integral: Some(&psi), ..channel };
    assert_eq!(sample_faults(&t, &turned), []);
    let still = vec![0.0; 1000];
    let straight = FilteredChannel { integral: Some(&still), ..channel };
    assert_eq!(sample_faults(&t, &straight).len(), 6);
}

#[test]
fn a_fix_that_jumps_is_found_with_its_repeats() {
    // A receiver of 1 Hz in a recording of 2 Hz; heading and speed are known.
    let t = half_seconds(1000);
    let speed: Vec<f64> = (0..1000).map(|k| 5.0 + (k as f64 / 40.0).sin()).collect();
    let way = |k: usize| 5.0 * t[k] + 20.0 * (1.0 - (k as f64 / 40.0).cos());
    let mut x: Vec<f64> = (0..1000).map(|k| way(k - k % 2) + 0.5 * rough_noise(k / 2)).collect();
    let found = |x: &[f64]| -> Vec<usize> {
        let channel = FilteredChannel {
            values: x,
            rate: Some(&speed),
            is_position: true,
            impossible: 1e8,
            ..FilteredChannel::default()
        };
        sample_faults(&t, &channel).iter().map(|(k, _)| *k).collect()
    };
    assert_eq!(found(&x), [] as [usize; 0]);
    (600..620).for_each(|k| x[k] += 25.0);
    assert_eq!(found(&x), (600..620).collect::<Vec<_>>());
}

#[test]
fn rows_are_repeated_only_where_the_channels_have_noise() {
    let noisy = |seed: usize| (0..500).map(|k| rough_noise(1000 * seed + k)).collect::<Vec<f64>>();
    let (mut u, mut v, mut r, held) = (noisy(1), noisy(2), noisy(3), vec![1.0; 500]);
    assert_eq!(repeated_rows(&[&u, &v, &r, &held]), [] as [usize; 0]);
    for k in [100, 101, 300] {
        (u[k], v[k], r[k]) = (u[k - 1], v[k - 1], r[k - 1]);
    }
    assert_eq!(repeated_rows(&[&u, &v, &r, &held]), [100, 101, 300]);
    // A recorder that is twice as fast as its sensors.
    let twice: Vec<f64> = (0..500).map(|k| rough_noise(k / 2)).collect();
    assert_eq!(repeated_rows(&[&twice, &held]), [] as [usize; 0]);
}
