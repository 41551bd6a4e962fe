//! Where a trial's bytes come from.

use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::path::Path;

use bytes::Bytes;

/// The first bytes of every Parquet file.
const PARQUET_MAGIC: &[u8] = b"PAR1";

/// A file to read: its name, used in every message, and its bytes.
pub struct Source<'a> {
    pub(crate) name: String,
    pub(crate) content: Content<'a>,
}

pub(crate) enum Content<'a> {
    Csv(Box<dyn Read + 'a>),
    ParquetBytes(Bytes),
    ParquetFile(File),
}

impl<'a> Source<'a> {
    /// CSV from any reader, streamed row by row.
    pub fn csv(name: impl Into<String>, reader: impl Read + 'a) -> Self {
        Self { name: name.into(), content: Content::Csv(Box::new(reader)) }
    }

    /// Parquet in memory.
    pub fn parquet(name: impl Into<String>, bytes: Bytes) -> Self {
        Self { name: name.into(), content: Content::ParquetBytes(bytes) }
    }

    /// A file in memory; Parquet is told from CSV by its first bytes, whatever the name says.
    pub fn bytes(name: impl Into<String>, bytes: Bytes) -> Self {
        if bytes.starts_with(PARQUET_MAGIC) {
            Self::parquet(name, bytes)
        } else {
            Self::csv(name, io::Cursor::new(bytes))
        }
    }

    /// A file on disk, streamed; Parquet is told from CSV by its first bytes.
    ///
    /// # Errors
    /// The file cannot be opened or read.
    pub fn open(name: impl Into<String>, path: &Path) -> io::Result<Self> {
        let mut file = File::open(path)?;
        let mut magic = Vec::new();
        file.by_ref().take(PARQUET_MAGIC.len() as u64).read_to_end(&mut magic)?;
        file.seek(SeekFrom::Start(0))?;
        let name = name.into();
        Ok(match magic == PARQUET_MAGIC {
            true => Self { name, content: Content::ParquetFile(file) },
            false => Self::csv(name, BufReader::new(file)),
        })
    }
}
