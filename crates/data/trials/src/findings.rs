//! Collection of findings of checks, with limits on repeated ones.

use sistership_model::trial::Finding;

/// Largest number of errors listed for one file.
const MAX_ERRORS: usize = 20;
/// Largest number of warnings listed for one file.
const MAX_WARNINGS: usize = 100;
/// Largest number of rows listed for the same fault.
const MAX_ROWS: usize = 3;

/// Severity of a finding; an error refuses the trial.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Severity {
    Error,
    Warning,
}

/// Samples with the same fault: the first few with their rows, and the total count.
#[derive(Debug, Default)]
pub(crate) struct FaultySamples {
    first: Vec<(usize, usize)>,
    count: usize,
    /// Row of the last sample.
    last: Option<usize>,
}

impl FaultySamples {
    pub(crate) fn record_sample(&mut self, hit: (usize, usize)) {
        if self.count < MAX_ROWS {
            self.first.push(hit);
        }
        (self.count, self.last) = (self.count + 1, Some(hit.1));
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.count == 0
    }
}

/// Findings on one file.
#[derive(Debug, Clone, Default)]
pub(crate) struct Findings {
    errors: Vec<Finding>,
    warnings: Vec<Finding>,
    more_errors: usize,
    more_warnings: usize,
}

impl Findings {
    pub(crate) fn error(
        &mut self,
        row: Option<usize>,
        column: Option<&str>,
        message: impl Into<String>,
    ) {
        self.push_finding(Severity::Error, row, column, message.into());
    }

    pub(crate) fn warning(
        &mut self,
        row: Option<usize>,
        column: Option<&str>,
        message: impl Into<String>,
    ) {
        self.push_finding(Severity::Warning, row, column, message.into());
    }

    fn push_finding(
        &mut self,
        severity: Severity,
        row: Option<usize>,
        column: Option<&str>,
        message: String,
    ) {
        let (list, more, most) = match severity {
            Severity::Error => (&mut self.errors, &mut self.more_errors, MAX_ERRORS),
            Severity::Warning => (&mut self.warnings, &mut self.more_warnings, MAX_WARNINGS),
        };
        // Beyond the limit findings are only counted.
        if list.len() < most {
            list.push(Finding { row, column: column.map(str::to_owned), message });
        } else {
            *more += 1;
        }
    }

    /// Adds a fault of several rows: the first few one by one, the rest as a count.
    pub(crate) fn report_rows(
        &mut self,
        severity: Severity,
        column: &str,
        hits: &FaultySamples,
        message: impl Fn(usize) -> String,
    ) {
        for &(sample, row) in &hits.first {
            self.push_finding(severity, Some(row), Some(column), message(sample));
        }
        if let (Some(more @ 1..), Some(last)) = (hits.count.checked_sub(MAX_ROWS), hits.last) {
            self.push_finding(
                severity,
                None,
                Some(column),
                format!("the same in {more} further rows, the last of which is row {last}"),
            );
        }
    }

    /// Adds the findings on another file, each with the name of that file.
    pub(crate) fn absorb_file(&mut self, file: &str, other: Self) {
        let (errors, warnings) = other.into_lists();
        let errors = errors.into_iter().map(|finding| (Severity::Error, finding));
        for (severity, finding) in
            errors.chain(warnings.into_iter().map(|finding| (Severity::Warning, finding)))
        {
            // The row is one of the other file, hence its name in the message.
            let Finding { row, column, message } = finding;
            self.push_finding(severity, row, column.as_deref(), format!("{file}: {message}"));
        }
    }

    pub(crate) fn has_errors(&self) -> bool {
        !self.errors.is_empty()
    }

    /// Returns errors and warnings, each with a last line about those that are not listed.
    pub(crate) fn into_lists(mut self) -> (Vec<Finding>, Vec<Finding>) {
        for (list, more, what) in [
            (&mut self.errors, self.more_errors, "errors"),
            (&mut self.warnings, self.more_warnings, "warnings"),
        ] {
            if more > 0 {
                list.push(Finding {
                    row: None,
                    column: None,
                    message: format!("{more} further {what} are not listed"),
                });
            }
        }
        (self.errors, self.warnings)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_faults_are_counted_and_the_list_is_bounded() {
        let mut findings = Findings::default();
        let mut hits = FaultySamples::default();
        (0..10).for_each(|k| hits.record_sample((k, k + 2)));
        findings.report_rows(Severity::Error, "u", &hits, |k| format!("fault {k}"));
        for k in 0..30 {
            findings.error(Some(k), None, "other");
        }
        let (errors, warnings) = findings.into_lists();
        assert_eq!(errors[3].message, "the same in 7 further rows, the last of which is row 11");
        assert_eq!(errors.len(), MAX_ERRORS + 1);
        assert_eq!(errors[MAX_ERRORS].message, "14 further errors are not listed");
        assert!(warnings.is_empty());
    }
}
