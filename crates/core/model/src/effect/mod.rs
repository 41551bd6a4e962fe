//! Effects: changes of a law by external causes, as data.

mod applied;
mod as_terms;
mod dress;
mod file;
mod form;
mod form_reader;
mod grammar;
mod names;
mod probe;
mod read;
mod scope;
mod symmetry;
mod term;

pub use applied::AppliedEffect;
pub use as_terms::AsTerms;
pub(crate) use dress::dress;
pub use dress::{TIME, input_channel, qualified};
pub use file::{
    ActsOn, EffectFile, EffectParameterFile, FormFile, GrammarFile, Mirror, PriorFile,
    PriorOddsFile,
};
pub use form::{EffectParameter, Form, Report};
pub use grammar::Grammar;
pub use read::Effect;
