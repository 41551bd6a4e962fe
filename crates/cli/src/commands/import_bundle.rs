//! `sistership import --bundle`: a ship of another store.

use std::path::Path;

use sistership_pipeline::bundle::{Bundle, Taken, take};

use super::store::{StoreArguments, with_archive};
use crate::failure::{Failure, about_file};
use crate::output::{self, count};

/// Takes a bundle into a store.
///
/// # Errors
/// The file is no bundle, or the store contradicts it; then nothing is taken.
pub fn run(path: &Path, store: &StoreArguments, json: bool) -> Result<(), Failure> {
    let bytes = std::fs::read(path).map_err(|error| about_file(path, error))?;
    let bundle = Bundle::unpacked(&bytes).map_err(|error| about_file(path, error))?;
    let taken = with_archive(store, async |archive| take(archive, &bundle).await)?;
    output::print(json, &taken, || text(&taken))
}

fn text(taken: &Taken) -> String {
    let Taken { ship, ships, versions, trials, known } = taken;
    let named = |names: &[String]| if names.is_empty() { "none".into() } else { names.join(", ") };
    format!(
        "{ship}\n  new ships: {}\n  new versions: {}\n  {} of them there already\n  {}\n",
        named(ships),
        named(versions),
        count(*known, "version"),
        count(*trials, "new trial")
    )
}
