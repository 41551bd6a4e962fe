//! Prediction errors of a model on trials: readings of the instruments less the prediction from the
//! model and all earlier readings.
//!
//! A Kalman filter runs along each trial. Its state is the ship's (velocities, heading, position,
//! roll), and each acceleration also carries a random discrepancy of exponential autocorrelation;
//! the instruments read the state with white noise. The one-step prediction errors (innovations),
//! divided by their predicted standard deviations, are white where the model holds. Nothing is
//! differentiated numerically, equations of motion and kinematic identities count by their
//! information, channels that a trial does not record are omitted, and a sensor that disagrees with
//! the others is identified.
//!
//! The model is linearised along the recorded motion, so that every coefficient and every parameter
//! of an effect is one more column that passes the same filter. Fitting, evidence and comparison
//! need only the sums over samples of the products of these columns.

mod adjoint_filter;
mod columns;
mod correction;
mod discrepancies;
mod filter;
mod filter_gains;
mod filter_noise;
mod filter_value;
mod followed;
mod form_errors;
mod gram;
mod instruments;
mod jumps;
mod kalman_filter;
mod lanes;
mod likelihood;
mod linearise;
mod linearised;
mod lineariser;
mod noise;
mod path;
mod record;
mod regressor_block;
mod sample_block;
mod secants;
mod smoother;
mod strip_filter;
mod strip_products;
mod symmetric_products;
mod tangents;
mod tapes;
mod thresholds;
mod transition;
mod whitened_columns;

pub use columns::{
    EffectCandidate, FilterColumns, NuisanceColumn, NuisanceKind, missing_term_name,
};
pub use discrepancies::AxisDiscrepancies;
pub use filter::{WhitenedRows, column_responses, filter_columns, filter_part, prediction_errors};
pub use filter_gains::FilterGains;
pub use filter_noise::unknown_noise_error;
pub use form_errors::{AxisColumn, FORM_ERRORS};
pub use gram::GramMatrix;
pub use likelihood::part_deviances;
pub use linearise::linearise;
pub use linearised::{LinearisationDetail, LinearisedPart, RateResponse};
pub use noise::{
    InstrumentNoise, NoiseLevel, noise_deviation, noise_floor, reading_interval, reading_stride,
};
pub use record::TrialReadings;
pub use smoother::{SmoothedDiscrepancies, smooth_discrepancies};
pub use tapes::ResidualSystem;
pub use whitened_columns::{SegmentedColumns, WhitenedColumns};
