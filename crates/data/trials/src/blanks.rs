//! Text whose columns are separated by blanks: every run of blanks becomes one tab.

use std::io::{self, Read};

/// Reader that replaces each run of blanks by a tab, if it is active.
pub(crate) struct TabbedReader<R> {
    inner: R,
    is_active: bool,
    begins: bool,
    pending: bool,
}

impl<R: Read> TabbedReader<R> {
    pub(crate) fn new(inner: R, is_active: bool) -> Self {
        Self { inner, is_active, begins: true, pending: false }
    }

    /// Copies the bytes with blanks replaced; returns the number of bytes written.
    fn squeeze_blanks(&mut self, read: &[u8], out: &mut [u8]) -> usize {
        let mut count = 0;
        for &byte in read {
            match byte {
                // Leading and trailing blanks of a line separate no columns, and are dropped.
                b' ' | b'\t' => self.pending = !self.begins,
                b'\n' | b'\r' => {
                    (self.pending, self.begins) = (false, true);
                    out[count] = byte;
                    count += 1;
                }
                _ => {
                    if self.pending {
                        out[count] = b'\t';
                        count += 1;
                    }
                    (self.pending, self.begins) = (false, false);
                    out[count] = byte;
                    count += 1;
                }
            }
        }
        count
    }
}

impl<R: Read> Read for TabbedReader<R> {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        if !self.is_active || out.len() < 2 {
            return self.inner.read(out);
        }
        // A tab may be pending from the previous call, so that one byte more is written than read.
        let mut taken = vec![0; out.len() - 1];
        loop {
            let read = self.inner.read(&mut taken)?;
            let count = self.squeeze_blanks(&taken[..read], out);
            if count > 0 || read == 0 {
                return Ok(count);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn runs_of_blanks_become_one_tab() {
        let mut text = String::new();
        TabbedReader::new(&b"  1.0   2.0 \r\n\n 3\t 4"[..], true)
            .read_to_string(&mut text)
            .unwrap();
        assert_eq!(text, "1.0\t2.0\r\n\n3\t4");
        let mut bytes = Vec::new();
        let mut small = TabbedReader::new(&b" a  b\n"[..], true);
        let mut two = [0; 2];
        while let count @ 1.. = small.read(&mut two).unwrap() {
            bytes.extend_from_slice(&two[..count]);
        }
        assert_eq!(bytes, b"a\tb\n");
    }
}
