//! Trait of the export formats; each format has its own file.

use crate::error::ExportError;
use crate::export_plan::ExportPlan;

/// Format of an exported model.
pub trait ModelFormat: std::fmt::Debug + Send + Sync {
    /// Name on the command line and in requests.
    fn name(&self) -> &'static str;

    /// Extension of the file name.
    fn extension(&self) -> &'static str;

    /// Returns the content of the file.
    ///
    /// # Errors
    /// Returns an error with the reason why the model cannot be written in this format.
    fn write(&self, plan: &ExportPlan) -> Result<Vec<u8>, ExportError>;
}
