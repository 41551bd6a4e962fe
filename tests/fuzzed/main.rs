//! What the fuzz targets hold of any input (`tests/fuzz`), on their corpora and on seeded mutations
//! of them: no nightly compiler is needed, and a defect that was found once stays found.

use std::path::Path;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha12Rng;
use sistership_tests::fuzzed;

/// Mutations of each file of a corpus.
const MUTATIONS: usize = 150;
/// Pieces that readers of text and numbers stumble over.
const PIECES: [&str; 16] = [
    "((", "))", "[", "{a: ", "- ", "\n", "\0", "nan", "1e400", "-", "^2", ",", ";", "\u{feff}",
    "&x", "@",
];

fn corpus(target: &str) -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus").join(target);
    let entries =
        std::fs::read_dir(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut files: Vec<_> = entries.map(|entry| entry.expect("a listed file").path()).collect();
    files.sort();
    files.iter().map(|file| std::fs::read(file).expect("a file of the corpus")).collect()
}

/// The input with some bytes changed, cut out, doubled, or a piece put in.
fn mutated(input: &[u8], random: &mut ChaCha12Rng) -> Vec<u8> {
    let mut bytes = input.to_vec();
    for _ in 0..random.random_range(1..4) {
        let at = random.random_range(0..=bytes.len());
        let end = (at + random.random_range(0..16_usize)).min(bytes.len());
        match random.random_range(0..4) {
            0 if at < bytes.len() => bytes[at] = random.random(),
            1 => drop(bytes.drain(at..end)),
            2 => {
                let doubled = bytes[at..end].to_vec();
                bytes.splice(at..at, doubled);
            }
            _ => {
                let piece =
                    PIECES[random.random_range(0..PIECES.len())].repeat(random.random_range(1..60));
                bytes.splice(at..at, piece.into_bytes());
            }
        }
    }
    bytes
}

fn hold(target: &str, run: fn(&[u8])) {
    let mut random = ChaCha12Rng::seed_from_u64(16);
    let corpus = corpus(target);
    assert!(!corpus.is_empty(), "{target} has no corpus");
    for input in &corpus {
        run(input);
        for _ in 0..MUTATIONS {
            run(&mutated(input, &mut random));
        }
    }
}

#[test]
fn formulas() {
    hold("formula", fuzzed::formula::run);
}

#[test]
fn laws() {
    hold("law", fuzzed::law::run);
}

#[test]
fn vessels() {
    hold("vessel", fuzzed::vessel::run);
}

#[test]
fn effects() {
    hold("effect", fuzzed::effect::run);
}

#[test]
fn manifests() {
    hold("manifest", fuzzed::manifest::run);
}

#[test]
fn csv_files() {
    hold("csv", fuzzed::csv::run);
}

#[test]
fn parquet_files() {
    hold("parquet", fuzzed::parquet::run);
}

#[test]
fn version_documents() {
    hold("version", fuzzed::version::run);
}
