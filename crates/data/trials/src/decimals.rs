//! Numbers with a decimal comma, in files whose separator is not a comma.

use std::borrow::Cow;

use crate::findings::Findings;

/// Decimal marks that a file has used so far, with the row of the first of each.
#[derive(Debug, Default)]
pub(crate) struct DecimalMarks {
    commas: bool,
    comma: Option<usize>,
    point: Option<usize>,
}

impl DecimalMarks {
    pub(crate) fn new(separator: u8) -> Self {
        // Where commas separate cells, they are no decimal marks.
        Self { commas: separator != b',', ..Self::default() }
    }

    /// Returns the cell with a decimal point, where a comma can only be a decimal mark.
    pub(crate) fn with_point<'a>(&mut self, row: usize, cell: &'a [u8]) -> Cow<'a, [u8]> {
        if !self.commas || !is_plain(cell) {
            return Cow::Borrowed(cell);
        }
        if cell.contains(&b'.') {
            self.point.get_or_insert(row);
        }
        match cell.iter().position(|&byte| byte == b',') {
            Some(at) => {
                self.comma.get_or_insert(row);
                let mut cell = cell.to_vec();
                cell[at] = b'.';
                Cow::Owned(cell)
            }
            None => Cow::Borrowed(cell),
        }
    }

    /// Reports that commas were read as decimal marks, or that the file has points, too.
    pub(crate) fn report_marks(&self, findings: &mut Findings) {
        match (self.comma, self.point) {
            (Some(comma), Some(point)) => {
                let message = format!(
                    "row {comma} has a number with a comma, row {point} one with a point; write \
                     all decimals with a point, without thousands separators"
                );
                findings.error(Some(comma.max(point)), None, message);
            }
            (Some(comma), None) => {
                let message = format!("numbers have a decimal comma, from row {comma} on");
                findings.warning(Some(comma), None, message);
            }
            _ => {}
        }
    }
}

/// Returns true for a number with exactly one mark: `1.234,5` is ambiguous and not changed.
fn is_plain(cell: &[u8]) -> bool {
    let cell = cell.trim_ascii();
    let part = |byte: &u8| matches!(byte, b'0'..=b'9' | b'+' | b'-' | b'e' | b'E' | b',' | b'.');
    let marks = cell.iter().filter(|byte| matches!(byte, b',' | b'.')).count();
    marks == 1 && cell.iter().all(part)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::finding_messages;

    #[test]
    fn a_comma_is_a_point_where_it_separates_nothing() {
        let mut decimals = DecimalMarks::new(b';');
        assert_eq!(*decimals.with_point(2, b" -1,5e3"), *b" -1.5e3");
        for cell in [&b"1.234,5"[..], b"1,2,3", b"12:00:03,25", b"12", b""] {
            assert_eq!(*decimals.with_point(3, cell), *cell);
        }
        assert_eq!(*DecimalMarks::new(b',').with_point(2, b"1,5"), *b"1,5");
        let mut findings = Findings::default();
        decimals.report_marks(&mut findings);
        decimals.with_point(9, b"1.5");
        decimals.report_marks(&mut findings);
        let text = finding_messages(findings);
        assert!(text.contains("warning Some(2)") && text.contains("error Some(9)"), "{text}");
    }
}
