//! Faults injected into processes by a small library that is built here and loaded before libc:
//! `faults.c` has its words.

use std::fs::{File, OpenOptions};
use std::io;
use std::os::unix::fs::FileExt as _;
use std::path::{Path, PathBuf};
use std::process::Command;

use tempfile::TempDir;

/// The library, built.
pub struct Faults {
    folder: TempDir,
}

/// What strikes at the chosen operation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Strike {
    /// Nothing: operations are only counted.
    Nothing = 0,
    /// The process is killed before the operation.
    Kill = 1,
    /// This operation and all later ones find no space.
    Full = 2,
}

/// What steers the faults of one process and of those started after it.
pub struct Control {
    path: PathBuf,
    file: File,
}

impl Faults {
    /// Builds it with `cc`; none, where that is not there.
    ///
    /// # Errors
    /// No temporary folder.
    pub fn build() -> io::Result<Option<Self>> {
        let folder = tempfile::Builder::new().prefix("sistership-faults-").tempdir()?;
        let source = folder.path().join("faults.c");
        std::fs::write(&source, include_str!("faults.c"))?;
        let mut cc = Command::new("cc");
        cc.args(["-shared", "-fPIC", "-O1", "-o"])
            .arg(folder.path().join("faults.so"))
            .arg(source)
            .arg("-ldl");
        match cc.output() {
            Ok(built) if built.status.success() => Ok(Some(Self { folder })),
            Ok(built) => {
                eprintln!("no faults: {}", String::from_utf8_lossy(&built.stderr));
                Ok(None)
            }
            Err(error) => {
                eprintln!("no faults: cc: {error}");
                Ok(None)
            }
        }
    }

    /// The library's file.
    pub fn library(&self) -> PathBuf {
        self.folder.path().join("faults.so")
    }
}

impl Control {
    /// One that injects nothing yet.
    ///
    /// # Errors
    /// Its file cannot be written.
    pub fn new(folder: &Path) -> io::Result<Self> {
        let path = folder.join("faults.control");
        let file =
            OpenOptions::new().create(true).truncate(true).read(true).write(true).open(&path)?;
        file.set_len(4 * 8)?;
        Ok(Self { path, file })
    }

    /// What the process must find in its environment.
    pub fn environment(&self, faults: &Faults) -> [(&'static str, PathBuf); 2] {
        [("LD_PRELOAD", faults.library()), ("FAULTS_CONTROL", self.path.clone())]
    }

    /// Strikes at the `at`-th operation from now, counted from 1.
    ///
    /// # Errors
    /// Its file cannot be written.
    pub fn arm(&self, strike: Strike, at: i64) -> io::Result<()> {
        self.set(1, Strike::Nothing as i64)?;
        self.set(0, at)?;
        self.set(2, 0)?;
        self.set(1, strike as i64)
    }

    /// Operations since it was armed.
    ///
    /// # Errors
    /// Its file cannot be read.
    pub fn counted(&self) -> io::Result<i64> {
        let mut bytes = [0; 8];
        self.file.read_exact_at(&mut bytes, 2 * 8)?;
        Ok(i64::from_ne_bytes(bytes))
    }

    /// Puts the wall clock ahead, s.
    ///
    /// # Errors
    /// Its file cannot be written.
    pub fn ahead(&self, seconds: i64) -> io::Result<()> {
        self.set(3, seconds)
    }

    fn set(&self, place: u64, value: i64) -> io::Result<()> {
        self.file.write_all_at(&value.to_ne_bytes(), place * 8)
    }
}
