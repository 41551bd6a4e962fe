//! The given recordings in SI units and canonical signs.

use std::path::{Path, PathBuf};

use sistership_columns::Role;

use crate::shared;

/// A recording: quantities of equal length.
#[derive(Clone)]
pub struct Source {
    pub name: &'static str,
    pub columns: Vec<(Role, Vec<f64>)>,
}

const DEG: f64 = std::f64::consts::PI / 180.0;

/// Rows of a text file that hold as many numbers as its last.
fn rows(path: &Path) -> Vec<Vec<f64>> {
    let bytes = std::fs::read(path).expect("a file");
    let text = String::from_utf8_lossy(&bytes).into_owned();
    let cells = |line: &str| -> Vec<f64> {
        let split = |c: char| c == ',' || c.is_whitespace();
        let cells = line.trim().split(split).filter(|cell| !cell.is_empty());
        cells.map(|cell| cell.parse().unwrap_or(f64::NAN)).collect()
    };
    let all: Vec<Vec<f64>> = text.lines().map(cells).collect();
    let width = all.iter().map(Vec::len).max().unwrap_or(0);
    all.into_iter().filter(|row| row.len() == width && row[1].is_finite()).collect()
}

fn source(name: &'static str, path: &Path, wanted: &[(Role, usize, f64)]) -> Source {
    let rows = rows(path);
    let column = |&(role, at, factor): &(Role, usize, f64)| {
        (role, rows.iter().map(|row| row[at] * factor).collect())
    };
    Source { name, columns: wanted.iter().map(column).collect() }
}

/// All of them; nothing where the data are missing.
pub fn sources() -> Option<Vec<Source>> {
    let files = |folder: &str, ending: &str| -> Option<Vec<PathBuf>> {
        let entries = std::fs::read_dir(shared::data(folder)?).expect("a folder");
        let mut files: Vec<PathBuf> =
            entries.map(|entry| entry.expect("an entry").path()).collect();
        files.retain(|path| path.extension().is_some_and(|known| known == ending));
        files.sort();
        Some(files)
    };
    let gunnerus = [
        (Role::Time, 1, 1.0),
        (Role::X, 2, 1.0),
        (Role::Y, 3, 1.0),
        (Role::Phi, 4, DEG),
        (Role::Psi, 5, DEG),
        (Role::U, 6, 1.0),
        (Role::V, 7, 1.0),
        (Role::R, 8, DEG),
        (Role::Delta, 9, -DEG),
        (Role::N, 10, 1.0 / 60.0),
    ];
    let patrol = [
        (Role::Time, 0, 1.0),
        (Role::N, 1, 1.0 / 60.0),
        (Role::DeltaP, 2, -1.0),
        (Role::DeltaS, 3, -1.0),
        (Role::U, 7, 1.0),
        (Role::V, 8, 1.0),
        (Role::P, 9, 1.0),
        (Role::R, 10, 1.0),
        (Role::Phi, 11, 1.0),
    ];
    let tank = [
        (Role::Time, 0, 1.0),
        (Role::X, 1, 1.0),
        (Role::Y, 2, 1.0),
        (Role::Psi, 3, DEG),
        (Role::VNorth, 4, 1.0),
        (Role::VEast, 5, 1.0),
        (Role::R, 6, DEG),
        (Role::Delta, 8, -DEG),
        (Role::N, 9, 1.0),
    ];
    let boat = [
        (Role::Time, 1, 1e-3),
        (Role::X, 5, 1.0),
        (Role::Y, 6, 1.0),
        (Role::Psi, 7, DEG),
        (Role::U, 8, 1.0),
        (Role::V, 9, 1.0),
        (Role::R, 10, 1.0),
    ];
    let mut all = Vec::new();
    all.extend(files("gunnerus", "csv")?.iter().map(|path| source("gunnerus", path, &gunnerus)));
    all.extend(
        files("patrol-ship", "csv")?.iter().map(|path| source("patrol ship", path, &patrol)),
    );
    all.extend(files("kvlcc2-hsva", "dat")?.iter().map(|path| source("tank", path, &tank)));
    all.extend(
        files("blueboat", "csv")?.iter().take(4).map(|path| source("catamaran", path, &boat)),
    );
    Some(all)
}
