//! Library that reads and evaluates a model, compiled for the machines on which FMUs run.

use super::archive::ArchiveEntry;

/// Library of one kind of machine; it has the functions of both versions of FMI.
struct Library {
    /// Folder of FMI 2.0 (FMI 2.0.4, Sec. 2.3).
    fmi2: &'static str,
    /// Folders of FMI 3.0 (FMI 3.0.1, Sec. 2.5).
    fmi3: &'static [&'static str],
    /// Extension of a shared library.
    extension: &'static str,
    bytes: &'static [u8],
}

/// Libraries that `runtime/compile.py` writes, with the hashes of their sources beside them.
const LIBRARIES: [Library; 4] = [
    Library {
        fmi2: "linux64",
        fmi3: &["x86_64-linux"],
        extension: "so",
        bytes: include_bytes!("../../libraries/x86_64-linux.so"),
    },
    Library {
        // FMI 2.0 has no name for it; tools use that of FMI 3.0.
        fmi2: "aarch64-linux",
        fmi3: &["aarch64-linux"],
        extension: "so",
        bytes: include_bytes!("../../libraries/aarch64-linux.so"),
    },
    Library {
        fmi2: "win64",
        fmi3: &["x86_64-windows"],
        extension: "dll",
        bytes: include_bytes!("../../libraries/x86_64-windows.dll"),
    },
    Library {
        // One file for both processors.
        fmi2: "darwin64",
        fmi3: &["x86_64-darwin", "aarch64-darwin"],
        extension: "dylib",
        bytes: include_bytes!("../../libraries/darwin.dylib"),
    },
];

/// Version of the standard that an FMU follows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FmiVersion {
    /// FMI 2.0.
    Two,
    /// FMI 3.0.
    Three,
}

/// Files of the libraries of an FMU, by the model's identifier.
pub fn library_entries(version: FmiVersion, identifier: &str) -> Vec<ArchiveEntry> {
    let entries = |library: &'static Library| {
        let folders = match version {
            FmiVersion::Two => std::slice::from_ref(&library.fmi2),
            FmiVersion::Three => library.fmi3,
        };
        folders.iter().map(move |folder| {
            let place = format!("binaries/{folder}/{identifier}.{}", library.extension);
            ArchiveEntry::new(place, library.bytes)
        })
    };
    LIBRARIES.iter().flat_map(entries).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use std::path::{Path, PathBuf};
    use std::process::Command;

    use sistership_model::version::sha256_hex;

    const SUMS: &str = include_str!("../../libraries/SHA256SUMS");

    fn files(folder: &Path) -> Vec<PathBuf> {
        let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
        entries.flat_map(|path| if path.is_dir() { files(&path) } else { vec![path] }).collect()
    }

    #[test]
    fn libraries_are_those_of_the_sources() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
        let mut listed = Vec::new();
        for (sum, name) in SUMS.lines().map(|line| line.split_once("  ").unwrap()) {
            let found = sha256_hex(&std::fs::read(folder.join(name)).unwrap());
            assert_eq!(found, sum, "{name}: run runtime/compile.py after a change of the runtime");
            listed.push(folder.join(name));
        }
        let mut present = files(&folder.join("runtime"));
        present.extend(files(&folder.join("libraries")));
        present.retain(|path| !path.ends_with("SHA256SUMS"));
        present.sort();
        listed.sort();
        assert_eq!(present, listed);
    }

    #[test]
    fn the_compiler_gives_the_same_libraries_again() {
        let Ok(python) = std::env::var("SISTERSHIP_ZIG") else {
            eprintln!("skipped: SISTERSHIP_ZIG names no Python with ziglang");
            return;
        };
        let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
        let out = tempfile::tempdir().unwrap();
        let mut command = Command::new(python);
        command.arg(folder.join("runtime/compile.py")).arg(out.path());
        assert!(command.status().unwrap().success());
        for path in files(out.path()) {
            let name = path.file_name().unwrap();
            let stored = std::fs::read(folder.join("libraries").join(name)).unwrap();
            assert!(std::fs::read(&path).unwrap() == stored, "{}", name.display());
        }
        assert_eq!(files(out.path()).len(), super::LIBRARIES.len());
    }
}
