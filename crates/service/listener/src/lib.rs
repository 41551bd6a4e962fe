//! Listener for HTTP connections: bounded in number, in the time for heads, in the progress of
//! bodies and answers, and in the time to shut down. It knows HTTP, and no ship.

mod address;
mod bind;
mod body;
mod connection;
mod descriptors;
mod forwarded;
mod limits;
mod peer;
mod progress;
mod serve;
mod slots;
mod stop_signal;
mod stream;
mod throttle;

pub use address::counted_address;
pub use bind::bind;
pub use descriptors::fit_to_descriptors;
pub use forwarded::{ForwardedHeader, NetworkRange, TrustedProxies};
pub use limits::ConnectionLimits;
pub use peer::{PeerInfo, is_health};
pub use serve::listen;
pub use stop_signal::StopSignal;
pub use throttle::KeyThrottle;
