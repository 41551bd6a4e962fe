//! Trait of the export formats; each format has its own file.

use sistership_simulation::equations::CoefficientBinding;

use crate::error::ExportError;
use crate::export_plan::ExportPlan;
use crate::subject::ExportSubject;

/// Format of an exported model.
pub trait ModelFormat: std::fmt::Debug + Send + Sync {
    /// Name on the command line and in requests.
    fn name(&self) -> &'static str;

    /// Extension of the file name.
    fn extension(&self) -> &'static str;

    /// What the format takes by name: coefficients, and where its parameters can be set, everything.
    fn settable_names(&self) -> CoefficientBinding {
        CoefficientBinding::Names
    }

    /// Returns a model's equations as the format writes them.
    ///
    /// # Errors
    /// Returns an error with the reason why the model cannot be exported.
    fn prepare(&self, subject: &ExportSubject<'_>) -> Result<ExportPlan, ExportError> {
        ExportPlan::new(subject, self.settable_names())
    }

    /// Returns the content of the file.
    ///
    /// # Errors
    /// Returns an error with the reason why the model cannot be written in this format.
    fn write(&self, plan: &ExportPlan) -> Result<Vec<u8>, ExportError>;
}
