//! The pages for people: the contents of the store, as self-contained HTML. Independent of routes:
//! a page takes an archive and a query, and returns its text.
//!
//! Pages that simulate are made in two steps, of which the first reads and the second computes, so
//! that the caller chooses the thread.

pub mod audit;
mod beginning;
pub mod compare;
pub mod conditions;
mod cursor;
mod date;
mod error;
pub mod families;
pub mod fleet;
mod form;
pub mod jobs;
mod language;
mod named;
pub mod new_ship;
mod numbers;
pub mod particulars;
pub mod people;
mod pickers;
mod picture;
pub mod playground;
mod plot;
mod problem;
mod rows;
mod shell;
pub mod ship;
mod sparkline;
mod terms;
pub mod trial;
pub mod upload;
pub mod version;
pub mod zoo;

pub use beginning::{from_content, page_beginning};
pub use error::{PageError, Result};
pub use form::FormFields;
pub use language::{
    ArgumentValue, Language, MarkupMessage, Message, MessageArgument, say, say_html, say_word,
};
pub use problem::{PageProblem, problem_page};
pub use shell::{PageShell, PageUser, TOKEN_FIELD, report_policy, security_policy};
