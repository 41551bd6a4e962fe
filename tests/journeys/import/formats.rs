//! Files of several formats by one command.

use std::path::PathBuf;

use super::forms::{Files, one, plain};
use super::{containers, import};
use crate::sea_trials;

#[test]
fn five_files_of_five_formats_are_five_trials() {
    let trials = sea_trials::few();
    let (zigzag, wide) = (&trials[0], &trials[1]);
    let files: Vec<Files> = vec![
        one(1, "csv", plain(zigzag).csv()),
        containers::workbook(wide, 2),
        containers::matlab(zigzag, 3),
        containers::parquet(wide, 4),
        containers::nmea2000(zigzag, 5),
    ];
    let folder = tempfile::tempdir().expect("a folder");
    let write = |(name, bytes): (String, Vec<u8>)| -> PathBuf {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).expect("written");
        path
    };
    let paths: Vec<PathBuf> = files.into_iter().flatten().map(write).collect();
    let answer = import(folder.path(), &paths, 0);
    assert_eq!(answer["trials"].as_array().map(Vec::len), Some(5), "{answer}");
    assert_eq!(answer["errors"].as_array().map(Vec::len), Some(0), "{answer}");
}
