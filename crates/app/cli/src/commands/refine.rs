//! `sistership refine`: refinement of a source model against a ship's trials.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::{Args, ValueEnum};
use serde::Serialize;
use sistership_identification::refine::{
    Constraints, EstimationMethod, Prior, Refinement, RefinementSettings, RefinementSpec,
    StraightLine, refine,
};
use sistership_jobs::derive::with_uncertainty;
use sistership_model::estimated_particulars::{EstimatedParticular, estimated_particulars};
use sistership_model::{Law, Model, Vessel, Zoo};
use sistership_model_selection::{Preference, SelectionReport, similar_population};
use sistership_priors::similarity::RankedSource;
use sistership_priors::source::{SimilarityRanking, best_source, rank_similar};
use sistership_priors::transfer::{blank_model, trial_approach};
use sistership_report::{RefinementInput, render_refinement};

use super::refine_branch::RefinementCorrection;
use super::refine_search::{SelectedStart, select_start};
use super::refine_settings::{resolve_held_out, settings_file};
use super::refine_text;
use super::written_files::{WrittenFiles, check_outputs, model_file, output_file};
use crate::failure::{Failure, combine_results};
use crate::output::{self, format_count, print_note};
use crate::resolve;
use crate::trials::{self, ReadTrial};
use crate::values::{method, positive, preference, prior};
use crate::weights;

const EXAMPLES: &str = "\
Examples:
  sistership refine --ship esso-osaka-3m --trials trials.yaml --out refined.yaml
  sistership refine --ship my-ship.yaml --source mariner --trials a.csv b.csv c.csv --json
  sistership refine --ship my-ship.yaml --source kvlcc2 --law low-speed --trials trials.yaml --method weak
  sistership refine --ship my-ship.yaml --source old-model.yaml --trials trials.yaml --held-out zigzag/last.csv

Without --source, --law and --method, the model is selected by cross-validation. A candidate is a
source model (or the estimate from particulars, a population of published ships, or no source) with
a law of motion and an estimator. Each candidate is fitted with whole manoeuvres held out and
simulated on those; the one with the least error is selected. Among statistically tied candidates,
the one whose predictions vary least outside the trials is preferred, and a physical model of few
coefficients before one that varies far more there. The selection report lists all candidates. With
enough trials, learned corrections are compared as well; the weights of a correction are written
next to the model (m.weights.json for m.yaml).

With --source, --law or --method, there is no selection: the coefficients of the source are the mean
of a Gaussian (l2) prior whose strength is chosen by the error on held-out manoeuvres. Give several
manoeuvres of different kinds.";

/// Refine a source model against a ship's trials.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct RefineArguments {
    /// The ship: a name in the zoo or a vessel file.
    #[arg(long)]
    ship: String,
    /// Source model: a name in the zoo, a model file, or `auto` (the default). Alone, `auto`
    /// compares all eligible sources and laws; with --law, --method, --settings or --constrain it
    /// is the most similar eligible ship of the zoo.
    #[arg(long, value_name = "MODEL|auto")]
    source: Option<String>,
    /// Law of motion to fit, such as `low-speed`. With a source model of another law, the
    /// accelerations of the source become the prior; without --source there is no prior.
    #[arg(long, value_name = "LAW")]
    law: Option<String>,
    /// Trial manifests, CSV or Parquet files.
    #[arg(long, value_name = "TRIALS", num_args = 1.., required = true)]
    trials: Vec<PathBuf>,
    /// Estimator: `published` (one-step differences), `weak` (equations integrated over windows),
    /// `trajectory` (least squares on simulated segments) or `cma-es` (evolutionary search on
    /// simulated segments, slow).
    #[arg(long, value_name = "NAME", value_parser = method)]
    method: Option<EstimationMethod>,
    /// Prior of the coefficients: `source` (the default), `mixture` (between the source and the
    /// estimate from particulars) or `population` (published models of other ships).
    #[arg(long, value_name = "NAME", value_parser = prior)]
    prior: Option<Prior>,
    /// Preference of the model selection: `defensible` (the default; a model of few physical
    /// parameters where it is no worse) or `accurate` (the model that the errors select).
    #[arg(long, value_name = "NAME", value_parser = preference, default_value = "defensible")]
    prefer: Preference,
    /// Settings of the refinement (YAML); flags override them.
    #[arg(long, value_name = "FILE.yaml")]
    settings: Option<PathBuf>,
    /// Trials that are used neither for fitting nor for model selection, but only for the reported
    /// errors.
    #[arg(long, value_name = "NAME", num_args = 1..)]
    held_out: Vec<String>,
    /// Interval at which simulations of held-out manoeuvres restart from the measured state; the
    /// default is ten ship lengths at approach speed, five in model selection.
    #[arg(long, value_name = "SECONDS", value_parser = positive, allow_negative_numbers = true)]
    restart_s: Option<f64>,
    /// Interval of finite differences of velocities; the default is the time to travel a tenth of a
    /// ship length.
    #[arg(long, value_name = "SECONDS", value_parser = positive, allow_negative_numbers = true)]
    difference_s: Option<f64>,
    /// Constraints on the refined model; bounds of single coefficients are given in the settings.
    #[arg(long, value_name = "WHAT", value_enum, num_args = 1..)]
    constrain: Vec<ConstraintFlag>,
    /// Largest distance of a coefficient from the source, in standard deviations of the prior.
    #[arg(long, value_name = "SD", value_parser = positive, allow_negative_numbers = true)]
    trust_sd: Option<f64>,
    /// Write the refined model.
    #[arg(long, value_name = "MODEL.yaml")]
    out: Option<PathBuf>,
    /// Write a report with plots.
    #[arg(long, value_name = "FILE.html")]
    report: Option<PathBuf>,
    /// Print one JSON document.
    #[arg(long)]
    json: bool,
}

