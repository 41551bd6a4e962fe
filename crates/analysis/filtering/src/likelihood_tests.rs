#![allow(clippy::unwrap_used)]
use sistership_model::trial::Channel;
use sistership_model::uncertainty::Discrepancy;

use super::super::linearised::LinearisationSizes;
use super::super::noise::NoiseLevel;
use super::*;

/// Numbers between -1 and 1 that look random (Knuth, The Art of Computer Programming 2, 3.3.4).
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn some(&mut self, count: usize, size: f64) -> Vec<f64> {
        (0..count).map(|_| size * self.next()).collect()
    }
}

/// A part of so many samples, some intervals longer than others.
fn part(
    samples: usize,
    every: usize,
    channels: &[(Channel, usize)],
    measured: bool,
) -> LinearisedPart {
    let numbers = &mut Numbers(7 + samples as u64);
    let readings = samples * channels.len();
    let mut jacobian = numbers.some(16 * samples, 0.1);
    // Nothing depends on the last state.
    jacobian.iter_mut().skip(3).step_by(4).for_each(|value| *value = 0.0);
    LinearisedPart {
        samples: (0..samples).collect(),
        t_s: (0..samples).map(|k| 0.5 * k as f64 + if k > 9 { 0.25 } else { 0.0 }).collect(),
        sizes: LinearisationSizes { states: 4, axes: 3, columns: 1 },
        jacobian,
        accelerations: numbers.some(3 * samples, 0.01),
        defect: numbers.some(4 * samples, 0.01),
        reading: numbers.some(readings, 0.2),
        by_state: None,
        by_column: if measured { numbers.some(readings, 0.1) } else { Vec::new() },
        measured: if measured { vec![0] } else { Vec::new() },
        by_rate: Vec::new(),
        channels: channels.to_vec(),
        every,
    }
}

/// Each channel says a mixture of states; one state is in none of them.
fn mixing(part: LinearisedPart) -> LinearisedPart {
    let mut by_state = Numbers(3).some(4 * part.reading.len(), 1.0);
    by_state.iter_mut().skip(3).step_by(4).for_each(|weight| *weight = 0.0);
    LinearisedPart { by_state: Some(by_state), ..part }
}

#[test]
fn lanes_give_what_one_part_after_the_other_gives_to_the_last_bit() {
    let four = [(Channel::U, 0), (Channel::V, 1), (Channel::R, 2), (Channel::Psi, 3)];
    let instrument = NoiseLevel { deviation: 0.1, drift: 1e-3 };
    let noise: InstrumentNoise = four.iter().map(|(channel, _)| (*channel, instrument)).collect();
    let discrepancy = |k: usize| Discrepancy {
        deviation: 0.01 * (1 + k) as f64,
        time_s: 20.0 + k as f64,
        white: 1e-3,
    };
    let discrepancies: AxisDiscrepancies = (0..3).map(discrepancy).collect();
    let lengths = [60, 12, 33, 33, 80, 7, 41, 55, 20, 61, 1];
    let mut parts: Vec<LinearisedPart> = lengths.map(|n| part(n, 1, &four, n % 2 == 0)).into();
    parts.extend([30, 31, 32].map(|n| part(n, 3, &four[..3], false)));
    parts.extend([25, 40, 41, 26, 9].map(|n| mixing(part(n, 1, &four, n % 2 == 0))));
    let each: Vec<&LinearisedPart> = parts.iter().collect();
    let together = part_deviances(&each, &noise, &discrepancies).unwrap();
    for (part, deviance) in parts.iter().zip(together) {
        let alone = single_deviance(part, &noise, &discrepancies).unwrap();
        assert!(deviance.is_finite());
        assert_eq!(deviance.to_bits(), alone.to_bits(), "{deviance} not {alone}");
    }
}
