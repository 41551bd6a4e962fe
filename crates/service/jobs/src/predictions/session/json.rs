//! Answers of a session as JSON.

use serde_json::{Map, Value, json};
use sistership_simulation::{StateVector, Trajectory};

use super::request::StepsRequest;
use super::sample::{BAND_ENDS, SessionSample};
use super::simulation::PredictionSession;
use crate::predictions::error::Result;
use crate::predictions::outside_trials::with_outside_trials;
use crate::predictions::track::{STATE_COLUMNS, track_columns, with_share};

impl PredictionSession {
    /// Simulates steps under orders, at most `most`; returns the samples column by column.
    ///
    /// # Errors
    /// Returns an error that names the invalid field of the request, or the missing memory.
    pub fn simulate(&mut self, request: &StepsRequest, most: usize) -> Result<Value> {
        self.apply_orders(request, most)?;
        let steps = (0..request.step_count()).map_while(|_| self.simulate_step(request.dt_s.get()));
        let samples: Vec<SessionSample> = steps.collect();
        Ok(self.samples_to_json(&samples))
    }

    /// Returns samples column by column, with band, stop and range of the trials.
    pub(crate) fn samples_to_json(&self, samples: &[SessionSample]) -> Value {
        let track = to_trajectory(samples);
        let answer = json!({
            "t_s": self.t_s,
            "trajectory": track_columns(&track),
            "band": self.band_to_json(samples),
            "stopped": self.stop_to_json(),
            "outside": self.ship.find_excursion(&track),
        });
        with_outside_trials(with_share(answer, &self.ship, &track), &self.uncovered)
    }

    /// Simulates the next rows of a request, at most `together`; returns them, and true if they are
    /// the last. The second argument is the number of steps that are done; the orders are applied
    /// with the first.
    ///
    /// # Errors
    /// Returns an error that names the invalid field of the request, or the missing memory.
    pub fn simulate_rows(
        &mut self,
        request: &StepsRequest,
        sailed: usize,
        together: usize,
        most: usize,
    ) -> Result<(Vec<Value>, bool)> {
        if sailed == 0 {
            self.apply_orders(request, most)?;
        }
        let left = request.step_count().saturating_sub(sailed);
        let mut rows = Vec::new();
        while rows.len() < left.min(together) {
            let sample = self.simulate_step(request.dt_s.get());
            // The last row repeats the present state with the reason of the stop.
            let stopped = sample.is_none();
            rows.push(self.sample_to_json(&sample.unwrap_or_else(|| self.current_sample())));
            if stopped {
                return Ok((rows, true));
            }
        }
        let ended = rows.len() == left;
        Ok((rows, ended))
    }

    /// Returns the present state and orders.
    pub fn current_view(&self) -> Value {
        let mut view = self.sample_to_json(&self.current_sample());
        view["orders"] = json!({ "delta_rad": self.order.delta_rad, "n_rps": self.order.n_rps });
        view["draws"] = json!(self.beside.as_ref().map_or(0, |beside| beside.drawn));
        view
    }

    fn sample_to_json(&self, sample: &SessionSample) -> Value {
        let mut row = state_to_map(&sample.state);
        row.insert("t_s".into(), json!(sample.t_s));
        row.insert("n_rps".into(), json!(sample.n_rps));
        if let Some(band) = &sample.band {
            row.insert("band".into(), band_object(|end| Value::Object(state_to_map(&band[end]))));
        }
        row.insert("stopped".into(), self.stop_to_json());
        let track = to_trajectory(std::slice::from_ref(sample));
        row.insert("outside".into(), json!(self.ship.find_excursion(&track)));
        with_outside_trials(with_share(Value::Object(row), &self.ship, &track), &self.uncovered)
    }

    fn stop_to_json(&self) -> Value {
        self.stopped
            .as_ref()
            .map_or(Value::Null, |stopped| json!({ "t_s": stopped.t_s, "reason": stopped.reason }))
    }

    /// Returns the band over samples, by its ends and columns, with the number of draws at the
    /// start and now.
    fn band_to_json(&self, samples: &[SessionSample]) -> Option<Value> {
        let beside = self.beside.as_ref()?;
        let column = |end: usize, place: usize| {
            // Null where no draw is left.
            let value = |sample: &SessionSample| sample.band.map(|band| band[end][place]);
            samples.iter().map(value).collect::<Vec<_>>()
        };
        let mut band = band_object(|end| {
            let all =
                STATE_COLUMNS.map(|(name, place)| (name.to_owned(), json!(column(end, place))));
            Value::Object(all.into_iter().collect())
        });
        band["drawn"] = json!(beside.drawn);
        // Draws that have left the physical range no longer count in the band.
        band["sailing"] = json!(beside.sisters.active_states().count());
        Some(band)
    }
}

/// Object with both ends of a band.
fn band_object(of: impl Fn(usize) -> Value) -> Value {
    let [(low, _), (high, _)] = BAND_ENDS;
    json!({ low: of(0), high: of(1) })
}

fn state_to_map(state: &StateVector) -> Map<String, Value> {
    STATE_COLUMNS.iter().map(|&(name, place)| (name.to_owned(), json!(state[place]))).collect()
}

fn to_trajectory(samples: &[SessionSample]) -> Trajectory {
    let mut track = Trajectory::default();
    samples.iter().for_each(|sample| track.push(sample.t_s, sample.state, sample.n_rps));
    track
}
