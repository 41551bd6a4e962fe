//! All estimators, by their names in the settings.

use super::cma_es::CovarianceMatrixAdaptation;
use super::estimator::Estimator;
use super::published::Published;
use super::settings::Method;
use super::trajectory::TrajectoryForm;
use super::weak::WeakForm;

/// The estimator of a method. A new one needs a folder, a name among the methods of the settings,
/// and a line here.
pub(super) fn estimator(method: Method) -> &'static dyn Estimator {
    match method {
        Method::Published => &Published,
        Method::Weak => &WeakForm,
        Method::Trajectory => &TrajectoryForm,
        Method::CmaEs => &CovarianceMatrixAdaptation,
    }
}
