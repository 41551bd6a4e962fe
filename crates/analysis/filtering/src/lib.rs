//! The residual of a model on trials: what its instruments say, less what the model and all earlier
//! readings predict.
//!
//! A Kalman filter runs along each trial. Its state is the ship's (velocities, heading, position,
//! roll), each of whose accelerations also carries a random discrepancy of exponential
//! autocorrelation; the instruments read it with white noise. The one-step prediction errors,
//! divided by their predicted scatter, are white where the model holds. Nothing is differentiated,
//! equations of motion and kinematic identities count by what they really say, whatever a trial
//! does not record is left out, and a sensor that disagrees with the others is seen as one.
//!
//! The model is linearised along the recorded motion, so that every coefficient and every parameter
//! of an effect is one more column that passes the same filter ([`Columns`]): sums over samples of
//! their products ([`Gram`]) are all that fitting, evidence and comparison need.

mod columns;
mod correction;
mod discrepancies;
mod filter;
mod filter_noise;
mod filter_value;
mod followed;
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
mod symmetric_products;
mod tangents;
mod tapes;
mod thresholds;
mod transition;

pub use columns::{Columns, EffectCandidate, Nuisance, NuisanceKind, lacked_name};
pub use discrepancies::Discrepancies;
pub use filter::{Whitened, errors, filter, filter_first, responses, whitened};
pub use filter_noise::unknown_noise;
pub use gram::Gram;
pub use likelihood::deviances;
pub use linearise::linearise;
pub use linearised::{Detail, Linearised, RateResponse};
pub use noise::{Instrument, Noise, floor, reading_interval, scatter, sparseness};
pub use record::TrialReadings;
pub use smoother::{Smoothed, smoothed};
pub use tapes::ResidualSystem;
