//! Reader that refuses rows without an end, and normalises line ends.

use std::cell::Cell;
use std::io::{self, Read};
use std::rc::Rc;

/// Number of bytes returned since the last complete row, shared with the reader of rows.
#[derive(Debug, Clone, Default)]
pub(crate) struct RowMeter(Rc<Cell<usize>>);

impl RowMeter {
    /// Marks the end of a row.
    pub(crate) fn end_row(&self) {
        self.0.set(0);
    }
}

/// Reader that returns an error once more than the limit (and one read) is returned without a
/// complete row.
///
/// The limit bounds the memory of the CSV parser: a physical line, or a quoted cell whose quote
/// never closes. Every line end (`\r\n`, `\r`, `\n`, also mixed) is returned as `\n`, and the last
/// line has one, so that the lines of the parser are those that an editor shows.
pub(crate) struct MeteredReader<R> {
    inner: R,
    meter: RowMeter,
    limit: usize,
    last: u8,
}

impl<R: Read> MeteredReader<R> {
    pub(crate) fn new(inner: R, limit: usize) -> (Self, RowMeter) {
        let meter = RowMeter::default();
        (Self { inner, meter: meter.clone(), limit, last: b'\n' }, meter)
    }

    /// Replaces every line end in the buffer by `\n`; returns the number of bytes that remain.
    fn normalise_line_ends(&mut self, bytes: &mut [u8]) -> usize {
        // `\r\n` may be split between two reads: the last byte is remembered.
        let last = bytes.last().copied().unwrap_or(self.last);
        let before = std::mem::replace(&mut self.last, last);
        if before != b'\r' && !bytes.contains(&b'\r') {
            return bytes.len();
        }
        let (mut kept, mut previous) = (0, before);
        for k in 0..bytes.len() {
            let byte = bytes[k];
            if !(byte == b'\n' && previous == b'\r') {
                bytes[kept] = if byte == b'\r' { b'\n' } else { byte };
                kept += 1;
            }
            previous = byte;
        }
        kept
    }
}

impl<R: Read> Read for MeteredReader<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        loop {
            if self.meter.0.get() > self.limit {
                let message = format!(
                    "a row is longer than {} bytes; check for an unclosed quote, and that this is \
                     a CSV file",
                    self.limit
                );
                return Err(io::Error::new(io::ErrorKind::InvalidData, message));
            }
            let read = self.inner.read(buffer)?;
            self.meter.0.set(self.meter.0.get() + read);
            if read == 0 && !matches!(self.last, b'\n' | b'\r') && !buffer.is_empty() {
                // End of file after a line without an end: supply the end once.
                (buffer[0], self.last) = (b'\n', b'\n');
                return Ok(1);
            }
            let kept = self.normalise_line_ends(&mut buffer[..read]);
            if kept > 0 || read == 0 {
                return Ok(kept);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn an_endless_row_is_given_up_and_finished_rows_are_not() {
        let (mut endless, _) = MeteredReader::new(io::repeat(b'1'), 1000);
        let mut buffer = [0; 300];
        let reads = (0..10).take_while(|_| endless.read(&mut buffer).is_ok()).count();
        assert_eq!(reads, 4);
        let (mut rows, meter) = MeteredReader::new(io::repeat(b'1'), 1000);
        for _ in 0..100 {
            rows.read_exact(&mut buffer).unwrap();
            meter.end_row();
        }
    }

    #[test]
    fn every_line_end_becomes_one() {
        for (text, wanted) in
            [("a\r\nb\rc\nd", "a\nb\nc\nd\n"), ("\r\r\n\r", "\n\n\n"), ("", ""), ("a\n\n", "a\n\n")]
        {
            for size in 1..5 {
                let mut out = Vec::new();
                let (mut reader, _) = MeteredReader::new(text.as_bytes(), 1000);
                let mut buffer = vec![0; size];
                while let Ok(read @ 1..) = reader.read(&mut buffer) {
                    out.extend_from_slice(&buffer[..read]);
                }
                assert_eq!(String::from_utf8(out).unwrap(), wanted, "{text:?} by {size}");
            }
        }
    }
}