/// Constraints that need no number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
#[value(rename_all = "snake_case")]
enum ConstraintFlag {
    /// Damping in sway and yaw, and a rudder that turns the ship to its own side.
    PhysicalSigns,
    /// Resistance opposes surge.
    Dissipative,
    /// Straight-line stable with the rudder amidships.
    Stable,
    /// Straight-line unstable with the rudder amidships.
    Unstable,
}

impl ConstraintFlag {
    fn add_to(self, constraints: &mut Constraints) {
        match self {
            Self::PhysicalSigns => constraints.physical_signs = true,
            Self::Dissipative => constraints.dissipative = true,
            Self::Stable => constraints.straight_line = Some(StraightLine::Stable),
            Self::Unstable => constraints.straight_line = Some(StraightLine::Unstable),
        }
    }
}

#[derive(Serialize)]
struct RefineDocument<'a> {
    #[serde(flatten)]
    refinement: &'a Refinement,
    estimated_particulars: Vec<EstimatedParticular>,
    #[serde(skip_serializing_if = "Option::is_none")]
    ranking: Option<&'a [RankedSource]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    ladder: Option<&'a SelectionReport>,
    #[serde(flatten)]
    files: WrittenFiles<'a>,
    /// Weights of the model's learned correction, if it has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    weights: Option<&'a Path>,
}

