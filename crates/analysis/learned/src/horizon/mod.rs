//! One-shot prediction (Kanazawa 2023, secs. 2.1.3, 3.1, 3.3 and 4.1): a foundation simulates the
//! track ahead once under the future orders, and a network that is evaluated once corrects the
//! error of such tracks. Positions are in the ship's axes at the instant of the prediction (Eq.
//! 4.1), so that nothing depends on the heading.

mod ahead;
mod axes;
mod error;
mod example;
mod inputs;
mod predictor;
mod scaling;
mod training;

pub use ahead::predict_tracks;
pub use axes::ShipAxes;
pub use error::HorizonError;
pub use example::{OneShotSettings, TrackExample};
pub use inputs::OrderEncoding;
pub use predictor::TrackPredictor;
pub use training::{HorizonTraining, train_predictor};
