//! Accelerations of a learned correction along a trial, which the regressions of the law need not
//! explain.

use std::sync::Arc;

use sistership_identification::refine::RefineError;
use sistership_model::coefficient::Axis;
use sistership_model::trial::Trial;
use sistership_model::{Law, Model};
use sistership_simulation::branch::{CorrectionModel, attached_correction};
use sistership_simulation::recorded::instants_along;
use sistership_simulation::{PlantError, Ship};

/// Learned correction with the foundation that it is added to.
#[derive(Debug, Clone)]
pub(super) struct CorrectedLaw {
    learned: Arc<dyn CorrectionModel>,
    foundation: Arc<Ship>,
}

impl CorrectedLaw {
    /// Creates it from a model; `None` if the model has no correction.
    ///
    /// # Errors
    /// Returns an error if the weights are not attached, or the law cannot be simulated.
    pub fn new(model: &Model, law: &Law) -> Result<Option<Self>, PlantError> {
        let Some(learned) = attached_correction(model)? else { return Ok(None) };
        let foundation = Arc::new(Ship::new(&model.without_correction(), law)?);
        Ok(Some(Self { learned, foundation }))
    }

    /// Accelerations that the correction adds at each sample of a trial, m/s2 (rad/s2).
    ///
    /// # Errors
    /// Returns an error that names the missing channel or input.
    pub fn additions_along(&self, trial: &Trial) -> Result<AddedAccelerations, RefineError> {
        let instants = instants_along(&self.foundation, trial)?;
        Ok(AddedAccelerations(instants.iter().map(|at| self.learned.rate_additions(at)).collect()))
    }
}

/// Accelerations of u, v, r at each sample.
pub(super) struct AddedAccelerations(Vec<[f64; 3]>);

impl AddedAccelerations {
    /// Acceleration of an axis at a sample; zero for an axis without correction.
    pub fn value_at(&self, axis: Axis, sample: usize) -> f64 {
        let place = [Axis::X, Axis::Y, Axis::N].iter().position(|known| *known == axis);
        // Corrections have no roll.
        place.map_or(0.0, |place| self.0[sample][place])
    }
}