/// Runs the command.
///
/// # Errors
/// Returns an error if the ship, the source, a trial or the refinement is refused, or if a file
/// cannot be written.
pub fn run(zoo: &Zoo, arguments: &RefineArguments) -> Result<(), Failure> {
    // Everything that may be refused by the call alone is collected in `all` before any work.
    let named = arguments.source.as_deref().filter(|source| *source != "auto");
    let given = named.map(|source| resolve::resolve_foundation(zoo, source)).transpose();
    let law = arguments.law.as_deref().map(|name| find_law(zoo, name)).transpose();
    let inputs = named_files(arguments);
    let beside = arguments.out.as_deref().map(weights::weights_path);
    // Output files are checked before the work, and all faults of the call are reported together.
    let files = combine_results(
        combine_results(
            output_file(arguments.out.as_deref(), &inputs),
            output_file(beside.as_deref(), &inputs),
        ),
        output_file(arguments.report.as_deref(), &inputs),
    );
    let target = combine_results(
        resolve::resolve_ship(zoo, &arguments.ship),
        refinement_settings(arguments),
    );
    let read = combine_results(files, trials::read_trials(&arguments.trials));
    let all = combine_results(combine_results(target, combine_results(given, law)), read)?;
    let (((target, mut settings), (given, law)), (((out, weights), report), read)) = all;
    let given = given.map(|(model, _)| model);
    trials::remark_other_ship(&read, target.name());
    print_note(&format!("{}: {} read", target.name(), format_count(read.len(), "trial")));
    let files = WrittenFiles { out: arguments.out.as_deref(), report: arguments.report.as_deref() };
    check_outputs(&files, &read)?;
    settings.held_out = resolve_held_out(&settings.held_out, &read)?;
    let started = refinement_start(zoo, arguments, (given, law), &target, &mut settings, &read)?;
    let SelectedStart { source, law, similarity, ladder, made } = started;
    let source_law = resolve::law_of(zoo, &source)?;
    // Without a named law the coefficients of the source are refined in its own law.
    let law = law.unwrap_or_else(|| source_law.clone());
    let laws = (&*source_law, &*law);
    let refinement = match made {
        Some(made) => made,
        // A model selection has refined its best candidate already.
        None => run_refinement(zoo, (&target, &source), laws, &settings, &read)?,
    };
    let refinement = calibrate_uncertainty(zoo, refinement, &law, &read);
    // After the calibration: the correction is trained on residuals of the final coefficients.
    let branch = RefinementCorrection::new((zoo, &law), &refinement, ladder.as_ref(), &read)?;
    if let Some(out) = out {
        let model = branch.as_ref().map_or(&refinement.model, |branch| &branch.model);
        // Weights first, so that a model that exists has its weights.
        branch.iter().zip(weights).try_for_each(|(branch, file)| branch.write_weights(file))?;
        let how = format!("method {}", refinement.method);
        out.write(model_file(zoo, model, &how)?.as_bytes())?;
    }
    if let Some(report) = report {
        // The report shows the ranking and the selection only if there were any.
        let chosen = (similarity.as_ref(), ladder.as_ref());
        report.write(&report_html(zoo, &target, &refinement, chosen, &read)?)?;
    }
    let ranking = similarity.as_ref().map(|similarity| similarity.ranking.as_slice());
    let weights = beside.as_deref().filter(|_| branch.is_some());
    let ladder = ladder.as_ref();
    let document = RefineDocument {
        refinement: &refinement,
        estimated_particulars: estimated_particulars(&refinement.model.particulars),
        ranking,
        ladder,
        files,
        weights,
    };
    output::print_result(arguments.json, &document, || {
        let tried = ladder.map_or(String::new(), refine_text::format_selection_report);
        let text =
            refine_text::format_refinement(&refinement, &source, similarity.as_ref(), &files);
        let branch = weights.map_or(String::new(), refine_text::format_weights_file);
        refine_text::wide_band_warning(&refinement) + &tried + &text + &branch
    })
}

/// Returns the start of the refinement; if nothing is named, the model selection also sets the
/// settings.
fn refinement_start(
    zoo: &Zoo,
    arguments: &RefineArguments,
    (given, law): (Option<Model>, Option<Arc<Law>>),
    target: &Vessel,
    settings: &mut RefinementSettings,
    read: &[ReadTrial],
) -> Result<SelectedStart, Failure> {
    match (given, law) {
        (Some(source), law) => Ok(SelectedStart::from_named(source, law)),
        // A default call: sources, laws and estimators are compared.
        (None, None) if is_plain(arguments, settings) => {
            let (start, explicit) = select_start(zoo, target, (settings, arguments.prefer), read)?;
            *settings = explicit;
            Ok(start)
        }
        // A law alone is identified from the trials, without a prior.
        (None, Some(law)) if arguments.source.is_none() => {
            Ok(SelectedStart::from_named(blank_target(&law, target, settings, read)?, Some(law)))
        }
        (None, law) => {
            let (source, similarity) = choose_source(zoo, target, settings, read)?;
            Ok(SelectedStart {
                similarity: Some(similarity),
                ..SelectedStart::from_named(source, law)
            })
        }
    }
}

/// True if neither source, law, method nor another prior is named, and no setting that only some
/// methods support.
fn is_plain(arguments: &RefineArguments, settings: &RefinementSettings) -> bool {
    // `--source auto` alone is the same as no source.
    let unnamed = arguments.source.as_deref().is_none_or(|source| source == "auto");
    unnamed
        && arguments.method.is_none()
        && arguments.settings.is_none()
        && settings.prior == Prior::Source
        && settings.constraints.is_empty()
}

fn report_html(
    zoo: &Zoo,
    vessel: &Vessel,
    refinement: &Refinement,
    (similarity, ladder): (Option<&SimilarityRanking>, Option<&SelectionReport>),
    read: &[ReadTrial],
) -> Result<Vec<u8>, Failure> {
    let law = resolve::law_of(zoo, &refinement.model)?;
    let trials = trials::trial_refs(read);
    let input = RefinementInput {
        refinement,
        law: &law,
        vessel,
        trials: &trials,
        similarity,
        ladder,
        version: None,
    };
    let rendered = render_refinement(&input)
        .map_err(|error| Failure::Refused(format!("the report cannot be written: {error}")))?;
    Ok(rendered.html.into_bytes())
}

