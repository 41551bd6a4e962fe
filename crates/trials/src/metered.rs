//! A reader that gives up on rows without an end.

use std::cell::Cell;
use std::io::{self, Read};
use std::rc::Rc;

/// Bytes handed out since the last complete row, shared with whoever counts the rows.
#[derive(Debug, Clone, Default)]
pub(crate) struct Meter(Rc<Cell<usize>>);

impl Meter {
    /// A row is complete.
    pub(crate) fn reset(&self) {
        self.0.set(0);
    }
}

/// Passes bytes on until more than the limit (and one read) have gone by without a complete row.
///
/// The limit is on what the CSV parser must hold in memory: a physical line, or a quoted cell whose quote never closes.
pub(crate) struct Metered<R> {
    inner: R,
    meter: Meter,
    limit: usize,
}

impl<R: Read> Metered<R> {
    pub(crate) fn new(inner: R, limit: usize) -> (Self, Meter) {
        let meter = Meter::default();
        (Self { inner, meter: meter.clone(), limit }, meter)
    }
}

impl<R: Read> Read for Metered<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if self.meter.0.get() > self.limit {
            let message = format!("a row is longer than {} bytes; is a quote left open, or is this not a CSV file?", self.limit);
            return Err(io::Error::new(io::ErrorKind::InvalidData, message));
        }
        let read = self.inner.read(buffer)?;
        self.meter.0.set(self.meter.0.get() + read);
        Ok(read)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn an_endless_row_is_given_up_and_finished_rows_are_not() {
        let (mut endless, _) = Metered::new(io::repeat(b'1'), 1000);
        let mut buffer = [0; 300];
        let reads = (0..10).take_while(|_| endless.read(&mut buffer).is_ok()).count();
        assert_eq!(reads, 4);
        let (mut rows, meter) = Metered::new(io::repeat(b'1'), 1000);
        for _ in 0..100 {
            rows.read_exact(&mut buffer).unwrap();
            meter.reset();
        }
    }
}
