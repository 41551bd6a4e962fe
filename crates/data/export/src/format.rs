//! A format: one file each.

use crate::error::ExportError;
use crate::plan::Plan;

/// A format in which a model can be written down.
pub trait Format: std::fmt::Debug + Send + Sync {
    /// Its name on the command line and in requests.
    fn name(&self) -> &'static str;

    /// How the name of its file ends.
    fn extension(&self) -> &'static str;

    /// The file.
    ///
    /// # Errors
    /// Says why the model cannot be written in this format.
    fn write(&self, plan: &Plan) -> Result<Vec<u8>, ExportError>;
}
