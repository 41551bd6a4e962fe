//! Records of MCAP logs, version 0: schemas, channels, messages, and the chunks that hold them.

use std::io::{self, Read};

use crate::limits::FileLimits;

const MAGIC: &[u8; 8] = b"\x89MCAP0\r\n";
/// Operation codes of the records that are read.
const FOOTER: u8 = 0x02;
const SCHEMA: u8 = 0x03;
const CHANNEL: u8 = 0x04;
const MESSAGE: u8 = 0x05;
const CHUNK: u8 = 0x06;
const DATA_END: u8 = 0x0f;
/// Largest number of bytes of a chunk, packed or unpacked, as a part of what a file may unpack to.
const CHUNK_PART: usize = 4;

/// Record of use for a table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum McapRecord<'a> {
    Schema { id: u16, name: &'a str, encoding: &'a str, text: &'a [u8] },
    Channel { id: u16, schema: u16, topic: &'a str, encoding: &'a str },
    Message { channel: u16, log_time_ns: u64, data: &'a [u8] },
}

fn invalid_data(message: impl Into<String>) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, message.into())
}

/// Passes every record of a log, chunk by chunk, in the order of the file.
///
/// # Errors
/// Returns an error if the file is damaged, a chunk is larger than the limits allow, or a record is
/// not taken.
pub(crate) fn visit_records(
    mut input: impl Read,
    limits: FileLimits,
    take: &mut impl FnMut(McapRecord) -> io::Result<()>,
) -> io::Result<()> {
    let mut magic = [0; 8];
    input.read_exact(&mut magic)?;
    if &magic != MAGIC {
        return Err(invalid_data("it is of a version of MCAP that is not known"));
    }
    let most = limits.unpacked_bytes / CHUNK_PART;
    loop {
        let mut head = [0; 9];
        match input.read_exact(&mut head) {
            Ok(()) => {}
            // A log that was cut off has no footer: what it holds is read.
            Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => return Ok(()),
            Err(error) => return Err(error),
        }
        let (code, length) = (head[0], RecordBytes(&head[1..]).read_number(8)?);
        if matches!(code, FOOTER | DATA_END) {
            return Ok(());
        }
        if length > most as u64 {
            return Err(invalid_data(format!("a record of {length} bytes is larger than is read")));
        }
        let mut content = Vec::new();
        input.by_ref().take(length).read_to_end(&mut content)?;
        match code {
            CHUNK => visit_chunk(&content, most, take)?,
            code => visit_record(code, &content, take)?,
        }
    }
}

fn visit_chunk(
    content: &[u8],
    most: usize,
    take: &mut impl FnMut(McapRecord) -> io::Result<()>,
) -> io::Result<()> {
    let mut bytes = RecordBytes(content);
    // Times of the first and the last message.
    bytes.take_slice(16)?;
    let unpacked = bytes.read_number(8)?;
    bytes.take_slice(4)?;
    let packing = bytes.read_text()?;
    let length = bytes.read_number(8)?;
    let records = bytes.take_slice(length)?;
    if unpacked > most as u64 {
        return Err(invalid_data(format!(
            "a chunk unpacks to {unpacked} bytes, more than is read"
        )));
    }
    let records = unpack_records(packing, records, unpacked)?;
    let mut rest = RecordBytes(&records);
    while !rest.0.is_empty() {
        let code = rest.read_number(1)? as u8;
        let length = rest.read_number(8)?;
        visit_record(code, rest.take_slice(length)?, take)?;
    }
    Ok(())
}

/// Unpacks the records of a chunk, at most as many bytes as it declares.
fn unpack_records(packing: &str, packed: &[u8], unpacked: u64) -> io::Result<Vec<u8>> {
    let mut records = Vec::new();
    match packing {
        "" => return Ok(packed.to_vec()),
        "zstd" => {
            zstd::stream::read::Decoder::new(packed)?.take(unpacked).read_to_end(&mut records)?
        }
        "lz4" => {
            let decoder = lz4_flex::frame::FrameDecoder::new(packed);
            decoder.take(unpacked).read_to_end(&mut records)?
        }
        other => return Err(invalid_data(format!("chunks packed by `{other}` are not read"))),
    };
    Ok(records)
}

fn visit_record(
    code: u8,
    content: &[u8],
    take: &mut impl FnMut(McapRecord) -> io::Result<()>,
) -> io::Result<()> {
    let mut bytes = RecordBytes(content);
    let record = match code {
        SCHEMA => {
            let (id, name, encoding) =
                (bytes.read_number(2)? as u16, bytes.read_text()?, bytes.read_text()?);
            let length = bytes.read_number(4)?;
            McapRecord::Schema { id, name, encoding, text: bytes.take_slice(length)? }
        }
        CHANNEL => McapRecord::Channel {
            id: bytes.read_number(2)? as u16,
            schema: bytes.read_number(2)? as u16,
            topic: bytes.read_text()?,
            encoding: bytes.read_text()?,
        },
        MESSAGE => {
            let channel = bytes.read_number(2)? as u16;
            // Sequence number, time of the log, time of sending.
            bytes.take_slice(4)?;
            let log_time_ns = bytes.read_number(8)?;
            bytes.take_slice(8)?;
            McapRecord::Message { channel, log_time_ns, data: bytes.0 }
        }
        _ => return Ok(()),
    };
    take(record)
}

/// Bytes of a record that are not read yet.
struct RecordBytes<'a>(&'a [u8]);

impl<'a> RecordBytes<'a> {
    fn take_slice(&mut self, length: u64) -> io::Result<&'a [u8]> {
        let length = usize::try_from(length).unwrap_or(usize::MAX);
        let (first, rest) =
            self.0.split_at_checked(length).ok_or_else(|| invalid_data("a record ends early"))?;
        self.0 = rest;
        Ok(first)
    }

    /// Returns a little-endian number of at most eight bytes.
    fn read_number(&mut self, size: u64) -> io::Result<u64> {
        Ok(self
            .take_slice(size)?
            .iter()
            .rev()
            .fold(0, |whole, &byte| (whole << 8) | u64::from(byte)))
    }

    fn read_text(&mut self) -> io::Result<&'a str> {
        let length = self.read_number(4)?;
        std::str::from_utf8(self.take_slice(length)?)
            .map_err(|_| invalid_data("a name is no UTF-8"))
    }
}
