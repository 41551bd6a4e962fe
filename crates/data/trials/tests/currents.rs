//! Currents planted into trials: recovered, stated in a manifest and subtracted on reading.
#![allow(clippy::unwrap_used)]

use sistership_model::trial::{Channel, Trial};
use sistership_trials::{TrialCurrent, estimate_currents, load_path};

/// A turn through the water that slows down, and a zigzag; noise of instruments by a fixed pattern.
fn trial(name: &str, turning: bool, current: (f64, f64)) -> Trial {
    let noise = |k: usize, of: usize| ((k * (7919 + 131 * of)) % 101) as f64 / 101.0 - 0.5;
    let mut channels: std::collections::BTreeMap<Channel, Vec<f64>> = Default::default();
    let (mut psi, mut x, mut y) = (0.4, 0.0, 0.0);
    let t_s: Vec<f64> = (0..1600).map(|k| 0.5 * k as f64).collect();
    for (k, t) in t_s.iter().enumerate() {
        let grown = 1.0 - (-(t - 20.0_f64).max(0.0) / 25.0).exp();
        let r = if turning { 0.012 * grown } else { 0.006 * (t / 25.0).sin() };
        let (u, v) = (7.0 - 2.0 * grown.powi(2) * f64::from(turning), -40.0 * r);
        psi += 0.5 * r;
        let north = u * f64::cos(psi) - v * f64::sin(psi) + current.0;
        let east = u * f64::sin(psi) + v * f64::cos(psi) + current.1;
        (x, y) = (x + 0.5 * north, y + 0.5 * east);
        let ahead = north * psi.cos() + east * psi.sin() + 0.1 * noise(k, 1);
        let aside = east * psi.cos() - north * psi.sin() + 0.1 * noise(k, 2);
        let values = [
            (Channel::X, x),
            (Channel::Y, y),
            (Channel::Psi, psi),
            (Channel::U, ahead),
            (Channel::V, aside),
            (Channel::R, r + 5e-4 * noise(k, 3)),
        ];
        values.into_iter().for_each(|(one, value)| channels.entry(one).or_default().push(value));
    }
    Trial { name: name.into(), t_s, channels, ..Trial::default() }
}

fn off_by(found: &TrialCurrent, planted: (f64, f64)) -> f64 {
    (found.north_m_s - planted.0).hypot(found.east_m_s - planted.1)
}

#[test]
fn the_drift_of_a_circle_gives_the_current_of_all_trials() {
    for planted in [(0.3, -0.4), (-0.8, 0.1), (0.0, 0.12)] {
        let trials = [trial("turn.csv", true, planted), trial("zigzag.csv", false, planted)];
        let found = estimate_currents(&trials);
        assert_eq!(found.len(), 2);
        for one in &found {
            assert!(off_by(one, planted) < 0.03, "{planted:?}: {one:?}");
        }
        assert!(found[0].why.contains("drift of the turning circle"), "{}", found[0].why);
        assert!(found[1].why.contains("other trials"), "{}", found[1].why);
    }
}

#[test]
fn still_water_and_a_zigzag_alone_state_no_current() {
    let calm = [trial("turn.csv", true, (0.0, 0.0)), trial("zigzag.csv", false, (0.0, 0.0))];
    assert_eq!(estimate_currents(&calm), []);
    assert_eq!(estimate_currents(&[trial("zigzag.csv", false, (0.5, 0.0))]), []);
}

/// A wind from the north, which carries the ship so fast to the south and slows it when it is ahead.
fn with_wind(mut one: Trial, leeway: f64) -> Trial {
    let psi = one.channels[&Channel::Psi].clone();
    for (channel, factor, part) in
        [(Channel::U, 0.4, f64::cos as fn(f64) -> f64), (Channel::V, -1.0, f64::sin)]
    {
        let values = one.channels.get_mut(&channel).unwrap();
        values.iter_mut().zip(&psi).for_each(|(value, psi)| *value -= factor * leeway * part(*psi));
    }
    one
}

#[test]
fn leeway_in_a_wind_is_no_current() {
    let windy = with_wind(trial("turn.csv", true, (0.0, 0.0)), 0.15);
    assert_eq!(estimate_currents(&[windy]), []);
}

#[test]
fn a_ship_that_still_slows_down_has_no_current() {
    // A large ship in its first turn and a half: surge and sway settle over ten minutes.
    let mut one = trial("turn.csv", true, (0.0, 0.0));
    let settling = |t: f64| (-t / 600.0).exp();
    let added: Vec<(f64, f64)> =
        one.t_s.iter().map(|t| (2.5 * settling(*t), 0.4 * settling(*t))).collect();
    for (channel, at) in [(Channel::U, 0), (Channel::V, 1)] {
        let values = one.channels.get_mut(&channel).unwrap();
        values.iter_mut().zip(&added).for_each(|(value, add)| *value += [add.0, add.1][at]);
    }
    assert_eq!(estimate_currents(&[one]), []);
}

#[test]
fn logs_over_the_ground_and_through_the_water_give_the_current() {
    let planted = (0.25, 0.35);
    let mut one = trial("turn.csv", true, planted);
    let calm = trial("turn.csv", true, (0.0, 0.0));
    one.channels.insert(Channel::UWater, calm.channels[&Channel::U].clone());
    let found = estimate_currents(std::slice::from_ref(&one));
    assert!(off_by(&found[0], planted) < 0.03, "{found:?}");
    assert!(found[0].why.contains("through the water"), "{}", found[0].why);
}

#[test]
fn a_current_of_a_manifest_is_subtracted_and_an_unknown_trial_refused() {
    let folder = tempfile::tempdir().unwrap();
    let place = folder.path().join("trials.yaml");
    let file = std::fs::File::create(folder.path().join("turn.csv")).unwrap();
    sistership_trials::samples::to_csv(file, &trial("turn.csv", true, (0.3, -0.4))).unwrap();
    let manifest = |name: &str| {
        format!(
            "kind: trials\nship: a\ncurrents:\n  - {{ trial: {name}, north_m_s: 0.3, east_m_s: \
             -0.4, why: drift }}\ntrials: [{{ file: turn.csv }}]\n"
        )
    };
    std::fs::write(&place, manifest("turn.csv")).unwrap();
    let read = load_path(&place).unwrap().trials.remove(0).unwrap();
    let calm = trial("turn.csv", true, (0.0, 0.0));
    for channel in [Channel::U, Channel::V] {
        let pairs = read.channels[&channel].iter().zip(&calm.channels[&channel]);
        let most = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(most < 1e-6, "{channel:?} {most}");
    }
    std::fs::write(&place, manifest("lost.csv")).unwrap();
    let refused = load_path(&place).unwrap_err().to_string();
    assert!(refused.contains("`lost.csv` is not a trial"), "{refused}");
}
