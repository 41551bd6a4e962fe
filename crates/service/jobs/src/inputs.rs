//! Access of a derivation to the archive: documents by their hashes, and nothing else. Every read
//! is recorded, so that a recipe which does not name all inputs is refused when it is made.

use std::collections::BTreeSet;
use std::sync::{Mutex, PoisonError};

use bytes::Bytes;
use sistership_fleet::family::FamilyPrior;
use sistership_model::trial::Trial;
use sistership_model::version::{RecipeTrial, SourceVersion};
use sistership_model::{Law, Model, Vessel};

use crate::archive::Archive;
use crate::error::DeriveError;
use crate::input::{DerivationInput, InputKind};
use crate::library::EffectLibrary;
use crate::recipe::{DerivationRecipe, PriorName};

type Result<T> = std::result::Result<T, DeriveError>;

/// The only access of a derivation to the archive, with a record of what was read.
#[derive(Debug)]
pub struct DerivationInputs<'a> {
    archive: &'a Archive,
    read: Mutex<BTreeSet<DerivationInput>>,
}

impl<'a> DerivationInputs<'a> {
    /// Creates the access, with nothing read.
    pub fn new(archive: &'a Archive) -> Self {
        Self { archive, read: Mutex::default() }
    }

    fn record_read(&self, kind: InputKind, sha256: &str) {
        // A lock and not a cell: the inputs of one derivation may be read from several tasks.
        self.read.lock().unwrap_or_else(PoisonError::into_inner).insert(kind.with_hash(sha256));
    }

    /// Returns the ship at the revision whose document has this hash.
    pub async fn read_ship(&self, name: &str, sha256: &str) -> Result<Vessel> {
        self.record_read(InputKind::Ship, sha256);
        self.archive.ship_by_hash(name, sha256).await
    }

    /// Returns the law of this name, whose text has this hash.
    pub async fn read_law(&self, name: &str, sha256: &str) -> Result<Law> {
        self.record_read(InputKind::Law, sha256);
        self.archive.law_by_hash(name, sha256).await
    }

    /// Returns the model of a version, without the weights of its learned correction.
    pub async fn read_source(&self, source: &SourceVersion) -> Result<Model> {
        self.record_read(InputKind::Version, &source.sha256);
        self.archive.source_model(source).await
    }

    /// Returns the model of a version with the weights of its learned correction, if it has one.
    /// They are no input of their own: the version's document names them by their hash.
    pub async fn read_model(&self, source: &SourceVersion) -> Result<Model> {
        let mut model = self.read_source(source).await?;
        self.archive.attach_weights(&mut model).await?;
        Ok(model)
    }

    /// Returns trials with their samples, in the order given.
    pub async fn read_trials(&self, trials: &[RecipeTrial]) -> Result<Vec<Trial>> {
        trials.iter().for_each(|trial| self.record_read(InputKind::Samples, &trial.sha256));
        self.archive.read_trials(trials).await
    }

    /// Returns the samples of one trial as they are stored.
    pub async fn read_samples(&self, trial: &RecipeTrial) -> Result<Bytes> {
        self.record_read(InputKind::Samples, &trial.sha256);
        Ok(self.archive.objects.get(&trial.sha256).await?)
    }

    /// Returns the library of effects with this hash.
    pub async fn read_effects(&self, sha256: &str) -> Result<EffectLibrary> {
        self.record_read(InputKind::Effects, sha256);
        self.archive.effect_library(sha256).await
    }

    /// Returns the prior of a family at the revision that a recipe names.
    pub async fn read_prior(&self, name: &PriorName) -> Result<FamilyPrior> {
        self.record_read(InputKind::Prior, &name.sha256);
        self.archive.family_prior(name).await
    }

    /// Checks that the recipe names exactly what was read.
    ///
    /// # Errors
    /// Returns an error that names each input for which this is not the case: a defect of the
    /// program, which must not make a version.
    pub fn check_recipe(&self, recipe: &DerivationRecipe) -> Result<()> {
        let (read, named) =
            (self.read.lock().unwrap_or_else(PoisonError::into_inner), recipe.all_inputs());
        let unnamed = read
            .difference(&named)
            .map(|input| format!("{input} was read, but is not listed in the recipe"));
        let unread = named
            .difference(&read)
            .map(|input| format!("{input} is listed in the recipe, but was not read"));
        let faults: Vec<String> = unnamed.chain(unread).collect();
        if faults.is_empty() { Ok(()) } else { Err(DeriveError::Lost(faults.join("; "))) }
    }
}
