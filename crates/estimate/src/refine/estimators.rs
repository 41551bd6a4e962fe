//! Every estimator, by its name in the settings.

use super::cma_es::CovarianceMatrixAdaptation;
use super::estimator::Estimator;
use super::published::Published;
use super::settings::Method;
use super::trajectory::TrajectoryForm;
use super::weak::WeakForm;

impl Method {
    /// The estimator of that name.
    pub(super) fn estimator(self) -> &'static dyn Estimator {
        match self {
            Self::Published => &Published,
            Self::Weak => &WeakForm,
            Self::Trajectory => &TrajectoryForm,
            Self::CmaEs => &CovarianceMatrixAdaptation,
        }
    }
}
