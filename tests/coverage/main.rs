//! Whether intervals hold what they promise, over ships whose coefficients are known.

mod diameters;
mod intervals;
mod zigzags;

/// What the environment says, or a default.
fn setting(name: &str, default: &str) -> String {
    std::env::var(name).unwrap_or_else(|_| default.to_owned())
}
