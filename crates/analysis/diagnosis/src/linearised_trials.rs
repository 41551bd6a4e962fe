//! A model, columns and trials prepared for filtering: linearised once, filtered at any level of
//! discrepancy.

use std::borrow::Cow;

use rayon::prelude::*;
use sistership_model::coefficient::Axis;
use sistership_model::manifest::VelocityFrame;
use sistership_model::trial::Channel;
use sistership_model::uncertainty::{Discrepancy, InstrumentFit, Uncertainty};
use sistership_model::{Trial, particulars};

use super::calibrated_model::CalibratedModel;
use super::thresholds::THRESHOLDS;
use sistership_filtering::{
    AxisDiscrepancies, FilterColumns, GramMatrix, InstrumentNoise, LinearisationDetail,
    LinearisedPart, NoiseLevel, ResidualSystem, TrialReadings, filter_columns, linearise,
    noise_deviation, noise_floor, reading_interval, reading_stride, unknown_noise_error,
};
use sistership_identification::refine::RefineError;
use sistership_priors::transfer::trial_approach;

/// All data that do not change with the discrepancy.
pub struct LinearisedTrials<'a> {
    pub trials: &'a [&'a Trial],
    pub noise: InstrumentNoise,
    pub lpp_m: f64,
    pub speed_m_s: f64,
    system: ResidualSystem,
    records: Vec<TrialReadings<'a>>,
    /// Linearised parts by trial; empty where each is linearised again when it is needed.
    linear: Vec<Vec<LinearisedPart>>,
}

/// Typical accelerations and time of a ship.
#[derive(Debug, Clone)]
pub struct MotionScales {
    /// Accelerations by axis: U^2/L, or (U/L)^2.
    pub accelerations: Vec<f64>,
    /// Correlation time of the discrepancy, s: the time in which the ship covers its length.
    pub time_s: f64,
}

impl MotionScales {
    /// Discrepancies of a level: a share of the typical acceleration of each axis.
    pub fn level_discrepancies(&self, level: f64) -> AxisDiscrepancies {
        let time_s = self.time_s;
        let of = |typical: &f64| {
            let deviation = level * typical;
            Discrepancy {
                deviation,
                time_s,
                white: THRESHOLDS.discrepancy.white_share * deviation * time_s.sqrt(),
            }
        };
        self.accelerations.iter().map(of).collect()
    }
}

