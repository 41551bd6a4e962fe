//! Work of a request in one transaction.

use crate::app::App;
use crate::problem::Result;

/// Carries work out with a handle of the server whose store keeps all that is written, or nothing
/// of it: nothing is kept if the work fails or its caller hangs up.
///
/// # Errors
/// Returns the error of the work or of the commit.
pub(crate) async fn run_in_unit<T, F>(app: &App, work: impl FnOnce(App) -> F) -> Result<T>
where
    F: Future<Output = Result<T>>,
{
    let unit = app.store().begin_unit();
    match work(app.with_store(unit.store())).await {
        Ok(done) => {
            unit.commit(None).await?;
            Ok(done)
        }
        Err(problem) => {
            unit.rollback().await;
            Err(problem)
        }
    }
}
