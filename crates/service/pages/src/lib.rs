//! The pages for people: the contents of the store, as self-contained HTML. Independent of routes:
//! a page takes an archive and a query, and returns its text.
//!
//! Pages that simulate are made in two steps, of which the first reads and the second computes, so
//! that the caller chooses the thread.

pub mod audit;
mod beginning;
pub mod compare;
mod cursor;
mod date;
mod error;
pub mod families;
pub mod fleet;
mod form;
pub mod jobs;
mod named;
pub mod new_ship;
pub mod people;
mod picture;
pub mod playground;
mod plot;
mod problem;
mod rows;
mod shell;
pub mod ship;
mod sparkline;
pub mod trial;
pub mod upload;
pub mod version;
pub mod zoo;

pub use beginning::{beginning, from_content};
pub use error::{PageError, Result};
pub use form::Fields;
pub use problem::problem;
pub use shell::{Shell, SignedIn, TOKEN, policy};
