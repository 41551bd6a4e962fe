//! `sistership manoeuvre`: turning circles, zigzags, stopping, pull-outs and spirals, their figures
//! and the IMO criteria.

use std::path::PathBuf;

use clap::Args;
use sistership_assessment::uncertainty::{Sampling, UncertaintyBands, uncertainty_bands};
use sistership_model::environment::PredictionEnvironment;
use sistership_model::{Law, Model, Zoo};
use sistership_simulation::Ship;
use sistership_simulation::manoeuvre::{ManoeuvreSettings, simulate_further_manoeuvres};

use super::manoeuvre_document::ManoeuvreDocument;
use super::manoeuvre_further::FurtherArguments;
use super::requested_manoeuvres::simulate_requested;
use super::{build_ship, manoeuvre_text, set_depth};
use crate::failure::Failure;
use crate::files::OutputFile;
use crate::values::{IntegrationMethod, positive, rudder_deg, zigzag_deg};
use crate::{output, resolve, track};

const EXAMPLES: &str = "\
Examples:
  sistership manoeuvre --model mariner
  sistership manoeuvre --model kvlcc2 --turn 35 --turn -35 --json
  sistership manoeuvre --model my-model.yaml --zigzag 20/20 --speed-m-s 6 --out zigzag.csv
  sistership manoeuvre --model csl-spirit --stop --reversal-s 30
  sistership manoeuvre --model esso-tanker --pull-out 20 --pull-out -20 --spiral

Positive rudder turns to starboard. The exit status is 0 when a criterion is not met, and 1 when a
manoeuvre leaves the physical range or the law does not support it.";

/// Simulate turning circles, zigzags, stops, pull-outs and spirals and compare them with the IMO
/// criteria.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct ManoeuvreArguments {
    /// The model: a name in the zoo, a model file, or a vessel file with a model.
    #[arg(long)]
    model: String,
    /// A turning circle with this rudder; repeatable.
    #[arg(long, value_name = "DEG", value_parser = rudder_deg, allow_negative_numbers = true, conflicts_with_all = ["zigzag", "all"])]
    turn: Vec<f64>,
    /// A zigzag: rudder and change of heading, such as 20/20; repeatable.
    #[arg(long, value_name = "DEG/DEG", value_parser = zigzag_deg, allow_hyphen_values = true, conflicts_with = "all")]
    zigzag: Vec<(f64, f64)>,
    #[command(flatten)]
    further: FurtherArguments,
    /// Turns at 35 deg, zigzags 10/10 and 20/20 to both sides, initial turning, a stop where the
    /// law can, pull-outs, spirals of an unstable ship, IMO criteria: the default.
    #[arg(long)]
    all: bool,
    /// Approach speed; by default that of the model.
    #[arg(long, value_name = "U", value_parser = positive, allow_negative_numbers = true)]
    speed_m_s: Option<f64>,
    /// Propeller revolutions per second; by default those of the approach speed.
    #[arg(long, value_name = "N", value_parser = positive, allow_negative_numbers = true)]
    n_rps: Option<f64>,
    /// Water depth; deep water by default.
    #[arg(long, value_name = "H", value_parser = positive, allow_negative_numbers = true)]
    depth_m: Option<f64>,
    /// Longest duration of a manoeuvre; by default scaled with ship length and speed.
    #[arg(long, value_name = "SECONDS", value_parser = positive, allow_negative_numbers = true)]
    duration_s: Option<f64>,
    /// Integration step; by default 0.1 s, shorter for small models.
    #[arg(long, value_name = "SECONDS", value_parser = positive, allow_negative_numbers = true)]
    step_s: Option<f64>,
    /// Integration method.
    #[arg(long, value_enum, default_value_t)]
    method: IntegrationMethod,
    /// Number of draws from the posterior of a refined model, for uncertainty bands of the standard
    /// manoeuvres.
    #[arg(long, value_name = "SAMPLES", conflicts_with_all = ["turn", "zigzag", "stop", "pull_out", "spiral"])]
    bands: Option<usize>,
    /// Seed of these draws.
    #[arg(long, value_name = "SEED", default_value_t = 1, requires = "bands")]
    seed: u64,
    /// Write the track of the single manoeuvre (canonical columns).
    #[arg(long, value_name = "CSV")]
    out: Option<PathBuf>,
    /// Print one JSON document.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
