//! The pages of a Parquet file's columns, measured by their headers before anything is
//! decompressed.
//!
//! The library allocates what the header of a page declares, and unpacks gzip to any size. Headers
//! are therefore read here first, by Thrift's compact protocol, and gzip is unpacked to its end
//! without keeping the output.

use std::io::{self, Read};

use flate2::read::MultiGzDecoder;
use parquet::basic::Compression;
use parquet::file::metadata::ColumnChunkMetaData;
use parquet::file::reader::ChunkReader;

use crate::containers::parquet_format::{self, FieldFormat, FieldKind};

/// Largest depth of nested structures of a page header; the format has two.
const DEPTH: usize = 4;
/// Largest depth of nested structures of the footer; the format has eight.
const FOOTER_DEPTH: usize = 16;
/// Largest size of a page header with its statistics, bytes.
const HEADER_BYTES: u64 = 64 << 10;

/// Memory needed to read a column, bytes: its dictionary, and a page both as stored and as
/// unpacked.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct PageMemory {
    dictionary: u64,
    page: u64,
}

impl PageMemory {
    /// Returns the sum of both, bytes.
    pub fn total_bytes(self) -> u64 {
        self.dictionary + self.page
    }

    /// Returns the larger dictionary and the larger page of two columns.
    pub fn max_of_each(self, other: Self) -> Self {
        Self { dictionary: self.dictionary.max(other.dictionary), page: self.page.max(other.page) }
    }
}

/// Checks the pages of a column, and returns the memory needed to read it.
///
/// # Errors
/// Returns an error if a page is larger than `most` bytes, or differs from its header.
pub fn measure_pages<R: ChunkReader>(
    input: &R,
    chunk: &ColumnChunkMetaData,
    most: usize,
) -> Result<PageMemory, String> {
    if matches!(chunk.compression(), Compression::LZ4) {
        return Err(
            "is compressed by the old LZ4, whose size is not bounded; write it with zstd, \
            snappy or LZ4_RAW"
                .into(),
        );
    }
    // Pages follow one another without an index: each header gives the place of the next.
    let (mut at, length) = chunk.byte_range();
    let end =
        at.checked_add(length).filter(|end| *end <= input.len()).ok_or("lies outside the file")?;
    let mut held = PageMemory::default();
    while at < end {
        let header = PageHeader::read(input, at)
            .map_err(|error| format!("has a page that cannot be read: {error}"))?;
        let next = at.saturating_add(header.length).saturating_add(header.compressed);
        if next > end {
            return Err("has a page that ends outside of it".into());
        }
        if header.uncompressed.max(header.compressed) > most as u64 {
            let size = header.uncompressed.max(header.compressed);
            return Err(format!(
                "has a page of {size} bytes, more than the limit of {most}; write smaller pages"
            ));
        }
        if matches!(chunk.compression(), Compression::GZIP(_)) {
            header
                .check_unpacked(input, at)
                .map_err(|error| format!("has a page that cannot be unpacked: {error}"))?;
        }
        let one = match header.is_dictionary {
            // The dictionary is stored, unpacked and decoded at the same time.
            true => PageMemory { dictionary: 2 * header.uncompressed + header.compressed, page: 0 },
            false => PageMemory { dictionary: 0, page: header.uncompressed + header.compressed },
        };
        held = held.max_of_each(one);
        at = next;
    }
    Ok(held)
}

/// Checks the footer of a file: `bytes` of Thrift before the last eight bytes. The library trusts
/// the length of each list, and spends seconds on a list of two thousand million declared entries
/// in a file of fifty bytes.
///
/// # Errors
/// Returns an error if the footer holds less than it declares, or is nested too deeply.
pub fn check_footer<R: ChunkReader>(input: &R, bytes: u64) -> io::Result<()> {
    let at = input.len().checked_sub(bytes + 8).ok_or_else(|| invalid_page("it is too short"))?;
    let reader = input.get_read(at).map_err(io::Error::other)?.take(bytes);
    let mut thrift = ThriftReader { reader, format: parquet_format::footer_field, read: 0 };
    thrift.read_struct(FOOTER_DEPTH, &mut |_, _| ())
}

