//! What sources say, kept while one ship is fitted by several laws.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use sistership_model::Model;
use sistership_model::law::Law;

use crate::refine::envelope::OperatingEnvelope;
use crate::refine::outcome::RefineError;

/// What sources say where a model will be used, by source and its law. The same for every law that
/// is fitted to the same trials of the same ship, and only among those may it be shared.
#[derive(Debug, Default)]
pub struct SourceEnvelopes(Mutex<BTreeMap<(String, String), Arc<OperatingEnvelope>>>);

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
        let key = (source.name.clone(), law.name.clone());
        let known = self.0.lock().unwrap_or_else(PoisonError::into_inner).get(&key).cloned();
        if let Some(known) = known {
            return Ok(known);
        }
        let asked = Arc::new(ask()?);
        self.0.lock().unwrap_or_else(PoisonError::into_inner).insert(key, Arc::clone(&asked));
        Ok(asked)
    }
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
