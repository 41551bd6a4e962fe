//! What sources say, kept while one ship is fitted by several laws.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use sistership_model::Model;
use sistership_model::law::Law;

use crate::refine::envelope::{MemberRates, OperatingEnvelope};
use crate::refine::outcome::RefineError;

/// What sources say where a model will be used, by source and its law. The same for every law that
/// is fitted to the same trials of the same ship, and only among those may it be shared.
#[derive(Debug, Default)]
pub struct SourceEnvelopes {
    envelopes: Kept<OperatingEnvelope>,
    /// What the ships of a population say at the states of a source's.
    populations: Kept<Vec<MemberRates>>,
}

/// By source and its law.
type Kept<T> = Mutex<BTreeMap<(String, String), Arc<T>>>;

impl SourceEnvelopes {
    /// That of a source, which is asked where it has not been. Two that ask at once both do: to
    /// wait for each other could stop the threads that they share.
    ///
    /// # Errors
    /// As `ask`.
    pub(super) fn of(
        &self,
        (source, law): (&Model, &Law),
        ask: impl FnOnce() -> Result<OperatingEnvelope, RefineError>,
    ) -> Result<Arc<OperatingEnvelope>, RefineError> {
        kept(&self.envelopes, (source.name.clone(), law.name.clone()), ask)
    }

    /// What a population says at the states of a source's envelope.
    ///
    /// # Errors
    /// As `ask`.
    pub(in super::super) fn population(
        &self,
        envelope: &OperatingEnvelope,
        ask: impl FnOnce() -> Result<Vec<MemberRates>, RefineError>,
    ) -> Result<Arc<Vec<MemberRates>>, RefineError> {
        kept(&self.populations, (envelope.source.clone(), envelope.law.clone()), ask)
    }
}

fn kept<T>(
    known: &Kept<T>,
    key: (String, String),
    ask: impl FnOnce() -> Result<T, RefineError>,
) -> Result<Arc<T>, RefineError> {
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
        let zoo = Zoo::embedded().unwrap();
        let model = zoo.model("mariner").unwrap();
        let law = zoo.law(&model.law).unwrap();
        let known = SourceEnvelopes::default();
        let refused = || Err(RefineError::Data("nowhere".to_owned()));
        assert!(known.of((&model, law), refused).is_err());
        let first = known.of((&model, law), || OperatingEnvelope::new(&model, law, &[])).unwrap();
        let again = known.of((&model, law), refused).unwrap();
        assert!(Arc::ptr_eq(&first, &again));
        let other = Model { name: "another".to_owned(), ..model.clone() };
        assert!(known.of((&other, law), refused).is_err());
    }
}
