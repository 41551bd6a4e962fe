//! Cache of the envelopes of sources, while one ship is fitted by several laws.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use sistership_model::Model;
use sistership_model::law::Law;

use crate::refine::envelope::{MemberRates, OperatingEnvelope};
use crate::refine::outcome::RefineError;

/// Envelopes of sources, by source and its law. They are the same for every law that is fitted to
/// the same trials of the same ship, and may be shared only among those.
#[derive(Debug, Default)]
pub struct SourceEnvelopes {
    envelopes: SharedCache<OperatingEnvelope>,
    /// Accelerations of the ships of a population at the states of a source's envelope.
    populations: SharedCache<Vec<MemberRates>>,
}

/// Values by the names of a source and its law.
type SharedCache<T> = Mutex<BTreeMap<(String, String), Arc<T>>>;

impl SourceEnvelopes {
    /// Returns the envelope of a source, computed on first use. Concurrent first uses all compute
    /// it: waiting for each other could block the threads of the pool that they share.
    ///
    /// # Errors
    /// Returns the error of `ask`.
    pub(super) fn source_envelope(
        &self,
        (source, law): (&Model, &Law),
        ask: impl FnOnce() -> Result<OperatingEnvelope, RefineError>,
    ) -> Result<Arc<OperatingEnvelope>, RefineError> {
        get_or_compute(&self.envelopes, (source.name.clone(), law.name.clone()), ask)
    }

    /// Returns the accelerations of a population at the states of a source's envelope, computed on
    /// first use.
    ///
    /// # Errors
    /// Returns the error of `ask`.
    pub(in super::super) fn population_rates(
        &self,
        envelope: &OperatingEnvelope,
        ask: impl FnOnce() -> Result<Vec<MemberRates>, RefineError>,
    ) -> Result<Arc<Vec<MemberRates>>, RefineError> {
        get_or_compute(&self.populations, (envelope.source.clone(), envelope.law.clone()), ask)
    }
}

/// The cached value of a key, or that of `ask`, which is then cached. The lock is not held while
/// `ask` runs.
fn get_or_compute<T>(
    known: &SharedCache<T>,
    key: (String, String),
    ask: impl FnOnce() -> Result<T, RefineError>,
) -> Result<Arc<T>, RefineError> {
    // A poisoned lock is harmless: values are inserted whole.
    let found = known.lock().unwrap_or_else(PoisonError::into_inner).get(&key).cloned();
    if let Some(found) = found {
        return Ok(found);
    }
    let asked = Arc::new(ask()?);
    known.lock().unwrap_or_else(PoisonError::into_inner).insert(key, Arc::clone(&asked));
    Ok(asked)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use sistership_model::Zoo;

    #[test]
    fn a_source_is_asked_once() {
        let zoo = Zoo::load_embedded().unwrap();
        let model = zoo.find_model("mariner").unwrap();
        let law = zoo.law(&model.law).unwrap();
        let known = SourceEnvelopes::default();
        let refused = || Err(RefineError::Data("nowhere".to_owned()));
        assert!(known.source_envelope((&model, law), refused).is_err());
        let first = known
            .source_envelope((&model, law), || OperatingEnvelope::new(&model, law, &[]))
            .unwrap();
        let again = known.source_envelope((&model, law), refused).unwrap();
        assert!(Arc::ptr_eq(&first, &again));
        let other = Model { name: "another".to_owned(), ..model.clone() };
        assert!(known.source_envelope((&other, law), refused).is_err());
    }
}
