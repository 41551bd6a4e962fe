//! Arguments of the command line.

use std::path::PathBuf;

use clap::{Parser, Subcommand};

use crate::commands::{
    backup, completions, family, fsck, gc, health, keys, manual, serve, ships, users, verify, work,
    zoo,
};
use crate::commands::{
    branch, check, compare, derive, diagnose, estimate, export, import, init, manoeuvre, plan,
    predict, refine, similar, simulate, validate,
};
use crate::demo::DemoArguments;

const EXAMPLES: &str = "\
SHIP and MODEL are a name in the zoo (`mariner`, `mariner/abkowitz`) or a YAML file.
TRIALS is a trial manifest (YAML), or a CSV or Parquet file with canonical columns (t_s, x_m, y_m,
psi_rad, u_m_s, v_m_s, r_rad_s, delta_rad, n_rps, ...; other unit suffixes such as _deg, _rpm, _kn
are converted).

Examples:
  sistership init my-ship --category dry-cargo lpp_m=80 beam_m=13 draught_m=5
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

Exit status: 0 success, 1 the data or the model was refused, 2 the command is wrong.";

/// Ship manoeuvring models: find the most similar ship, refine its model against trials, simulate
/// it.
#[derive(Debug, Parser)]
#[command(name = "sistership", version, after_help = EXAMPLES, arg_required_else_help = true)]
pub struct Arguments {
    /// Add laws/*.yaml, effects/*.yaml and vessels/*.yaml of a folder to the zoo; repeatable, and
    /// in addition to the folders in SISTERSHIP_ZOO.
    #[arg(long, value_name = "DIR", global = true)]
    pub zoo: Vec<PathBuf>,
    /// The command.
    #[command(subcommand)]
    pub command: Command,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Rank the ships of the zoo by similarity to a ship.
    Similar(similar::SimilarArguments),
    /// Write the file of a ship with its particulars.
    Init(init::InitArguments),
    /// Check trial files: units, signs, gaps, jumps, time.
    Check(check::CheckArguments),
    /// Identify the columns of trial files and write a manifest that reads them.
    Import(import::ImportArguments),
    /// Refine a source model against a ship's trials.
    Refine(Box<refine::RefineArguments>),
    /// Train a learned correction on the residual accelerations of a model.
    Branch(branch::BranchArguments),
    /// Simulate recorded trials with a model and measure its errors.
    Simulate(simulate::SimulateArguments),
    /// Find the physical effects that a model lacks, from trials that it was not fitted on.
    Diagnose(diagnose::DiagnoseArguments),
    /// Simulate turning circles, zigzags, stops, pull-outs and spirals and compare them with the
    /// IMO criteria.
    Manoeuvre(manoeuvre::ManoeuvreArguments),
    /// Predict the motion over a horizon under future orders, in wind and current, with a
    /// prediction interval.
    Predict(Box<predict::PredictArguments>),
    /// Design the trials that reduce the uncertainty of the IMO criteria most within a given time.
    Plan(plan::PlanArguments),
    /// Compare two to five models: coefficients, errors on the same trials, standard manoeuvres.
    Compare(compare::CompareArguments),
    /// Validate a model against trials of its ship by ITTC 7.5-02-06-03.
    Validate(validate::ValidateArguments),
    /// Derive a law of motion from a list of actuators.
    Derive(derive::DeriveArguments),
    /// Export a model to C, Python, MATLAB, Modelica or FMU, or a ship to another store.
    Export(export::ExportArguments),
    /// Estimate a model of a ship from its particulars alone, with uncertainty bands.
    Estimate(estimate::EstimateArguments),
    /// List the models of the zoo with their validation status, or check a ship before it is added.
    Zoo(zoo::ZooArguments),
    /// Show the whole loop through the real server: ship, trials, source, refinement, champion,
    /// report.
    Demo(DemoArguments),
    /// Run the REST server.
    Serve(serve::ServeArguments),
    /// Run a worker for the jobs that servers have queued.
    Work(work::WorkArguments),
    /// Check that a server of this machine is ready.
    Health(health::HealthArguments),
    /// Find ships of a store by category, tag, particulars, metrics and similarity.
    Ships(Box<ships::ShipsArguments>),
    /// Repeat the recorded recipe of a version and compare the bytes.
    Verify(verify::VerifyArguments),
    /// Manage families of ships: create, learn the prior, refine all members.
    Family(family::FamilyArguments),
    /// Manage the users of a store: add, list, assign roles, disable.
    Users(users::UsersArguments),
    /// Manage the service keys of programs: add, list, revoke.
    Keys(keys::KeysArguments),
    /// Check every hash and every reference of a store.
    Fsck(fsck::FsckArguments),
    /// Remove unreferenced objects.
    Gc(gc::GcArguments),
    /// Back up a store into a folder while servers keep writing.
    Backup(backup::BackupArguments),
    /// Restore a backup into an empty store.
    Restore(backup::RestoreArguments),
    /// Print completions of the command line for a shell.
    Completions(completions::CompletionsArguments),
    /// Write the manual pages of all commands.
    Manual(manual::ManualArguments),
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
                .contains("choose one of `published`, `weak`, `trajectory`, `cma-es`")
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
