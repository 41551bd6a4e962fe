use super::*;
use crate::testing::{check_messages, test_recording, zigzag_channels};

/// The zigzag with channels replaced by functions of the sample (x, y, psi, u, v).
fn changed(change: impl Fn([f64; 5]) -> [f64; 5]) -> String {
    let mut channels = zigzag_channels();
    for k in 0..channels[0].1.len() {
        let sample = std::array::from_fn(|c| channels[c].1[k]);
        change(sample).into_iter().enumerate().for_each(|(c, value)| channels[c].1[k] = value);
    }
    check_messages(&test_recording(&channels), check_track)
}

#[test]
fn declared_axes_pass() {
    assert_eq!(check_messages(&test_recording(&zigzag_channels()), check_track), "");
}

#[test]
fn earth_fixed_velocities_are_refused() {
    let text = changed(|[x, y, psi, u, v]| {
        let (c, s) = (psi.cos(), psi.sin());
        [x, y, psi, u * c - v * s, u * s + v * c]
    });
    assert!(
        text.starts_with(
            "error None Some(\"u_m_s\") according to the track, u and v are velocities north"
        ),
        "{text}"
    );
}

#[test]
fn other_axes_are_named() {
    assert!(changed(|[x, y, psi, u, v]| [y, x, psi, u, v]).contains("exchanged"));
    assert!(changed(|[x, y, psi, u, v]| [x, -y, psi, u, v]).contains("west"));
    assert!(changed(|[x, y, psi, u, v]| [x, y, psi, u, -v]).contains("to port"));
}

#[test]
fn speeds_in_knots_are_refused() {
    let text = changed(|[x, y, psi, u, v]| [x, y, psi, u / 0.514_444, v / 0.514_444]);
    assert!(text.contains("declare `kn`"), "{text}");
}

#[test]
fn a_drift_is_a_remark() {
    let mut channels = zigzag_channels();
    channels[0].1.iter_mut().enumerate().for_each(|(k, x)| *x += 0.3 * k as f64);
    let text = check_messages(&test_recording(&channels), check_track);
    assert!(text.starts_with("warning") && text.contains("drift by 0.60"), "{text}");
}
