//! `sistership family`: families of ships whose models share a foundation. Long work is queued for
//! workers.

use clap::{Args, Subcommand, ValueEnum};
use serde_json::{Value, json};
use sistership_jobs::Archive;
use sistership_jobs::derive::DeriveError;
use sistership_jobs::fleet::{
    BulkProgress, BulkRefinementRequest, OrderError, PriorChoice, Rule, Start, learn_family_prior,
    order_refinement,
};
use sistership_store::StoreError;

use super::store::{StoreArguments, with_archive};
use crate::failure::Failure;
use crate::output::{self, format_count, print_note};
use crate::table::{TextTable, format_number};

const EXAMPLES: &str = "\
Examples:
  sistership family create tankers --foundation kvlcc2/1 --ship tanker-1 --ship tanker-2 --ship tanker-3
  sistership family learn tankers
  sistership family refine tankers --no-worse-than 0.02
  sistership work & sistership work &
  sistership family status 0192f3c4-...";

/// Manage families of ships: create, learn the prior, refine all members.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct FamilyArguments {
    #[command(subcommand)]
    what: FamilyAction,
    #[command(flatten)]
    store: StoreArguments,
    /// Print one JSON document.
    #[arg(long, global = true)]
    json: bool,
}

#[derive(Debug, Subcommand)]
enum FamilyAction {
    /// Create a family on a foundation.
    Create {
        /// Its name.
        family: String,
        /// Version on which its models are based: `SHIP` (its champion) or `SHIP/NUMBER`.
        #[arg(long, value_name = "SHIP[/NUMBER]")]
        foundation: String,
        /// A member; repeatable.
        #[arg(long, value_name = "SHIP")]
        ship: Vec<String>,
    },
    /// Add ships to a family.
    Add {
        /// The family.
        family: String,
        /// The ships.
        #[arg(required = true)]
        ships: Vec<String>,
    },
    /// Estimate mean and covariance of the coefficients over the members and store them as the
    /// prior of the family.
    Learn {
        /// The family.
        family: String,
    },
    /// Queue the refinement of every member from the statistics of its trials.
    Refine {
        /// The family.
        family: String,
        /// Start of each member.
        #[arg(long, value_enum, default_value_t = StartArgument::Champion)]
        start: StartArgument,
        /// Prior of the coefficients.
        #[arg(long, value_enum, default_value_t = PriorArgument::Family)]
        prior: PriorArgument,
        /// Promote a refined model to champion if the held-out error of no axis grows by more than
        /// this share; by default none is promoted.
        #[arg(long, value_name = "SHARE")]
        no_worse_than: Option<f64>,
    },
    /// Show the progress of a refinement.
    Status {
        /// Its id.
        id: String,
    },
    /// Cancel the remaining work of a refinement.
    Cancel {
        /// Its id.
        id: String,
    },
    /// Repeat the failed or cancelled parts of a refinement.
    Retry {
        /// Its id.
        id: String,
    },
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum StartArgument {
    Champion,
    Foundation,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum PriorArgument {
    Family,
    Foundation,
}

/// Runs the command.
///
/// # Errors
/// Returns an error if something that is named does not exist, or if the store refuses it.
pub fn run(family: &FamilyArguments) -> Result<(), Failure> {
    let (document, text) =
        with_archive(&family.store, async |archive| run_action(&family.what, archive).await)?;
    output::print_result(family.json, &document, || text)
}

/// Error of a command on a family.
#[derive(Debug, thiserror::Error)]
enum FamilyError {
    #[error(transparent)]
    Store(#[from] StoreError),
    /// The prior cannot be learned.
    #[error(transparent)]
    Derive(#[from] DeriveError),
    /// The refinement is not queued.
    #[error("{0}")]
    NotQueued(OrderError),
    #[error(transparent)]
    Json(#[from] serde_json::Error),
}

/// Result as a document and as text.
type FamilyResult = Result<(Value, String), FamilyError>;

async fn run_action(what: &FamilyAction, archive: &Archive) -> FamilyResult {
    let families = archive.store.families();
    match what {
        FamilyAction::Create { family, foundation, ship } => {
            // The foundation is resolved to an id, so that a later move of the champion does not
            // change it.
            let version = resolve_version(archive, foundation).await?;
            let family = families.create(family, family, &version).await?.name;
            add_members(archive, &family, ship).await
        }
        FamilyAction::Add { family, ships } => add_members(archive, family, ships).await,
        FamilyAction::Learn { family } => learn_prior(archive, family).await,
        FamilyAction::Refine { family, start, prior, no_worse_than } => {
            let asked = BulkRefinementRequest {
                start: match start {
                    StartArgument::Champion => Start::Champion,
                    StartArgument::Foundation => Start::Foundation,
                },
                prior: match prior {
                    PriorArgument::Family => PriorChoice::Family,
                    PriorArgument::Foundation => PriorChoice::Foundation,
                },
                rule: Rule { no_worse_than: *no_worse_than },
                ..BulkRefinementRequest::default()
            };
            let queued = order_refinement(&archive.store, family, &asked).await;
            refinement_status(archive, &queued.map_err(FamilyError::NotQueued)?.id).await
        }
        FamilyAction::Status { id } => refinement_status(archive, id).await,
        FamilyAction::Cancel { id } => {
            archive.store.bulks().request_cancel(id).await?;
            refinement_status(archive, id).await
        }
        // Ships that are done keep their outcome; only failed or cancelled jobs are queued again.
        FamilyAction::Retry { id } => {
            archive.store.bulks().retry_chunks(id).await?;
            refinement_status(archive, id).await
        }
    }
}

/// Returns the id of the version with this name.
async fn resolve_version(archive: &Archive, name: &str) -> Result<String, FamilyError> {
    let (ship, rest) = name.split_once('/').unwrap_or((name, "champion"));
    // What is no number is an alias; without either it is the champion.
    let number = match rest.parse() {
        Ok(number) => number,
        Err(_) => archive.store.aliases().get(ship, rest).await?.version_number,
    };
    Ok(archive.store.versions().get(ship, number).await?.head.id)
}

async fn add_members(archive: &Archive, family: &str, ships: &[String]) -> FamilyResult {
    // Ships that are members already do not count as new.
    let new = archive.store.families().add_members(family, ships).await?;
    let members = archive.store.families().count_members(family).await?;
    let text = format!(
        "{family}: {new} added, {}",
        format_count(usize::try_from(members).unwrap_or(0), "member")
    );
    Ok((json!({ "family": family, "added": new, "members": members }), text))
}

async fn learn_prior(archive: &Archive, family: &str) -> FamilyResult {
    let told = |fraction: f64, what: &str| {
        print_note(&format!("{:3.0} % {what}", 100.0 * fraction));
        true
    };
    // Estimated in this process; the server queues the same work as a job.
    let prior = learn_family_prior(archive, family, &told).await?;
    let document = serde_json::to_string(&prior)?;
    let kept = archive.store.families().insert_prior(family, &document).await?;
    // One row for each coefficient of each axis.
    let mut table = TextTable::new(["coefficient", "mean", "std. deviation", "share from trials"]);
    for axis in &prior.axes {
        for (j, name) in axis.names.iter().enumerate() {
            table.add_row([
                name.clone(),
                format_number(axis.mean[j]),
                format_number(axis.deviation[j]),
                format!("{:.2}", axis.told_by_trials[j]),
            ]);
        }
    }
    let head = format!(
        "{family}: prior {} of {}; {:.1} samples count as one independent sample; {:.0} % of the \
         correlations kept\n",
        kept.revision,
        format_count(prior.members.len(), "member"),
        prior.design_effect,
        100.0 * prior.correlations_kept
    );
    Ok((
        json!({ "family": family, "revision": kept.revision, "prior": prior }),
        format!("{head}{table}"),
    ))
}

async fn refinement_status(archive: &Archive, id: &str) -> FamilyResult {
    let bulk = archive.store.bulks().get(id).await?;
    let standing = BulkProgress::read_current(&archive.store, &bulk).await?;
    let mut text = format!(
        "{} of {}: {}, {} of {} ships done",
        bulk.id, bulk.family, standing.state, standing.done, bulk.ships
    );
    standing
        .outcomes
        .iter()
        .for_each(|(outcome, ships)| text.push_str(&format!(", {ships} {outcome}")));
    if let Some(pace) = standing.ships_per_s {
        text.push_str(&format!("; {pace:.1} ships/s"));
    }
    if let Some(left) = standing.left_s {
        text.push_str(&format!(", {left:.0} s left"));
    }
    Ok((json!({ "id": bulk.id, "family": bulk.family, "standing": standing }), text))
}
