//! What a ship of a population says.

use super::envelope::Rates;

/// What a ship says at the states of an envelope.
#[derive(Debug)]
pub(super) struct MemberRates {
    /// Its model's name.
    pub name: String,
    /// Its accelerations.
    pub rates: Rates,
}