impl<'a> LinearisedTrials<'a> {
    /// Linearises each trial once and keeps it.
    ///
    /// # Errors
    /// Returns an error that names what the model or a trial lacks.
    pub fn new(
        learned: &CalibratedModel,
        columns: FilterColumns,
        trials: &'a [&'a Trial],
        least_step_s: Option<f64>,
    ) -> Result<Self, RefineError> {
        Self::linearised_on_demand(learned, columns, trials, least_step_s)?.linearise_all()
    }

    /// Linearises each trial once, with given instruments.
    ///
    /// # Errors
    /// Returns an error that names what the model or a trial lacks.
    pub fn with_given_instruments(
        learned: &CalibratedModel,
        columns: FilterColumns,
        trials: &'a [&'a Trial],
        least_step_s: Option<f64>,
        instruments: &InstrumentNoise,
    ) -> Result<Self, RefineError> {
        let mut all = Self::every_sample(learned, columns, trials, least_step_s)?;
        set_reading_intervals(&mut all.records, learned.reading_interval_s);
        all.with_instruments(instruments.clone())?.linearise_all()
    }

    /// Linearises each trial and keeps it.
    fn linearise_all(mut self) -> Result<Self, RefineError> {
        let whole = |record| linearise(&self.system, record, LinearisationDetail::Whole);
        self.linear = self.records.par_iter().map(whole).collect::<Result<_, _>>()?;
        Ok(self)
    }

    /// Linearises each trial, derives something from it, and keeps it with its first columns only.
    ///
    /// # Errors
    /// Returns an error that names what a trial lacks, or that of `derive`.
    pub fn linearise_with<T: Send>(
        mut self,
        columns: usize,
        derive: impl Fn(&Self, &[LinearisedPart]) -> Result<T, RefineError> + Sync,
    ) -> Result<(Self, Vec<T>), RefineError> {
        let of_trial = |record| {
            let mut parts = linearise(&self.system, record, LinearisationDetail::Whole)?;
            let derived = derive(&self, &parts)?;
            parts.iter_mut().for_each(|part| part.truncate_columns(columns));
            Ok((parts, derived))
        };
        // All columns of all trials at once would take most of the memory of a diagnosis.
        let each: Vec<(Vec<LinearisedPart>, T)> =
            self.records.par_iter().map(of_trial).collect::<Result<_, RefineError>>()?;
        let derived;
        (self.linear, derived) = each.into_iter().unzip();
        Ok((self, derived))
    }

    /// Sets the instruments; each recorded channel must have one.
    ///
    /// # Errors
    /// Returns an error that names the trial and the channel without one.
    fn with_instruments(mut self, noise: InstrumentNoise) -> Result<Self, RefineError> {
        for record in self.records.iter().filter(|record| !record.is_empty()) {
            // Only channels that are recorded and known to the filter need an instrument.
            let lacks = |(channel, _): &&(Channel, usize)| {
                record.trial.channel(*channel).is_some() && !noise.contains_key(channel)
            };
            if let Some((channel, _)) = self.system.channels.iter().find(lacks) {
                let message = unknown_noise_error(*channel).to_string();
                return Err(RefineError::Data(format!("trial `{}`: {message}", record.trial.name)));
            }
        }
        self.noise = noise;
        Ok(self)
    }

    /// Prepares trials that are linearised again whenever they are needed: the kept data are larger
    /// than the trials by the number of columns.
    ///
    /// # Errors
    /// Returns an error that names what the model lacks; what a trial lacks is reported when it is
    /// needed.
    pub fn linearised_on_demand(
        learned: &CalibratedModel,
        columns: FilterColumns,
        trials: &'a [&'a Trial],
        least_step_s: Option<f64>,
    ) -> Result<Self, RefineError> {
        let mut all = Self::every_sample(learned, columns, trials, least_step_s)?;
        set_reading_intervals(&mut all.records, learned.reading_interval_s);
        let known = learned.model.uncertainty.as_ref();
        let noise = instrument_noise(&all.records, all.lpp_m, all.speed_m_s, known);
        all.with_instruments(noise)
    }

    /// Returns the interval between readings with independent noise, s; 0 where every sample is a
    /// reading.
    ///
    /// # Errors
    /// Returns an error that names what the model lacks.
    pub fn independent_interval_s(
        learned: &CalibratedModel,
        trials: &'a [&'a Trial],
    ) -> Result<f64, RefineError> {
        let all = Self::every_sample(learned, FilterColumns::default(), trials, None)?;
        Ok(reading_interval(&all.records).unwrap_or_default())
    }

    /// Prepares planned trials of which every sample is a reading, by given instruments: trials
    /// that are not carried out yet have no noise from which either could be determined.
    ///
    /// # Errors
    /// Returns an error that names what the model lacks.
    pub fn planned_trials(
        learned: &CalibratedModel,
        columns: FilterColumns,
        trials: &'a [&'a Trial],
        instruments: &InstrumentNoise,
    ) -> Result<Self, RefineError> {
        Self::every_sample(learned, columns, trials, None)?.with_instruments(instruments.clone())
    }

    fn every_sample(
        learned: &CalibratedModel,
        columns: FilterColumns,
        trials: &'a [&'a Trial],
        least_step_s: Option<f64>,
    ) -> Result<Self, RefineError> {
        let CalibratedModel { model, law, expected_rates, .. } = learned;
        let lpp_m = particulars::particular_value(&model.particulars, "lpp_m");
        let lpp_m = lpp_m.ok_or_else(|| {
            RefineError::Law(format!(
                "the model `{}` lacks `lpp_m`; add it to its particulars",
                model.name
            ))
        })?;
        // The approach of the trials takes precedence over the model's speed.
        let approach = trial_approach(trials).map(|approach| approach.speed_m_s);
        let speed_m_s = approach.or(model.speed_m_s).ok_or_else(|| {
            RefineError::Data("the trials have no channel `u`; map its column".into())
        })?;
        // Both intervals scale with the time in which the ship covers its length.
        let least_step_s = least_step_s.unwrap_or(THRESHOLDS.trials.least_step * lpp_m / speed_m_s);
        let settles_s = THRESHOLDS.trials.settles * lpp_m / speed_m_s;
        let records: Vec<TrialReadings<'a>> =
            trials.iter().map(|trial| TrialReadings::new(trial, least_step_s, settles_s)).collect();
        let frame = trials.first().map(|trial| trial.velocity).unwrap_or_default();
        let system = ResidualSystem::new(model, law, columns, frame)?;
        let system = system.with_expected_rates(*expected_rates);
        let noise = InstrumentNoise::default();
        Ok(Self { trials, noise, lpp_m, speed_m_s, system, records, linear: Vec::new() })
    }

    /// Replaces the instruments; a channel that `noise` does not have keeps its own.
    pub fn with_noise(mut self, noise: &InstrumentNoise) -> Self {
        self.noise.extend(noise);
        self
    }

    pub fn columns(&self) -> &FilterColumns {
        &self.system.columns
    }

    pub fn axes(&self) -> &[Axis] {
        &self.system.axes
    }

    pub fn frame(&self) -> VelocityFrame {
        self.system.frame
    }

    pub fn records(&self) -> &[TrialReadings<'a>] {
        &self.records
    }

    /// Linearised parts by trial, where they are kept ([`Self::new`]).
    pub fn linearised_parts(&self) -> &[Vec<LinearisedPart>] {
        &self.linear
    }

    /// Returns a trial linearised, from the kept parts or again.
    ///
    /// # Errors
    /// Returns an error that names what the trial lacks.
    pub fn parts_of_trial(&self, trial: usize) -> Result<Cow<'_, [LinearisedPart]>, RefineError> {
        match self.linear.get(trial) {
            Some(kept) => Ok(Cow::Borrowed(kept)),
            None => linearise(&self.system, &self.records[trial], LinearisationDetail::Whole)
                .map(Cow::Owned),
        }
    }

    /// Highest recorded revolutions, 1/s; 0 where none were recorded.
    pub fn highest_revolutions(&self) -> f64 {
        let recorded = self.trials.iter().filter_map(|trial| trial.channel(Channel::N));
        recorded.flatten().fold(0.0, |most, n| n.abs().max(most))
    }

    pub fn motion_scales(&self) -> MotionScales {
        let rate = self.speed_m_s / self.lpp_m;
        let of = |axis: &Axis| {
            if matches!(axis, Axis::X | Axis::Y) { self.speed_m_s * rate } else { rate * rate }
        };
        MotionScales { accelerations: self.axes().iter().map(of).collect(), time_s: rate.recip() }
    }

    /// Returns the products of each trial.
    ///
    /// # Errors
    /// Returns an error that names what a trial lacks.
    pub fn products_per_trial(
        &self,
        discrepancies: &AxisDiscrepancies,
    ) -> Result<Vec<GramMatrix>, RefineError> {
        self.column_products_per_trial(self.columns().len(), &self.noise, discrepancies)
    }

    /// Returns the products of each trial with the coefficients' columns alone, by other
    /// instruments.
    ///
    /// # Errors
    /// Returns an error that names what a trial lacks.
    pub fn coefficient_products_under(
        &self,
        noise: &InstrumentNoise,
        discrepancies: &AxisDiscrepancies,
    ) -> Result<Vec<GramMatrix>, RefineError> {
        self.column_products_per_trial(self.columns().nuisance.len(), noise, discrepancies)
    }

    fn column_products_per_trial(
        &self,
        columns: usize,
        noise: &InstrumentNoise,
        discrepancies: &AxisDiscrepancies,
    ) -> Result<Vec<GramMatrix>, RefineError> {
        let of_trial = |trial: usize| {
            let parts = self.parts_of_trial(trial)?;
            let of = |part: &LinearisedPart| filter_columns(part, columns, noise, discrepancies);
            let grams: Vec<GramMatrix> = parts.iter().map(of).collect::<Result<_, _>>()?;
            Ok(GramMatrix::sum_parts(&grams, 1 + columns))
        };
        (0..self.trials.len()).into_par_iter().map(of_trial).collect()
    }
}

