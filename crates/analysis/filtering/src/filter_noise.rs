//! Assumptions of a filter on instruments and on accelerations that no model explains.

use sistership_identification::refine::RefineError;
use sistership_model::trial::Channel;
use sistership_model::uncertainty::Discrepancy;

use super::discrepancies::AxisDiscrepancies;
use super::linearised::LinearisedPart;
use super::noise::{InstrumentNoise, NoiseLevel};
use super::thresholds::RESIDUAL;

/// Noise of the channels, states and axes of a part.
pub(super) struct FilterNoise {
    /// Noise of each channel.
    instruments: Vec<NoiseLevel>,
    /// Instrument that reads each state, if any.
    readers: Vec<Option<NoiseLevel>>,
    discrepancies: AxisDiscrepancies,
}

impl FilterNoise {
    /// Creates the noise of the channels of a part.
    ///
    /// # Errors
    /// Returns an error if the noise of a channel is unknown, or if the number of discrepancies
    /// differs from that of accelerations.
    pub fn new(
        part: &LinearisedPart,
        noise: &InstrumentNoise,
        discrepancies: &AxisDiscrepancies,
    ) -> Result<Self, RefineError> {
        if discrepancies.len() != part.sizes.axes {
            return Err(RefineError::Law(format!(
                "the filter has discrepancies of {} accelerations, but the model has {} \
                 accelerations",
                discrepancies.len(),
                part.sizes.axes
            )));
        }
        let known = |(channel, _): &(Channel, usize)| {
            noise.get(channel).copied().ok_or_else(|| unknown_noise_error(*channel))
        };
        let instruments = part.channels.iter().map(known).collect::<Result<Vec<_>, _>>()?;
        let reader = |state: usize| {
            let channel = part.channels.iter().position(|(_, place)| *place == state);
            channel.map(|channel| instruments[channel])
        };
        let readers = (0..part.sizes.states).map(reader).collect();
        Ok(Self { instruments, readers, discrepancies: discrepancies.clone() })
    }

    /// Variances before the first reading, of states and then of discrepancies. A state without an
    /// instrument starts on the path.
    pub fn start_variances(&self) -> impl Iterator<Item = f64> + '_ {
        let of_state = |reader: &Option<NoiseLevel>| {
            reader.map_or(RESIDUAL.unread_variance, |instrument| {
                (RESIDUAL.start * instrument.deviation).powi(2)
            })
        };
        let of_axis = |discrepancy: &Discrepancy| discrepancy.deviation.powi(2);
        self.readers.iter().map(of_state).chain(self.discrepancies.iter().map(of_axis))
    }

    /// Variance of the drift of each state in a second.
    pub fn state_densities(&self) -> impl Iterator<Item = f64> + '_ {
        let drift = |reader: &Option<NoiseLevel>| {
            reader.map_or(RESIDUAL.unread_drift, |instrument| instrument.drift).powi(2)
        };
        self.readers.iter().map(drift)
    }

    /// Variance of the readings of a channel.
    pub fn reading_variance(&self, channel: usize) -> f64 {
        self.instruments[channel].deviation * self.instruments[channel].deviation
    }

    /// Discrepancy of each acceleration.
    pub fn discrepancies(&self) -> &[Discrepancy] {
        &self.discrepancies
    }
}

/// Error for readings of a channel whose noise is unknown.
pub fn unknown_noise_error(channel: Channel) -> RefineError {
    RefineError::Data(format!(
        "the noise of the channel `{}` cannot be estimated: this needs seven readings in sequence \
         without a gap; give a trial with such readings, or do not map the channel",
        channel.name()
    ))
}
