#![allow(clippy::unwrap_used)]
use super::*;
use crate::{Mapping, TrialFile, read_trial};

fn trial() -> Trial {
    let values =
        |scale: f64| (0..300).map(|k| scale * (k as f64).sin() / 3.0).collect::<Vec<f64>>();
    Trial {
        name: "zigzag/a.csv".into(),
        t_s: (0..300).map(|k| k as f64 * 0.1).collect(),
        channels: [
            (Channel::U, values(1.0)),
            (Channel::Delta, values(-1e-9)),
            (Channel::Y, values(1e5)),
        ]
        .into(),
        manoeuvre: Some("zigzag 10/10".into()),
        depth_m: Some(12.5),
        velocity: VelocityFrame::Water,
        warnings: vec![Finding { row: Some(3), column: None, message: "gap".into() }],
    }
}

#[test]
fn parquet_keeps_the_whole_trial_and_is_deterministic() {
    let bytes = to_parquet(&trial()).unwrap();
    assert_eq!(bytes, to_parquet(&trial()).unwrap());
    assert_eq!(from_parquet(bytes.into()).unwrap(), trial());
    let empty = Trial::default();
    assert_eq!(from_parquet(to_parquet(&empty).unwrap().into()).unwrap(), empty);
}

#[test]
fn csv_and_parquet_read_back_to_the_same_samples() {
    let mut text = Vec::new();
    to_csv(&mut text, &trial()).unwrap();
    assert!(text.starts_with(b"t_s,y_m,u_m_s,delta_rad\n0.0,"));
    for bytes in [text, to_parquet(&trial()).unwrap()] {
        let back =
            read_trial(TrialFile::from_bytes("a", bytes.into()), &Mapping::with_canonical_names());
        // The samples are noise, so the checks may refuse them; what was read is what was written.
        let back = back.unwrap();
        assert_eq!((back.t_s, back.channels), (trial().t_s, trial().channels));
    }
}

#[test]
fn foreign_damaged_and_uneven_samples_are_errors() {
    assert!(from_parquet(Bytes::from_static(b"PAR1")).is_err());
    let mut uneven = trial();
    uneven.t_s.pop();
    assert!(
        to_parquet(&uneven).unwrap_err().to_string().contains("y has 300 samples, time has 299")
    );
}

#[test]
fn damaged_bytes_never_panic() {
    let bytes = to_parquet(&trial()).unwrap();
    for at in 0..bytes.len() {
        for flip in [0x01, 0x80, 0xff] {
            let mut damaged = bytes.clone();
            damaged[at] ^= flip;
            let _ = from_parquet(damaged.into());
        }
    }
    for end in 0..bytes.len() {
        let _ = from_parquet(Bytes::copy_from_slice(&bytes[..end]));
    }
}
