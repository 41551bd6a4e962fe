//! Effects: changes of a law by external causes, as data.

mod applied;
mod as_terms;
mod effect_application;
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
pub use as_terms::EffectsAsTerms;
pub(crate) use effect_application::apply_effects;
pub use effect_application::{TIME_INPUT, input_channel, qualified_name};
pub use file::{
    ActsOn, EffectFile, EffectParameterFile, FormFile, GrammarFile, Mirror, PriorFile,
    PriorOddsFile,
};
pub use form::{EffectForm, EffectParameter, ReportedFigure};
pub use grammar::TermGrammar;
pub use read::Effect;
