//! What a derivation may read: documents by their hashes, and nothing else. What was read is noted, so that a recipe which
//! does not name all of it is refused as it is made.

use std::collections::BTreeSet;
use std::fmt;
use std::sync::{Mutex, PoisonError};

use bytes::Bytes;
use sistership_fleet::family::FamilyPrior;
use sistership_model::trial::Trial;
use sistership_model::version::{RecipeTrial, SourceVersion};
use sistership_model::{Law, Model, Vessel};

use super::DeriveError;
use crate::archive::Archive;
use crate::fleet::PriorName;
use crate::library::Library;
use crate::version::Recipe;

/// A document that a derivation reads, by its kind and the SHA-256 of its bytes.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Input {
    /// What it is.
    pub kind: InputKind,
    /// The hash.
    pub sha256: String,
}

/// The kinds of documents that a derivation reads.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum InputKind {
    /// A ship's own document.
    Ship,
    /// A law's file.
    Law,
    /// A version that another starts from.
    Version,
    /// The samples of a trial.
    Samples,
    /// A library of effects.
    Effects,
    /// What a family has taught.
    Prior,
}

impl InputKind {
    /// The input of this kind with this hash.
    pub(crate) fn of(self, sha256: &str) -> Input {
        Input { kind: self, sha256: sha256.to_owned() }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Ship => "ship's document",
            Self::Law => "law",
            Self::Version => "version",
            Self::Samples => "samples",
            Self::Effects => "library of effects",
            Self::Prior => "family's prior",
        }
    }
}

impl fmt::Display for Input {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the {} {}", self.kind.name(), self.sha256)
    }
}

type Result<T> = std::result::Result<T, DeriveError>;

/// The one way from a derivation to the archive.
#[derive(Debug)]
pub(crate) struct Inputs<'a> {
    archive: &'a Archive,
    read: Mutex<BTreeSet<Input>>,
}

impl<'a> Inputs<'a> {
    pub(crate) fn new(archive: &'a Archive) -> Self {
        Self { archive, read: Mutex::default() }
    }

    fn note(&self, kind: InputKind, sha256: &str) {
        self.read.lock().unwrap_or_else(PoisonError::into_inner).insert(kind.of(sha256));
    }

    /// The ship as it was when its document had this hash.
    pub(crate) async fn ship(&self, name: &str, sha256: &str) -> Result<Vessel> {
        self.note(InputKind::Ship, sha256);
        self.archive.ship(name, sha256).await
    }

    /// The law of this name, whose text has this hash.
    pub(crate) async fn law(&self, name: &str, sha256: &str) -> Result<Law> {
        self.note(InputKind::Law, sha256);
        self.archive.law(name, sha256).await
    }

    /// The model of a version.
    pub(crate) async fn source(&self, source: &SourceVersion) -> Result<Model> {
        self.note(InputKind::Version, &source.sha256);
        self.archive.source(source).await
    }

    /// Trials with their samples, in their order.
    pub(crate) async fn trials(&self, trials: &[RecipeTrial]) -> Result<Vec<Trial>> {
        trials.iter().for_each(|trial| self.note(InputKind::Samples, &trial.sha256));
        self.archive.trials(trials).await
    }

    /// The samples of one trial as they are stored.
    pub(crate) async fn samples(&self, trial: &RecipeTrial) -> Result<Bytes> {
        self.note(InputKind::Samples, &trial.sha256);
        Ok(self.archive.objects.get(&trial.sha256).await?)
    }

    /// The library of effects of this hash.
    pub(crate) async fn effects(&self, sha256: &str) -> Result<Library> {
        self.note(InputKind::Effects, sha256);
        self.archive.effects(sha256).await
    }

    /// What a family has taught.
    pub(crate) async fn prior(&self, name: &PriorName) -> Result<FamilyPrior> {
        self.note(InputKind::Prior, &name.sha256);
        self.archive.prior(name).await
    }

    /// Whether the recipe names what was read, and all that it names was read.
    ///
    /// # Errors
    /// Names each input of which that is not so: a defect of the program, which must not make a version.
    pub(crate) fn check(&self, recipe: &Recipe) -> Result<()> {
        let (read, named) = (self.read.lock().unwrap_or_else(PoisonError::into_inner), recipe.inputs());
        let unnamed = read.difference(&named).map(|input| format!("{input} was read, but the recipe does not name it"));
        let unread = named.difference(&read).map(|input| format!("the recipe names {input}, which was not read"));
        let faults: Vec<String> = unnamed.chain(unread).collect();
        if faults.is_empty() { Ok(()) } else { Err(DeriveError::Lost(faults.join("; "))) }
    }
}
