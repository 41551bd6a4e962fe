//! `sistership plan`: design of the trials that narrow the bands of the IMO criteria most in a
//! given time.

use std::path::PathBuf;
use std::sync::Arc;

use clap::Args;
use sistership_model::{Effect, Law, Model, Zoo, particulars};
use sistership_trial_design::{
    InstrumentAccuracy, PlanError, PlanRequest, TrialPlan, design_trials,
};

use super::estimate::{estimate_model, with_speed};
use super::plan_text;
use crate::failure::{Failure, combine_results};
use crate::trials::{self, ReadTrial};
use crate::values::positive;
use crate::{output, resolve};

const EXAMPLES: &str = "\
Examples:
  sistership plan --ship my-model.yaml --budget-min 60
  sistership plan --ship my-ship.yaml --json
  sistership plan --ship my-model.yaml --trials since.yaml --apart wind --apart current

SHIP is a refined model, whose posterior gives the present uncertainty, or a ship; a ship without a
model is estimated from its particulars. Durations include the approach to each trial and the time
to return to steady full speed; both are simulated.";

/// Design the trials that reduce the uncertainty of the IMO criteria most within a given time.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct PlanArguments {
    /// The ship or its model: a name in the zoo, a model file, or a vessel file.
    #[arg(long, value_name = "SHIP")]
    ship: String,
    /// Total duration of all trials including their approaches.
    #[arg(long, value_name = "MIN", default_value_t = 60.0, value_parser = positive, allow_negative_numbers = true)]
    budget_min: f64,
    /// An effect that the trials must distinguish from the other effects given here, such as those
    /// that a diagnosis could not distinguish; repeatable.
    #[arg(long, value_name = "EFFECT")]
    apart: Vec<String>,
    /// Trials since the model was fitted: their information counts, and new trials are assumed to
    /// be recorded like them.
    #[arg(long, value_name = "TRIALS", num_args = 1..)]
    trials: Vec<PathBuf>,
    /// Print one JSON document.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
///
/// # Errors
/// Returns an error if the ship, a trial or an effect is refused, or if no trial fits into the
/// time.
pub fn run(zoo: &Zoo, asked: &PlanArguments) -> Result<(), Failure> {
    let ((model, law), read) =
        combine_results(model_or_estimate(zoo, &asked.ship), trials::read_trials(&asked.trials))?;
    trials::remark_other_ship(&read, &model.ship);
    let plan = plan_trials(zoo, asked, (&model, &law), &read)?;
    output::print_result(asked.json, &plan, || plan_text::format_plan(&plan))
}

/// Returns the model with this name; for a ship without a model, an estimate.
fn model_or_estimate(zoo: &Zoo, name: &str) -> Result<(Model, Arc<Law>), Failure> {
    match resolve::resolve_ship(zoo, name) {
        Ok(vessel) if vessel.file.models.is_empty() => {
            let vessel = with_speed(&vessel, None);
            let (estimate, law) = estimate_model(zoo, &vessel, None)?;
            Ok((estimate.model, law))
        }
        _ => resolve::resolve_model(zoo, name),
    }
}

fn plan_trials(
    zoo: &Zoo,
    asked: &PlanArguments,
    (model, law): (&Model, &Law),
    read: &[ReadTrial],
) -> Result<TrialPlan, Failure> {
    let library: Vec<Arc<Effect>> = zoo.effects().cloned().collect();
    let lpp_m = particulars::particular_value(&model.particulars, "lpp_m");
    let request = PlanRequest {
        model,
        law,
        library: &library,
        budget_s: 60.0 * asked.budget_min,
        apart: &asked.apart,
        sailed: &trials::trial_refs(read),
        // Without a length the instruments of a large ship are assumed.
        instruments: InstrumentAccuracy::for_length(lpp_m.unwrap_or(f64::INFINITY)),
    };
    design_trials(&request).map_err(|error| match error {
        PlanError::Budget => Failure::Call(format!("--budget-min: {error}")),
        PlanError::Effect { .. } => Failure::Call(format!("--apart: {error}")),
        error => Failure::Refused(error.to_string()),
    })
}
