//! All estimators, by their names in the settings.

use super::cma_es::CovarianceMatrixAdaptation;
use super::estimator::Estimator;
use super::published::PublishedEstimator;
use super::settings::EstimationMethod;
use super::trajectory::TrajectoryForm;
use super::weak::WeakForm;

/// The estimator of a method. A new one needs a folder, a name among the methods of the settings,
/// and a line here.
pub(super) fn estimator_for(method: EstimationMethod) -> &'static dyn Estimator {
    match method {
        EstimationMethod::Published => &PublishedEstimator,
        EstimationMethod::Weak => &WeakForm,
        EstimationMethod::Trajectory => &TrajectoryForm,
        EstimationMethod::CmaEs => &CovarianceMatrixAdaptation,
    }
}
