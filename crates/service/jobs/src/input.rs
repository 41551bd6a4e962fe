//! Input documents of derivations, by kind and hash.

use std::fmt;

/// Document that a derivation reads, by its kind and the SHA-256 of its bytes.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct DerivationInput {
    /// Its kind.
    pub kind: InputKind,
    /// The hash.
    pub sha256: String,
}

/// Kinds of documents that a derivation reads.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum InputKind {
    /// A ship's own document.
    Ship,
    /// A law's file.
    Law,
    /// A source version.
    Version,
    /// The samples of a trial.
    Samples,
    /// A library of effects.
    Effects,
    /// A prior of a family.
    Prior,
}

impl InputKind {
    /// Returns the input of this kind with this hash.
    pub fn with_hash(self, sha256: &str) -> DerivationInput {
        DerivationInput { kind: self, sha256: sha256.to_owned() }
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

impl fmt::Display for DerivationInput {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the {} {}", self.kind.name(), self.sha256)
    }
}
