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
use crate::input::{Input, InputKind};
use crate::library::Library;
use crate::recipe::{PriorName, Recipe};

type Result<T> = std::result::Result<T, DeriveError>;

/// The only access of a derivation to the archive, with a record of what was read.
#[derive(Debug)]
pub struct Inputs<'a> {
    archive: &'a Archive,
    read: Mutex<BTreeSet<Input>>,
}

impl<'a> Inputs<'a> {
    /// Creates the access, with nothing read.
    pub fn new(archive: &'a Archive) -> Self {
        Self { archive, read: Mutex::default() }
    }

    fn note(&self, kind: InputKind, sha256: &str) {
        // A lock and not a cell: the inputs of one derivation may be read from several tasks.
        self.read.lock().unwrap_or_else(PoisonError::into_inner).insert(kind.of(sha256));
    }

    /// Returns the ship at the revision whose document has this hash.
    pub async fn ship(&self, name: &str, sha256: &str) -> Result<Vessel> {
        self.note(InputKind::Ship, sha256);
        self.archive.ship(name, sha256).await
    }

    /// Returns the law of this name, whose text has this hash.
    pub async fn law(&self, name: &str, sha256: &str) -> Result<Law> {
        self.note(InputKind::Law, sha256);
        self.archive.law(name, sha256).await
    }

    /// Returns the model of a version, without the weights of its learned correction.
    pub async fn source(&self, source: &SourceVersion) -> Result<Model> {
        self.note(InputKind::Version, &source.sha256);
        self.archive.source(source).await
    }

    /// Returns the model of a version with the weights of its learned correction, if it has one.
    /// They are no input of their own: the version's document names them by their hash.
    pub async fn model(&self, source: &SourceVersion) -> Result<Model> {
        let mut model = self.source(source).await?;
        self.archive.attach(&mut model).await?;
        Ok(model)
    }

    /// Returns trials with their samples, in the order given.
    pub async fn trials(&self, trials: &[RecipeTrial]) -> Result<Vec<Trial>> {
        trials.iter().for_each(|trial| self.note(InputKind::Samples, &trial.sha256));
        self.archive.trials(trials).await
    }

    /// Returns the samples of one trial as they are stored.
    pub async fn samples(&self, trial: &RecipeTrial) -> Result<Bytes> {
        self.note(InputKind::Samples, &trial.sha256);
        Ok(self.archive.objects.get(&trial.sha256).await?)
    }

    /// Returns the library of effects with this hash.
    pub async fn effects(&self, sha256: &str) -> Result<Library> {
        self.note(InputKind::Effects, sha256);
        self.archive.effects(sha256).await
    }

    /// Returns the prior of a family at the revision that a recipe names.
    pub async fn prior(&self, name: &PriorName) -> Result<FamilyPrior> {
        self.note(InputKind::Prior, &name.sha256);
        self.archive.prior(name).await
    }

    /// Checks that the recipe names exactly what was read.
    ///
    /// # Errors
    /// Returns an error that names each input for which this is not the case: a defect of the
    /// program, which must not make a version.
    pub fn check(&self, recipe: &Recipe) -> Result<()> {
        let (read, named) =
            (self.read.lock().unwrap_or_else(PoisonError::into_inner), recipe.inputs());
        let unnamed = read
            .difference(&named)
            .map(|input| format!("{input} was read, but the recipe does not name it"));
        let unread = named
            .difference(&read)
            .map(|input| format!("the recipe names {input}, which was not read"));
        let faults: Vec<String> = unnamed.chain(unread).collect();
        if faults.is_empty() { Ok(()) } else { Err(DeriveError::Lost(faults.join("; "))) }
    }
}
