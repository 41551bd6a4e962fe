//! Listener for HTTP connections: bounded in number, in the time for heads, in the progress of
//! bodies and answers, and in the time to shut down. It knows HTTP, and no ship.

mod address;
mod bind;
mod body;
mod connection;
mod descriptors;
mod forwarded;
mod limits;
mod pace;
mod peer;
mod seats;
mod serve;
mod stopping;
mod stream;
mod throttle;

pub use address::party;
pub use bind::bind;
pub use descriptors::suited;
pub use forwarded::{ForwardedHeader, Network, TrustedProxies};
pub use limits::Limits;
pub use peer::{Peer, is_health};
pub use serve::listen;
pub use stopping::Stopping;
pub use throttle::Throttle;