/// Fields of a page header that are used.
#[derive(Debug, Default)]
struct PageHeader {
    is_dictionary: bool,
    uncompressed: u64,
    compressed: u64,
    /// Uncompressed bytes before the compressed data: the levels of data pages of version 2.
    levels: u64,
    /// Size of the header itself, bytes.
    length: u64,
}

impl PageHeader {
    fn read<R: ChunkReader>(input: &R, at: u64) -> io::Result<Self> {
        let reader = input.get_read(at).map_err(io::Error::other)?.take(HEADER_BYTES);
        let mut thrift =
            ThriftReader { reader, format: parquet_format::page_header_field, read: 0 };
        let (mut header, mut wrong) = (Self::default(), false);
        thrift.read_struct(DEPTH, &mut |path: &[i16], value: i64| {
            let mut positive = || {
                wrong = wrong || value < 0;
                u64::try_from(value).unwrap_or(0)
            };
            // Field numbers of `PageHeader`: type, uncompressed and compressed size, and the
            // lengths of both kinds of levels in a data page of version 2.
            match path {
                [1] => header.is_dictionary = value == 2,
                [2] => header.uncompressed = positive(),
                [3] => header.compressed = positive(),
                [8, 5 | 6] => header.levels += positive(),
                _ => {}
            }
        })?;
        header.length = thrift.read;
        if wrong { Err(invalid_page("a size is negative")) } else { Ok(header) }
    }

    /// Unpacks gzip to its end, or up to one byte more than the header declares.
    fn check_unpacked<R: ChunkReader>(&self, input: &R, at: u64) -> io::Result<()> {
        let packed = input.get_read(at + self.length + self.levels).map_err(io::Error::other)?;
        let packed = packed.take(self.compressed.saturating_sub(self.levels));
        let most = self.uncompressed.saturating_sub(self.levels);
        let size = io::copy(&mut MultiGzDecoder::new(packed).take(most + 1), &mut io::sink())?;
        if size > most {
            Err(invalid_page("it is larger than declared in its header"))
        } else {
            Ok(())
        }
    }
}

fn invalid_page(what: &str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, what)
}

/// Reader of Thrift's compact protocol that reports integers only.
struct ThriftReader<R> {
    reader: R,
    format: FieldFormat,
    read: u64,
}

/// Callback with the path of field numbers and the value of an integer.
type IntegerVisitor<'a> = &'a mut dyn FnMut(&[i16], i64);

impl<R: Read> ThriftReader<R> {
    fn read_struct(&mut self, depth: usize, take: IntegerVisitor<'_>) -> io::Result<()> {
        self.read_fields(&mut Vec::new(), depth, take)
    }

    fn read_fields(
        &mut self,
        path: &mut Vec<i16>,
        depth: usize,
        take: IntegerVisitor<'_>,
    ) -> io::Result<()> {
        let deeper = depth.checked_sub(1).ok_or_else(|| invalid_page("it is nested too deeply"))?;
        let mut id = 0_i16;
        loop {
            let byte = self.read_byte()?;
            if byte == 0 {
                return Ok(());
            }
            // The upper half of the byte is the increment of the field number, or 0 if the number
            // follows.
            id = match byte >> 4 {
                0 => i16::try_from(self.read_integer()?)
                    .map_err(|_| invalid_page("a field has no number"))?,
                delta => id
                    .checked_add(i16::from(delta))
                    .ok_or_else(|| invalid_page("a field has no number"))?,
            };
            path.push(id);
            self.read_value(byte & 15, path, deeper, take)?;
            path.pop();
        }
    }

    /// Reads the value of a field, which must be of the kind that the format defines.
    fn read_value(
        &mut self,
        kind: u8,
        path: &mut Vec<i16>,
        depth: usize,
        take: IntegerVisitor<'_>,
    ) -> io::Result<()> {
        let expected = (self.format)(path);
        if expected.is_some_and(|expected| !expected.is_kind(kind)) {
            return Err(invalid_page("a field has a wrong type"));
        }
        match kind {
            9 => self.read_list(path, depth, expected, take),
            _ => self.read_entry(kind, path, depth, take),
        }
    }

