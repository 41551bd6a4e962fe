//! What was learned beside a law, as accelerations along a trial that its regressions need not
//! explain.

use std::sync::Arc;

use sistership_identification::refine::RefineError;
use sistership_model::coefficient::Axis;
use sistership_model::trial::Trial;
use sistership_model::{Law, Model};
use sistership_simulation::branch::{LearnedBranch, attached};
use sistership_simulation::recorded::instants_along;
use sistership_simulation::{PlantError, Ship};

/// A learned correction with the law that it stands beside.
#[derive(Debug, Clone)]
pub(super) struct BesideLaw {
    learned: Arc<dyn LearnedBranch>,
    foundation: Arc<Ship>,
}

impl BesideLaw {
    /// Of a model; none where it has no correction.
    ///
    /// # Errors
    /// Its weights are not attached, or its law cannot be simulated.
    pub fn new(model: &Model, law: &Law) -> Result<Option<Self>, PlantError> {
        let Some(learned) = attached(model)? else { return Ok(None) };
        let foundation = Arc::new(Ship::new(&model.foundation(), law)?);
        Ok(Some(Self { learned, foundation }))
    }

    /// What it adds to the accelerations at each sample of a trial, m/s2 (rad/s2).
    ///
    /// # Errors
    /// Names the channel that the trial lacks.
    pub fn along(&self, trial: &Trial) -> Result<AddedAccelerations, RefineError> {
        let instants = instants_along(&self.foundation, trial)
            .map_err(|lacks| RefineError::Channel { trial: lacks.trial, channel: lacks.channel })?;
        Ok(AddedAccelerations(instants.iter().map(|at| self.learned.addition(at)).collect()))
    }
}

/// Accelerations at samples: of u, v, r.
pub(super) struct AddedAccelerations(Vec<[f64; 3]>);

impl AddedAccelerations {
    /// That of an axis at a sample.
    pub fn at(&self, axis: Axis, sample: usize) -> f64 {
        let place = [Axis::X, Axis::Y, Axis::N].iter().position(|known| *known == axis);
        place.map_or(0.0, |place| self.0[sample][place])
    }
}
