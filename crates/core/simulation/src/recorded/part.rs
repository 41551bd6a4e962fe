//! Gap-free part of a trial, which is simulated without a restart.

use std::ops::Range;

use super::record::TrialRecord;
use super::replay_result::TrialReplay;
use crate::envelope::SimulationStop;
use crate::integrate::StepStage;
use crate::lockstep::SimulationTask;
use crate::plant::{LawInputs, PlantWorkspace};
use crate::ship::Ship;
use crate::state::{StateVector, Trajectory, at};

/// Simulation of one part of a trial.
pub struct TrialPart<'a> {
    /// Index of the trial among all.
    trial: usize,
    record: &'a TrialRecord<'a>,
    coefficients: &'a [f64],
    part: Range<usize>,
    /// Longest step, s.
    longest_s: f64,
    /// Last sample that was passed, and the number of steps since.
    sample: usize,
    taken: usize,
    /// Number of steps from that sample to the next; zero before the first sample.
    steps: usize,
    track: Trajectory,
    samples: Vec<usize>,
    stopped: Option<SimulationStop>,
}

impl<'a> TrialPart<'a> {
    pub fn new(
        trial: usize,
        record: &'a TrialRecord<'a>,
        coefficients: &'a [f64],
        part: Range<usize>,
        longest_s: f64,
    ) -> Self {
        let (track, samples) = (Trajectory::default(), Vec::with_capacity(part.len()));
        let sample = part.start;
        Self {
            trial,
            record,
            coefficients,
            part,
            longest_s,
            sample,
            taken: 0,
            steps: 0,
            track,
            samples,
            stopped: None,
        }
    }

    /// Appends the simulated samples to the result of the trial.
    pub fn append_to_results(self, replays: &mut [TrialReplay]) {
        let replay = &mut replays[self.trial];
        replay.track.append(self.track);
        replay.samples.extend(self.samples);
        // The first stop of a trial is the one to report.
        if replay.stopped.is_none() {
            replay.stopped = self.stopped;
        }
    }

    /// Records the state at a sample; returns the length of the next step, s, or `None` at the end.
    fn record_sample(
        &mut self,
        ship: &Ship,
        state: &mut StateVector,
        work: &mut PlantWorkspace,
    ) -> Option<f64> {
        let (k, trial) = (self.sample, self.record.trial);
        // The recorded rudder drives the simulation.
        state[at::DELTA] = self.record.delta[k];
        if let Err(stopped) = ship.envelope().check_state(trial.t_s[k], state) {
            self.stopped = Some(stopped);
            return None;
        }
        let said = ship.instrument_readings(
            trial.velocity,
            state,
            &self.record.interpolate_inputs(k, 0.0),
            work,
        );
        self.track.push(trial.t_s[k], said, self.record.n.map_or(0.0, |n| n[k]));
        self.samples.push(k);
        if k + 1 >= self.part.end {
            return None;
        }
        // The tolerance avoids an additional step caused by rounding.
        self.steps = (self.interval_s() / self.longest_s - 1e-9).ceil().max(1.0) as usize;
        self.taken = 0;
        Some(self.interval_s() / self.steps as f64)
    }

    fn interval_s(&self) -> f64 {
        self.record.trial.t_s[self.sample + 1] - self.record.trial.t_s[self.sample]
    }
}

impl SimulationTask for TrialPart<'_> {
    fn coefficients(&self) -> &[f64] {
        self.coefficients
    }

    fn initial_state(&mut self, ship: &Ship, work: &mut PlantWorkspace) -> StateVector {
        let (k, frame) = (self.part.start, self.record.trial.velocity);
        ship.true_state(
            frame,
            &self.record.recorded_state(k),
            &self.record.interpolate_inputs(k, 0.0),
            work,
        )
    }

    fn next_step(
        &mut self,
        ship: &Ship,
        state: &mut StateVector,
        work: &mut PlantWorkspace,
    ) -> Option<f64> {
        if self.steps == 0 {
            return self.record_sample(ship, state, work);
        }
        self.taken += 1;
        if self.taken < self.steps {
            return Some(self.interval_s() / self.steps as f64);
        }
        self.sample += 1;
        self.record_sample(ship, state, work)
    }

    fn stage_inputs(&self, _: &Ship, stage: StepStage, _: f64) -> LawInputs {
        self.record.interpolate_inputs(
            self.sample,
            (self.taken as f64 + stage.fraction()) / self.steps as f64,
        )
    }

    fn rudder_rate(&self, _: &Ship, _: f64) -> f64 {
        0.0
    }
}