/// Sets the interval between readings by their noise, and at least to that of the model's own
/// trials.
fn set_reading_intervals(records: &mut [TrialReadings<'_>], as_before_s: Option<f64>) {
    let Some(as_before_s) = as_before_s else {
        let every = reading_stride(records);
        return records.iter_mut().for_each(|record| record.every = every);
    };
    // The interval of the model's own trials is a lower limit.
    let interval_s = as_before_s.max(reading_interval(records).unwrap_or_default());
    records.iter_mut().for_each(|record| record.read_every(interval_s));
}

/// Noise of each instrument over all trials, by its readings and the model's calibration.
fn instrument_noise(
    records: &[TrialReadings<'_>],
    lpp_m: f64,
    speed_m_s: f64,
    known: Option<&Uncertainty>,
) -> InstrumentNoise {
    let read = [
        Channel::U,
        Channel::V,
        Channel::R,
        Channel::P,
        Channel::Phi,
        Channel::Psi,
        Channel::X,
        Channel::Y,
        Channel::UWater,
        Channel::VWater,
    ];
    let one = |channel: Channel| {
        let scatter = NoiseLevel::from_deviation(
            noise_deviation(records, channel, &|record| record.every)?
                .max(noise_floor(channel, lpp_m, speed_m_s)),
        );
        let known = known.and_then(|known| known.instruments.get(channel.name()));
        // The calibration gives the noise relative to that of the readings, and the drift
        // absolutely.
        let of = |known: &InstrumentFit| NoiseLevel {
            deviation: scatter.deviation * known.deviation_by_scatter,
            drift: scatter.drift.max(known.drift),
        };
        Some((channel, known.map_or(scatter, of)))
    };
    read.into_iter().filter_map(one).collect()
}

#[cfg(test)]
#[path = "linearised_trials_tests.rs"]
mod tests;