    fn read_entry(
        &mut self,
        kind: u8,
        path: &mut Vec<i16>,
        depth: usize,
        take: IntegerVisitor<'_>,
    ) -> io::Result<()> {
        match kind {
            // The kind itself is the truth value.
            1 | 2 => Ok(()),
            3 => self.read_byte().map(drop),
            4..=6 => {
                let value = self.read_integer()?;
                take(path, value);
                Ok(())
            }
            7 => self.skip_bytes(8),
            8 => {
                let length = self.read_varint()?;
                self.skip_bytes(length)
            }
            9 | 10 => self.read_list(path, depth, None, take),
            12 => self.read_fields(path, depth, take),
            _ => Err(invalid_page("it has an unknown element")),
        }
    }

    /// Reads a list. Each entry takes at least one byte, so that a false count ends at the end of
    /// the file. Lists of truth values are refused: neither a footer nor a page header has one, and
    /// the library skips them without reading a byte, whatever count they declare.
    fn read_list(
        &mut self,
        path: &mut Vec<i16>,
        depth: usize,
        expected: Option<FieldKind>,
        take: IntegerVisitor<'_>,
    ) -> io::Result<()> {
        let deeper = depth.checked_sub(1).ok_or_else(|| invalid_page("it is nested too deeply"))?;
        let head = self.read_byte()?;
        // The upper half of the byte is the count, or 15 if a longer count follows.
        let (entries, count) = (head & 15, u64::from(head >> 4));
        let count = if count == 15 { self.read_varint()? } else { count };
        if count > 0 && expected.is_some_and(|expected| !expected.holds_entries(entries)) {
            return Err(invalid_page("a list has a wrong type"));
        }
        for _ in 0..count {
            match entries {
                1 | 2 => return Err(invalid_page("it has an unknown element")),
                kind => self.read_entry(kind, path, deeper, take)?,
            }
        }
        Ok(())
    }

    fn read_byte(&mut self) -> io::Result<u8> {
        let mut byte = [0];
        self.reader.read_exact(&mut byte)?;
        self.read += 1;
        Ok(byte[0])
    }

    fn read_varint(&mut self) -> io::Result<u64> {
        let mut value = 0_u64;
        for shift in (0..64).step_by(7) {
            let byte = self.read_byte()?;
            value |= u64::from(byte & 127) << shift;
            if byte < 128 {
                return Ok(value);
            }
        }
        Err(invalid_page("a number does not end"))
    }

    /// Reads a zigzag-encoded integer.
    fn read_integer(&mut self) -> io::Result<i64> {
        let value = self.read_varint()?;
        Ok((value >> 1) as i64 ^ -((value & 1) as i64))
    }

    fn skip_bytes(&mut self, bytes: u64) -> io::Result<()> {
        let skipped = io::copy(&mut self.reader.by_ref().take(bytes), &mut io::sink())?;
        self.read += skipped;
        if skipped == bytes { Ok(()) } else { Err(io::ErrorKind::UnexpectedEof.into()) }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use bytes::Bytes;

    use super::*;

    #[test]
    fn what_is_no_page_header_ends_in_an_error() {
        let read = |bytes: &'static [u8]| {
            PageHeader::read(&Bytes::from_static(bytes), 0).map(|header| header.length)
        };
        assert!(read(b"").is_err() && read(&[0x15]).is_err() && read(&[0x15, 0xff, 0xff]).is_err());
        // Structures within structures without an end, a list, a binary longer than there is.
        assert!(
            read(&[0x1c; 4096]).is_err()
                && read(&[0x19, 0xff]).is_err()
                && read(&[0x18, 0xff, 0x7f]).is_err()
        );
        // A negative size.
        assert!(read(&[0x15, 0, 0x15, 0x01, 0]).is_err());
        assert_eq!(read(&[0x15, 0, 0x15, 2, 0x15, 2, 0]).unwrap(), 7);
    }
}
