//! A trial as a table of text.

use sistership_model::Trial;
use sistership_model::trial::Channel;

/// Columns with their headers, one cell a sample.
pub struct Table {
    columns: Vec<(String, Vec<String>)>,
}

impl Table {
    pub fn new() -> Self {
        Self { columns: Vec::new() }
    }

    /// With a column of text, of each sample's place and time.
    pub fn text(
        mut self,
        header: &str,
        trial: &Trial,
        cell: impl Fn(usize, f64) -> String,
    ) -> Self {
        let cells = trial.t_s.iter().enumerate().map(|(k, t)| cell(k, *t)).collect();
        self.columns.push((header.to_owned(), cells));
        self
    }

    /// With a channel, each value put through `to`.
    pub fn channel(
        mut self,
        header: &str,
        trial: &Trial,
        channel: Channel,
        to: impl Fn(f64) -> f64,
    ) -> Self {
        let values = trial.channel(channel).expect("a channel of the trial");
        let cells = values.iter().map(|value| format!("{:.7}", to(*value))).collect();
        self.columns.push((header.to_owned(), cells));
        self
    }

    /// The channels that every form has besides time: u, v, r, heading, rudder, revolutions.
    pub fn motion(self, trial: &Trial) -> Self {
        self.velocities(trial).steering(trial).position(trial)
    }

    pub fn velocities(self, trial: &Trial) -> Self {
        self.channel("surge [m/s]", trial, Channel::U, |u| u)
            .channel("sway [m/s]", trial, Channel::V, |v| v)
            .channel("yaw rate [deg/s]", trial, Channel::R, f64::to_degrees)
    }

    pub fn steering(self, trial: &Trial) -> Self {
        self.channel("heading [deg]", trial, Channel::Psi, f64::to_degrees)
            .channel("rudder angle [deg]", trial, Channel::Delta, f64::to_degrees)
            .revolutions(trial)
    }

    pub fn revolutions(self, trial: &Trial) -> Self {
        match trial.channel(Channel::N) {
            Some(_) => self.channel("propeller [rpm]", trial, Channel::N, |n| 60.0 * n),
            None => self,
        }
    }

    pub fn position(self, trial: &Trial) -> Self {
        self.channel("north [m]", trial, Channel::X, |x| x).channel(
            "east [m]",
            trial,
            Channel::Y,
            |y| y,
        )
    }

    /// The lines, header first.
    pub fn lines(&self, separator: &str) -> Vec<String> {
        let headers: Vec<&str> = self.columns.iter().map(|(header, _)| header.as_str()).collect();
        let rows = self.columns.first().map_or(0, |(_, cells)| cells.len());
        let row = |k: usize| {
            let cells: Vec<&str> =
                self.columns.iter().map(|(_, cells)| cells[k].as_str()).collect();
            cells.join(separator)
        };
        std::iter::once(headers.join(separator)).chain((0..rows).map(row)).collect()
    }

    pub fn csv(&self) -> Vec<u8> {
        (self.lines(",").join("\n") + "\n").into_bytes()
    }
}
