//! Faults of one kind, planted at a rate of the rows.

use std::collections::BTreeSet;
use std::f64::consts::{PI, TAU};

use rand::RngExt;
use rand_chacha::ChaCha12Rng;
use sistership_model::Trial;
use sistership_model::trial::Channel;

/// Kind of a planted fault.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FaultKind {
    /// Headings averaged across 360 degrees: anything between both sides.
    WrappedAverage,
    /// Single values of surge velocity and yaw rate that deviate.
    Spike,
    /// Yaw rate frozen for twenty samples.
    Frozen,
    /// Rows that repeat the values of the row before.
    StaleRepeat,
    /// Times that are doubled, or earlier than those before.
    BackwardTime,
    /// Positions that are off by tens of metres for up to fifteen samples.
    PositionJump,
    /// Rows that were lost, in runs of up to five.
    LostSample,
}

impl FaultKind {
    /// Every kind.
    pub const ALL: [Self; 7] = [
        Self::WrappedAverage,
        Self::Spike,
        Self::Frozen,
        Self::StaleRepeat,
        Self::BackwardTime,
        Self::PositionJump,
        Self::LostSample,
    ];

    /// Name for tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::WrappedAverage => "wrapped averages",
            Self::Spike => "spikes",
            Self::Frozen => "frozen sensor",
            Self::StaleRepeat => "stale repeats",
            Self::BackwardTime => "times backward or doubled",
            Self::PositionJump => "jumps of GNSS",
            Self::LostSample => "lost samples",
        }
    }

    /// Longest run of faulty samples.
    fn longest_run(self) -> usize {
        match self {
            Self::WrappedAverage | Self::Spike | Self::BackwardTime => 1,
            Self::StaleRepeat => 3,
            Self::Frozen => 20,
            Self::PositionJump => 15,
            Self::LostSample => 5,
        }
    }
}

/// Trial with faults, and where they are.
#[derive(Debug, Clone)]
pub struct PlantedTrial {
    /// The trial as it is recorded.
    pub trial: Trial,
    /// Channel, or nothing for whole rows, and row of each fault.
    pub faults: BTreeSet<(String, usize)>,
}

/// Plants faults of a kind in a part of the rows. Headings are recorded from 0 to 360 degrees.
pub fn plant(trial: &Trial, kind: FaultKind, rate: f64, rng: &mut ChaCha12Rng) -> PlantedTrial {
    let mut planted = PlantedTrial { trial: trial.clone(), faults: BTreeSet::new() };
    if let Some(psi) = planted.trial.channels.get_mut(&Channel::Psi) {
        psi.iter_mut().for_each(|value| *value = value.rem_euclid(TAU));
    }
    let rows = trial.len();
    let wanted = (rate * rows as f64).round() as usize;
    let mut done = 0;
    let mut lost = BTreeSet::new();
    while done < wanted {
        let first = rng.random_range(20..rows - 40);
        let run = match kind {
            // A frozen sensor is one for its whole length.
            FaultKind::Frozen => kind.longest_run(),
            _ => rng.random_range(1..=kind.longest_run()),
        };
        for k in first..first + run {
            planted.plant_sample(kind, (first, k), rng);
            lost.insert(k);
        }
        done += run;
    }
    if kind == FaultKind::LostSample {
        planted.lose_rows(&lost);
    }
    planted
}

impl PlantedTrial {
    fn plant_sample(&mut self, kind: FaultKind, (first, k): (usize, usize), rng: &mut ChaCha12Rng) {
        let sign = if rng.random_bool(0.5) { 1.0 } else { -1.0 };
        match kind {
            FaultKind::WrappedAverage => {
                // A heading next to north, averaged with one beyond it, may be anything between.
                let value = self.value(Channel::Psi, k);
                let share = rng.random_range(0.15..0.85);
                let other = if value < PI { value + TAU } else { value - TAU };
                self.set(Channel::Psi, k, value + share * (other - value));
            }
            FaultKind::Spike => {
                let (channel, size) =
                    if k % 2 == 0 { (Channel::U, 2.0) } else { (Channel::R, 0.02) };
                let size = sign * size * rng.random_range(0.5..3.0);
                self.set(channel, k, self.value(channel, k) + size);
            }
            FaultKind::Frozen => self.set(Channel::R, k, self.value(Channel::R, first - 1)),
            FaultKind::StaleRepeat => {
                let channels: Vec<Channel> = self.trial.channels.keys().copied().collect();
                channels.into_iter().for_each(|one| self.set(one, k, self.value(one, first - 1)));
            }
            FaultKind::BackwardTime => {
                let steps = if sign > 0.0 { 1 } else { 4 };
                self.trial.t_s[k] = self.trial.t_s[k - steps];
                self.faults.insert((String::new(), k));
            }
            FaultKind::PositionJump => {
                // The whole run is off by the same distance.
                let seed = (first as f64 * 0.7).sin();
                let size = seed.signum() * (20.0 + 40.0 * seed.abs());
                for channel in [Channel::X, Channel::Y] {
                    self.set(channel, k, self.value(channel, k) + size);
                }
            }
            FaultKind::LostSample => {}
        }
    }

    fn value(&self, channel: Channel, k: usize) -> f64 {
        self.trial.channel(channel).map_or(f64::NAN, |values| values[k])
    }

    fn set(&mut self, channel: Channel, k: usize, value: f64) {
        if let Some(values) = self.trial.channels.get_mut(&channel) {
            values[k] = value;
            self.faults.insert((channel.name().to_owned(), k));
        }
    }

    fn lose_rows(&mut self, lost: &BTreeSet<usize>) {
        let kept: Vec<usize> = (0..self.trial.len()).filter(|k| !lost.contains(k)).collect();
        let keep = |values: &[f64]| kept.iter().map(|&k| values[k]).collect();
        self.trial.t_s = keep(&self.trial.t_s);
        for values in self.trial.channels.values_mut() {
            *values = keep(values);
        }
    }
}
