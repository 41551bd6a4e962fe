//! The data under `../shared`, which is not part of the project.

use std::path::{Path, PathBuf};

/// A file or folder under `../shared/data`; `None`, said plainly, where it is missing.
///
/// # Panics
/// Where it is missing although `SISTERSHIP_REQUIRE_SHARED=1` says that it must be there.
pub fn data(relative: &str) -> Option<PathBuf> {
    let place = PathBuf::from("shared/data").join(relative);
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().map(|above| above.join(&place));
    if let Some(path) = beside.into_iter().find(|path| path.exists()) {
        return Some(path);
    }
    let path = place;
    let required = std::env::var("SISTERSHIP_REQUIRE_SHARED").is_ok_and(|value| value == "1");
    assert!(!required, "{} is missing and SISTERSHIP_REQUIRE_SHARED=1", path.display());
    println!("skipped: {} is missing", path.display());
    None
}

/// A CSV file's columns by name.
///
/// # Panics
/// Where the file cannot be read: these are reference files.
pub fn columns(path: &Path) -> std::collections::BTreeMap<String, Vec<f64>> {
    let text =
        std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    let mut columns: std::collections::BTreeMap<String, Vec<f64>> =
        names.iter().map(|name| ((*name).to_owned(), Vec::new())).collect();
    for line in lines.filter(|line| !line.is_empty()) {
        for (name, cell) in names.iter().zip(line.split(',')) {
            let value =
                cell.parse().unwrap_or_else(|error| panic!("{}: {cell}: {error}", path.display()));
            if let Some(column) = columns.get_mut(*name) {
                column.push(value);
            }
        }
    }
    columns
}
