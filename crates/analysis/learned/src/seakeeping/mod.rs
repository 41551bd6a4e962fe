//! Standard deviations of heave, pitch and roll from a directional wave spectrum (Kanazawa 2023,
//! sec. 3.4): responses by closed forms or by a table, and a factor for each motion that is learned
//! from samples, after thinning out the common ones. The learned factor is in series: it maps the
//! output of the responses.

mod balance;
mod factor;
mod heave_pitch;
mod hull;
mod response;
mod roll;
mod spectrum;
mod table;

pub use balance::balance_samples;
pub use factor::fit_factor;
pub use hull::WaveHull;
pub use response::{ResponseOperator, WaveMotion};
pub use spectrum::DirectionalSpectrum;
pub use table::{ResponseGrid, ResponseTable, TableFault, TableFaults};
