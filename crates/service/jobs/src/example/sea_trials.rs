//! Artificial sea trials: simulated with the ship's own law, recorded with the noise of real
//! instruments.

use std::collections::BTreeMap;

use rand::SeedableRng;
use rand_chacha::ChaCha12Rng;
use rand_distr::{Distribution, Normal};
use sistership_model::Trial;
use sistership_model::trial::Channel;
use sistership_simulation::manoeuvre::{ManoeuvreSettings, simulate_turn, simulate_zigzag};
use sistership_simulation::state::at;
use sistership_simulation::{Ship, SimulationStop, Trajectory};

/// A manoeuvre of the programme.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TrialManoeuvre {
    /// A turning circle with a rudder angle, deg.
    Turn(f64),
    /// A zigzag with a rudder angle and a change of heading, deg.
    Zigzag(f64, f64),
}

impl TrialManoeuvre {
    /// Name for people.
    pub fn name(self) -> String {
        match self {
            Self::Turn(rudder_deg) => format!("turn {rudder_deg:+}"),
            Self::Zigzag(rudder_deg, switch_deg) => format!("zigzag {rudder_deg}/{switch_deg}"),
        }
    }

    /// The name of its file, such as `turn-port-15.csv`.
    fn file_name(self) -> String {
        let side = |rudder_deg: f64| if rudder_deg < 0.0 { "port" } else { "starboard" };
        match self {
            Self::Turn(rudder_deg) => format!("turn-{}-{}.csv", side(rudder_deg), rudder_deg.abs()),
            Self::Zigzag(rudder_deg, switch_deg) => {
                format!("zigzag-{}-{}-{switch_deg}.csv", side(rudder_deg), rudder_deg.abs())
            }
        }
    }
}

/// Recorded duration of each trial, s, and time of the first rudder execute, s.
const DURATION_S: f64 = 650.0;
const EXECUTE_S: f64 = 60.0;
/// Number of steps of 0.1 s for each sample: 2 Hz.
const STEPS_PER_SAMPLE: usize = 5;

/// Recorded channels, with the index in the state and the standard deviation of the instrument, SI:
/// differential GNSS, Doppler log, gyros, feedback units.
const INSTRUMENTS: [(Channel, usize, f64); 9] = [
    (Channel::X, at::X, 0.3),
    (Channel::Y, at::Y, 0.3),
    (Channel::Psi, at::PSI, 5e-4),
    (Channel::U, at::U, 3e-3),
    (Channel::V, at::V, 3e-3),
    (Channel::R, at::R, 5e-5),
    (Channel::P, at::P, 2e-4),
    (Channel::Phi, at::PHI, 5e-4),
    (Channel::Delta, at::DELTA, 5e-4),
];
const REVOLUTIONS_NOISE_RPS: f64 = 1e-3;

/// Simulates and records a programme; the same seed gives the same noise.
///
/// # Errors
/// Returns time and reason if the ship left the physical range.
pub fn record_programme(
    ship: &Ship,
    speed_m_s: f64,
    programme: &[TrialManoeuvre],
    seed: u64,
) -> Result<Vec<Trial>, SimulationStop> {
    // One generator for all trials, in their order.
    let mut noise = ChaCha12Rng::seed_from_u64(seed);
    let settings = ManoeuvreSettings {
        speed_m_s: Some(speed_m_s),
        // The duration of the settings begins with the rudder execute.
        duration_s: Some(DURATION_S - EXECUTE_S),
        run_in_s: EXECUTE_S,
        ..ManoeuvreSettings::default()
    };
    let sail = |manoeuvre: &TrialManoeuvre| match *manoeuvre {
        TrialManoeuvre::Turn(rudder_deg) => {
            simulate_turn(ship, rudder_deg, &settings).map(|turn| turn.track)
        }
        TrialManoeuvre::Zigzag(rudder_deg, switch_deg) => {
            simulate_zigzag(ship, rudder_deg, switch_deg, &settings).map(|zigzag| zigzag.track)
        }
    };
    programme
        .iter()
        .map(|manoeuvre| Ok(add_noise(*manoeuvre, &sail(manoeuvre)?, &mut noise)))
        .collect()
}

fn add_noise(manoeuvre: TrialManoeuvre, track: &Trajectory, noise: &mut ChaCha12Rng) -> Trial {
    let sampled = |values: Vec<f64>, deviation: f64, noise: &mut ChaCha12Rng| -> Vec<f64> {
        let values = values.into_iter().step_by(STEPS_PER_SAMPLE);
        values
            .map(|value| {
                value + Normal::new(0.0, deviation).map_or(0.0, |normal| normal.sample(noise))
            })
            .collect()
    };
    let mut channels: BTreeMap<Channel, Vec<f64>> = INSTRUMENTS
        .iter()
        .map(|&(channel, index, deviation)| {
            (channel, sampled(track.state_column(index), deviation, noise))
        })
        .collect();
    channels.insert(Channel::N, sampled(track.n_rps.clone(), REVOLUTIONS_NOISE_RPS, noise));
    Trial {
        name: manoeuvre.file_name(),
        t_s: track.t_s.iter().copied().step_by(STEPS_PER_SAMPLE).collect(),
        channels,
        manoeuvre: Some(manoeuvre.name()),
        ..Trial::default()
    }
}