/// Returns the settings of the file, if any, overridden by the flags.
fn refinement_settings(arguments: &RefineArguments) -> Result<RefinementSettings, Failure> {
    let mut settings =
        arguments.settings.as_deref().map(settings_file).transpose()?.unwrap_or_default();
    settings.method = arguments.method.unwrap_or(settings.method);
    settings.prior = arguments.prior.unwrap_or(settings.prior);
    settings.restart_s = arguments.restart_s.or(settings.restart_s);
    settings.difference_s = arguments.difference_s.or(settings.difference_s);
    arguments.constrain.iter().for_each(|constrain| constrain.add_to(&mut settings.constraints));
    settings.constraints.trust_sd = arguments.trust_sd.or(settings.constraints.trust_sd);
    // Held-out trials of file and flags add up; every other flag replaces the value of the file.
    settings.held_out.extend(arguments.held_out.iter().cloned());
    Ok(settings)
}

fn named_files(arguments: &RefineArguments) -> Vec<PathBuf> {
    let files = arguments.trials.iter().chain(&arguments.settings).cloned();
    files.chain([PathBuf::from(&arguments.ship)]).collect()
}

fn find_law(zoo: &Zoo, name: &str) -> Result<Arc<Law>, Failure> {
    let known = || zoo.laws().map(|law| law.name.as_str()).collect::<Vec<_>>().join(", ");
    let missing = || {
        Failure::Refused(format!("--law {name}: there is no such law; choose one of {}", known()))
    };
    zoo.law(name).cloned().ok_or_else(missing)
}

/// Returns a model without coefficients, with the approach speed of the fitted trials.
fn blank_target(
    law: &Law,
    target: &Vessel,
    settings: &RefinementSettings,
    read: &[ReadTrial],
) -> Result<Model, Failure> {
    let fitted = trials::trial_refs(read)
        .into_iter()
        .filter(|trial| !settings.held_out.contains(&trial.name));
    let approach = trial_approach(&fitted.collect::<Vec<_>>());
    blank_model(law, target, approach).map_err(|error| Failure::Refused(error.to_string()))
}

/// Selects the best eligible source; held-out trials do not influence it.
fn choose_source(
    zoo: &Zoo,
    target: &Vessel,
    settings: &RefinementSettings,
    read: &[ReadTrial],
) -> Result<(Model, SimilarityRanking), Failure> {
    print_note("selecting the source by similarity and by the trend of the trials");
    let fitted = trials::trial_refs(read)
        .into_iter()
        .filter(|trial| !settings.held_out.contains(&trial.name));
    let similarity = rank_similar(zoo, target, None, &fitted.collect::<Vec<_>>());
    let source = best_source(zoo, &similarity)
        .map_err(|reasons| Failure::Refused(format!("{reasons}; choose one with --source")))?;
    print_note(&format!("source: {}", source.name));
    Ok((source, similarity))
}

fn run_refinement(
    zoo: &Zoo,
    (target, source): (&Vessel, &Model),
    (source_law, law): (&Law, &Law),
    settings: &RefinementSettings,
    read: &[ReadTrial],
) -> Result<Refinement, Failure> {
    let trials = trials::trial_refs(read);
    let population = match settings.prior {
        Prior::Population => similar_population(zoo, target),
        Prior::Source | Prior::Mixture => Vec::new(),
    };
    let request = RefinementSpec {
        target,
        source,
        source_law: Some(source_law),
        law,
        trials: &trials,
        population: &population,
        settings,
    };
    let told = |fraction: f64, what: &str| {
        print_note(&format!("{:3.0} % {what}", 100.0 * fraction));
        true
    };
    refine(&request, &told).map_err(|error| Failure::Refused(error.to_string()))
}

fn calibrate_uncertainty(
    zoo: &Zoo,
    refinement: Refinement,
    law: &Law,
    read: &[ReadTrial],
) -> Refinement {
    print_note("estimating the noise model");
    let effects: Vec<_> = zoo.effects().cloned().collect();
    with_uncertainty(refinement, law, &effects, &trials::trial_refs(read))
}
