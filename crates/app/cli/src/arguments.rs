//! What may be written on the command line.

use std::path::PathBuf;

use clap::{Parser, Subcommand};

use crate::commands::{backup, family, fsck, gc, keys, serve, ships, users, verify, work, zoo};
use crate::commands::{
    branch, check, compare, derive, diagnose, estimate, export, import, manoeuvre, plan, predict,
    refine, similar, simulate, validate,
};
use crate::demo::DemoArguments;

const EXAMPLES: &str = "\
SHIP and MODEL are a name in the zoo (`mariner`, `mariner/abkowitz`) or a YAML file.
TRIALS is a trial manifest (YAML), or a CSV or Parquet file with canonical columns (t_s, x_m, y_m,
psi_rad, u_m_s, v_m_s, r_rad_s, delta_rad, n_rps, ...; other unit suffixes such as _deg, _rpm, _kn
are converted).

Examples:
  sistership import log/*.csv --ship my-ship
  sistership similar kvlcc2
  sistership check trials.yaml
  sistership refine --ship my-ship.yaml --trials trials.yaml --out my-model.yaml
  sistership simulate --model my-model.yaml --trials trials.yaml
  sistership branch --model my-model.yaml --trials trials.yaml --out with-branch.yaml
  sistership diagnose --model my-model.yaml --trials new-trials.yaml --report diagnosis.html
  sistership manoeuvre --model my-model.yaml --all
  sistership plan --ship my-model.yaml --budget-min 60
  sistership export my-model.yaml --format c --out my_model.c
  sistership estimate --ship my-ship.yaml
  sistership zoo add my-ship.yaml

Exit status: 0 done, 1 the data or the model says no, 2 the call is wrong.";

/// Ship manoeuvring models: find the most similar ship, refine its model against trials, sail it.
#[derive(Debug, Parser)]
#[command(name = "sistership", version, after_help = EXAMPLES, arg_required_else_help = true)]
pub struct Arguments {
    /// Add laws/*.yaml, effects/*.yaml and vessels/*.yaml of a folder to the zoo; repeatable.
    /// SISTERSHIP_ZOO holds further ones.
    #[arg(long, value_name = "DIR", global = true)]
    pub zoo: Vec<PathBuf>,
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Rank the ships of the zoo by similarity to a ship.
    Similar(similar::SimilarArguments),
    /// Check trial files: units, signs, gaps, jumps, time.
    Check(check::CheckArguments),
    /// Look at trial files and write a manifest that reads them.
    Import(import::ImportArguments),
    /// Refine a source model against a ship's trials.
    Refine(Box<refine::RefineArguments>),
    /// Train a learned branch beside a model, on what it leaves of trials.
    Branch(branch::BranchArguments),
    /// Simulate recorded trials with a model and measure its errors.
    Simulate(simulate::SimulateArguments),
    /// Find what a model lacks, by trials that it has not seen.
    Diagnose(diagnose::DiagnoseArguments),
    /// Sail turning circles, zigzags, stops, pull-outs and spirals with a model and judge them by
    /// the IMO criteria.
    Manoeuvre(manoeuvre::ManoeuvreArguments),
    /// Sail a model over a horizon under orders to come, in wind and current, with a band.
    Predict(Box<predict::PredictArguments>),
    /// Plan the trials that narrow the bands of the IMO criteria most in a given time.
    Plan(plan::PlanArguments),
    /// Compare two to five models: coefficients, errors on the same trials, standard manoeuvres.
    Compare(compare::CompareArguments),
    /// Validate a model by its ship's trials: comparison error, validation uncertainty, verdict.
    Validate(validate::ValidateArguments),
    /// Derive a law of motion from a list of actuators.
    Derive(derive::DeriveArguments),
    /// Write a model down for another tool: C, Python, MATLAB, FMU; or a ship for another store.
    Export(export::ExportArguments),
    /// Estimate a model of a ship from its particulars alone, with bands.
    Estimate(estimate::EstimateArguments),
    /// What the models of the zoo are worth; check a ship that is to join it.
    Zoo(zoo::ZooArguments),
    /// Show the whole loop through the real server: ship, trials, source, refinement, champion,
    /// report.
    Demo(DemoArguments),
    /// Run the REST server.
    Serve(serve::ServeArguments),
    /// Work on the jobs that servers queue, without serving.
    Work(work::WorkArguments),
    /// Find ships of a store by category, tag, particulars, metrics and similarity.
    Ships(Box<ships::ShipsArguments>),
    /// Derive a version again from its recipe and compare the bytes.
    Verify(verify::VerifyArguments),
    /// Families of ships: make one, learn from it, refine all of it.
    Family(family::FamilyArguments),
    /// Users of the servers on a store: add, list, give roles, disable.
    Users(users::UsersArguments),
    /// Service keys of programs: add, list, revoke.
    Keys(keys::KeysArguments),
    /// Check every hash and every reference of a store.
    Fsck(fsck::FsckArguments),
    /// Remove objects that nothing refers to.
    Gc(gc::GcArguments),
    /// Copy a store, while it is written, into a folder.
    Backup(backup::BackupArguments),
    /// Make a store of a backup, in an empty place.
    Restore(backup::RestoreArguments),
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn other_methods_and_mixed_manoeuvres_are_calls_that_are_wrong() {
        let refused = |line: &str| {
            Arguments::try_parse_from(line.split(' '))
                .err()
                .map(|e| e.to_string())
                .unwrap_or_default()
        };
        assert!(
            refused("sistership refine --ship a --trials t --method lasso")
                .contains("there are `published`, `weak`, `trajectory`, `cma-es`")
        );
        assert!(
            refused("sistership manoeuvre --model a --turn 35 --zigzag 10/10")
                .contains("cannot be used with")
        );
        assert!(refused("sistership diagnose --model a").contains("--trials"));
        assert!(refused("sistership diagnose --model a --trials t --slack -1").contains("above 0"));
        assert_eq!(refused("sistership manoeuvre --model a --turn -35 --turn 35"), "");
        assert_eq!(refused("sistership manoeuvre --model a --zigzag -10/10"), "");
    }
}
