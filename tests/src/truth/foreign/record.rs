//! Trials of a craft as its instruments record them, and files as people have them.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use rand::RngExt;
use rand_chacha::ChaCha12Rng;
use rand_distr::StandardNormal;
use sistership_model::trial::Channel;
use sistership_simulation::state::{RECORDED_CHANNELS, at};

use super::craft::Craft;
use super::motion::Motion;
use super::simulate::{Track, mean_rps};
use super::size::Size;
use crate::truth::instruments::Instruments as Recorder;

/// Standard deviations of the noise, and the sampling.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Instruments {
    /// Between samples, s.
    pub interval_s: f64,
    /// Position, m.
    pub position_m: f64,
    /// Velocities, m/s.
    pub velocity_m_s: f64,
    /// Yaw and roll rate, rad/s.
    pub rate_rad_s: f64,
    /// Heading and roll, rad.
    pub angle_rad: f64,
    /// Angle of what steers, rad.
    pub steering_rad: f64,
    /// Revolutions by those of the approach.
    pub revolutions: f64,
}

impl Instruments {
    /// Those of a craft: differential GNSS, gyro compass and rate gyro once a second; below 30 m
    /// RTK and a fibre-optic gyro twice a second.
    pub fn of(craft: &Craft) -> Self {
        let large = Self {
            interval_s: 1.0,
            position_m: 0.5,
            velocity_m_s: 0.03,
            rate_rad_s: 3e-4,
            angle_rad: 1.5e-3,
            steering_rad: 2e-3,
            revolutions: 1e-3,
        };
        let small = Self {
            interval_s: 0.5,
            position_m: 0.05,
            rate_rad_s: 2e-3,
            angle_rad: 3e-3,
            steering_rad: 4e-3,
            revolutions: 3e-3,
            ..large
        };
        if craft.size().lpp_m < 30.0 { small } else { large }
    }

    /// Perfect ones with an interval.
    pub fn perfect(interval_s: f64) -> Self {
        Self {
            interval_s,
            position_m: 0.0,
            velocity_m_s: 0.0,
            rate_rad_s: 0.0,
            angle_rad: 0.0,
            steering_rad: 0.0,
            revolutions: 0.0,
        }
    }

    /// Columns of a track by their names in files, time first. A craft that is steered by the
    /// difference of two thrusts has the revolutions of either side and no angle.
    pub fn columns(&self, craft: &Craft, track: &Track, rng: &mut ChaCha12Rng) -> Columns {
        let every = (self.interval_s / craft.step_s()).round() as usize;
        let kept: Vec<&Motion> = track.motions.iter().step_by(every).collect();
        let recorded = &RECORDED_CHANNELS[..if craft.rolls() { 8 } else { 6 }];
        let mut columns: Columns =
            vec![("t_s", track.t_s.iter().step_by(every).copied().collect())];
        for &(channel, place) in recorded {
            let values = kept.iter().map(|motion| motion.body[place]);
            columns.push((channel.column_name(), noisy(values, self.deviation(channel), rng)));
        }
        let scatter = self.revolutions * craft.rated_rps();
        if craft.steers_by_difference() {
            for (shaft, name) in ["n_port_rps", "n_starboard_rps"].into_iter().enumerate() {
                let values = kept.iter().map(|motion| motion.n_rps[shaft]);
                columns.push((name, noisy(values, scatter, rng)));
            }
            return columns;
        }
        let angles = kept.iter().map(|motion| motion.body[at::DELTA]);
        columns.push((Channel::Delta.column_name(), noisy(angles, self.steering_rad, rng)));
        let turns = kept.iter().map(|motion| mean_rps(motion, craft.shafts()));
        columns.push((Channel::N.column_name(), noisy(turns, scatter, rng)));
        columns
    }

    /// The same for trials in which something may be hidden.
    pub fn recorder(&self) -> Recorder {
        Recorder {
            interval_s: self.interval_s,
            position_m: self.position_m,
            velocity_m_s: self.velocity_m_s,
            rate_rad_s: self.rate_rad_s,
            angle_rad: self.angle_rad,
            rudder_rad: self.steering_rad,
            revolutions: self.revolutions,
        }
    }

    fn deviation(&self, channel: Channel) -> f64 {
        match channel {
            Channel::U | Channel::V => self.velocity_m_s,
            Channel::R | Channel::P => self.rate_rad_s,
            Channel::X | Channel::Y => self.position_m,
            _ => self.angle_rad,
        }
    }
}

/// Columns by their names.
pub type Columns = Vec<(&'static str, Vec<f64>)>;

fn noisy(values: impl Iterator<Item = f64>, deviation: f64, rng: &mut ChaCha12Rng) -> Vec<f64> {
    values.map(|value| value + deviation * rng.sample::<f64, _>(StandardNormal)).collect()
}

/// Writes the vessel file of a craft into a folder: particulars and category, no model.
///
/// # Panics
/// Where it cannot be written.
pub fn write_vessel(folder: &Path, size: &Size) -> PathBuf {
    let path = folder.join(format!("{}.yaml", size.name));
    std::fs::write(&path, vessel(size)).expect("the vessel file is written");
    path
}

fn vessel(size: &Size) -> String {
    let mut text = format!(
        "kind: vessel\nname: {name}\ntitle: Synthetic craft {name}\ncategory: {category}\n\
         sources:\n  yard: {{ citation: \"Papers of a craft that was never built\" }}\n\
         conventions: {{ rudder_positive: starboard_turn }}\n\
         particulars:\n  source: yard\n  values:\n",
        name = size.name,
        category = size.category,
    );
    for (name, value) in size.particulars() {
        let _ = writeln!(text, "    {name}: {value:?}");
    }
    text + "models: []\n"
}

/// Writes trials by their names as CSV files, and a manifest that lists them.
///
/// # Panics
/// Where a file cannot be written.
pub fn write_trials(folder: &Path, size: &Size, trials: &[(String, Columns)]) -> PathBuf {
    let mut manifest = format!("kind: trials\nship: {}\ntrials:\n", size.name);
    for (name, columns) in trials {
        let file = format!("{name}.csv");
        std::fs::write(folder.join(&file), csv(columns)).expect("the trial is written");
        let _ = writeln!(manifest, "  - {{ file: \"{file}\" }}");
    }
    let path = folder.join("trials.yaml");
    std::fs::write(&path, manifest).expect("the manifest is written");
    path
}

fn csv(columns: &Columns) -> String {
    let names: Vec<&str> = columns.iter().map(|(name, _)| *name).collect();
    let mut text = names.join(",") + "\n";
    for row in 0..columns[0].1.len() {
        let cells: Vec<String> =
            columns.iter().map(|(_, values)| format!("{:.7}", values[row])).collect();
        let _ = writeln!(text, "{}", cells.join(","));
    }
    text
}
