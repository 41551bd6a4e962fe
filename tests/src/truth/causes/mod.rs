//! What trials of a ship may hide, in forms other than those of the library: weather, water, gear,
//! forces and instruments.

mod blendermann;
mod current;
mod depth;
mod force;
mod gear;
mod hidden;
mod isherwood;
mod sailing;
mod sensors;
mod waves;
mod wind;

pub use current::Current;
pub use depth::Depth;
pub use force::{Force, resistance_n};
pub use gear::Gear;
pub use hidden::Hidden;
pub use sailing::{Course, trials};
pub use sensors::Sensor;
pub use waves::{DriftAuthor, Waves};
pub use wind::{Author, Wind};