///
/// # Errors
/// Returns an error if the model is refused, or if a manoeuvre leaves the physical range.
pub fn run(zoo: &Zoo, manoeuvre: &ManoeuvreArguments) -> Result<(), Failure> {
    check_single(manoeuvre)?;
    let (mut model, law) = resolve::resolve_model(zoo, &manoeuvre.model)?;
    let inputs = [PathBuf::from(&manoeuvre.model)];
    let file = manoeuvre.out.as_ref().map(|path| OutputFile::new(path, &inputs)).transpose()?;
    let mut remarks = adapt_to_speed(manoeuvre, &mut model, &law);
    remarks.extend(engine_remark(&model));
    let environment =
        PredictionEnvironment { depth_m: manoeuvre.depth_m, ..PredictionEnvironment::default() };
    remarks.extend(environment.uncovered_inputs(&model).into_iter().map(|one| one.message));
    let ship = prepare_ship(manoeuvre, &model, &law)?;
    let settings = manoeuvre_settings(manoeuvre);
    // Without any manoeuvre in the call the standard set is simulated.
    let usual = manoeuvre.turn.is_empty() && manoeuvre.zigzag.is_empty();
    let usual = usual && !manoeuvre.further.is_requested();
    let (sailed, tracks) =
        simulate_requested(&ship, &manoeuvre.turn, &manoeuvre.zigzag, usual, &settings);
    let asked = manoeuvre.further.requested_manoeuvres(usual);
    let mut further = simulate_further_manoeuvres(&model, &law, &ship, &settings, &asked);
    // In the standard set a law without a reversed propeller is a remark; on request it is a
    // failure.
    if !usual && let Some(reason) = further.no_stopping.take() {
        further.failures.push(format!("stopping: {reason}"));
    }
    let tracks = tracks.iter().chain(further.tracks.iter().map(|(_, track)| track));
    if let (Some(file), Some(track)) = (file, tracks.into_iter().next()) {
        file.write(&track::track_csv(track, &law, ship.follows_revolutions())?)?;
    }
    let bands = draw_bands(manoeuvre, &model, &law)?;
    let document = ManoeuvreDocument::from_results(&model, &ship, sailed, further, bands, remarks);
    output::print_result(manoeuvre.json, &document, || {
        manoeuvre_text::format_manoeuvres(&document, &model, &law, &ship)
    })?;
    if document.failures.is_empty() { Ok(()) } else { Err(Failure::Told) }
}

/// Checks that a track is written for a single manoeuvre only.
fn check_single(manoeuvre: &ManoeuvreArguments) -> Result<(), Failure> {
    let tracks = manoeuvre.turn.len() + manoeuvre.zigzag.len() + manoeuvre.further.track_count();
    if manoeuvre.out.is_some() && tracks != 1 {
        return Err(Failure::Call(
            "--out writes the track of a single manoeuvre: give one --turn, --zigzag, --stop or \
             --pull-out"
                .into(),
        ));
    }
    Ok(())
}

/// Remark on revolutions that fall in a manoeuvre.
fn engine_remark(model: &Model) -> Option<String> {
    let percent = 50.0 * model.revolutions_loss?;
    Some(format!(
        "revolutions fall with the speed as in the trials of the model: by {percent:.0} % at half \
         the speed"
    ))
}

/// Moves a law that is expanded about an approach speed to the requested speed; returns remarks on
/// this and on the rudder limit.
fn adapt_to_speed(manoeuvre: &ManoeuvreArguments, model: &mut Model, law: &Law) -> Vec<String> {
    let mut remarks = Vec::new();
    if let (Some(speed), Some(own), Some(_)) =
        (manoeuvre.speed_m_s, model.speed_m_s, law.approach_speed_parameter())
        && speed != own
    {
        model.set_approach_speed(law, speed);
        // Revolutions in proportion to speed: the advance ratio of the propeller stays.
        model.revolutions_rps = model.revolutions_rps.map(|n| n * speed / own);
        remarks.push(format!(
            "the law is expanded about {speed} m/s here; the model was fitted at {own} m/s"
        ));
    }
    let largest = manoeuvre
        .turn
        .iter()
        .chain(manoeuvre.zigzag.iter().map(|(rudder, _)| rudder))
        .fold(manoeuvre.further.largest_deg(), |a, b| a.max(b.abs()));
    // The standard set orders 35 deg.
    let ordered = if largest == 0.0 { 35.0 } else { largest };
    if ordered > model.steering.limit_deg {
        remarks.push(format!(
            "a rudder angle of {ordered} deg was ordered; the rudder stops at {} deg",
            model.steering.limit_deg
        ));
    }
    remarks
}

fn prepare_ship(manoeuvre: &ManoeuvreArguments, model: &Model, law: &Law) -> Result<Ship, Failure> {
    let mut ship = build_ship(model, law)?;
    let speed = manoeuvre.speed_m_s.unwrap_or(ship.approach_speed_m_s());
    ship.set_envelope_speed(speed);
    if ship.follows_revolutions() && manoeuvre.n_rps.is_none() && ship.revolutions_at(speed) == 0.0
    {
        let message = format!(
            "law `{}` needs propeller revolutions and {} gives none: add --n-rps",
            law.name, model.name
        );
        return Err(Failure::Refused(message));
    }
    if let Some(depth_m) = manoeuvre.depth_m {
        set_depth(&mut ship, model, law, depth_m)?;
    }
    Ok(ship)
}

fn manoeuvre_settings(manoeuvre: &ManoeuvreArguments) -> ManoeuvreSettings {
    ManoeuvreSettings {
        speed_m_s: manoeuvre.speed_m_s,
        n_rps: manoeuvre.n_rps,
        duration_s: manoeuvre.duration_s,
        step_s: manoeuvre.step_s,
        method: manoeuvre.method.into(),
        ..ManoeuvreSettings::default()
    }
}

/// Draws the requested bands.
fn draw_bands(
    manoeuvre: &ManoeuvreArguments,
    model: &Model,
    law: &Law,
) -> Result<Option<UncertaintyBands>, Failure> {
    let Some(samples) = manoeuvre.bands else { return Ok(None) };
    let sampling = Sampling { samples, seed: manoeuvre.seed };
    sampling.check().map_err(|message| Failure::Call(format!("--bands: {message}")))?;
    let none = || {
        let why = "only a refined model with unchanged coefficients has one";
        Failure::Refused(format!("--bands: {} has no posterior to draw from; {why}", model.name))
    };
    uncertainty_bands(model, law, &manoeuvre_settings(manoeuvre), manoeuvre.depth_m, sampling)
        .ok_or_else(none)
        .map(Some)
}
