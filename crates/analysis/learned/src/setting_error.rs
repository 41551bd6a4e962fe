//! Error type of a setting that is out of range, and the ranges that several trainings share.

/// Error of a setting that is out of range.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{field}: {range}")]
pub struct SettingError {
    /// The setting.
    pub field: &'static str,
    /// The permitted range.
    pub range: &'static str,
}

impl SettingError {
    /// Refuses the setting unless the condition holds.
    pub(crate) fn refuse_unless(
        holds: bool,
        field: &'static str,
        range: &'static str,
    ) -> Result<(), Self> {
        if holds { Ok(()) } else { Err(Self { field, range }) }
    }

    pub(crate) fn check_width(width: usize) -> Result<(), Self> {
        Self::refuse_unless((1..=1024).contains(&width), "width", "should be from 1 to 1024")
    }

    pub(crate) fn check_epochs(epochs: usize) -> Result<(), Self> {
        Self::refuse_unless(epochs <= 100_000, "epochs", "should be from 0 to 100000")
    }

    pub(crate) fn check_batch(batch: usize) -> Result<(), Self> {
        Self::refuse_unless((1..=1 << 16).contains(&batch), "batch", "should be from 1 to 65536")
    }

    pub(crate) fn check_rate(rate: f64) -> Result<(), Self> {
        Self::refuse_unless(rate > 0.0 && rate <= 1.0, "rate", "should be above 0 and at most 1")
    }
}
