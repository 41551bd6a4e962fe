//! `sistership estimate`: model of a ship from its particulars alone.

use std::path::PathBuf;
use std::sync::Arc;

use clap::Args;
use serde::Serialize;
use sistership_assessment::uncertainty::UncertaintyBand;
use sistership_model::estimated_particulars::{
    EstimatedParticular, describe_estimates, estimated_particulars,
};
use sistership_model::vessel::Status;
use sistership_model::{Law, Model, Vessel, Zoo};
use sistership_priors::estimates::particulars::complete_particulars;
use sistership_priors::estimates::{
    EstimateBands, EstimateSpread, LAW, RegressionLibrary, ShipEstimate, estimate_bands,
    estimate_ship as estimated,
};
use sistership_simulation::manoeuvre::{NamedFigure, StandardManoeuvres};

use super::written_files::{model_file, output_file};
use crate::failure::Failure;
use crate::table::{TextTable, format_number};
use crate::{output, resolve};

const EXAMPLES: &str = "\
Examples:
  sistership estimate --ship my-ship.yaml
  sistership estimate --ship pcc --out pcc-estimate.yaml
  sistership manoeuvre --model pcc-estimate.yaml --all

The ship needs lpp_m, beam_m and draught_m. Other particulars that it does not state (block
coefficient, speed, centre of gravity, rudder, propeller) are estimated and listed with their bands.
The model follows from published regressions (models/regressions), not from measurements.";

/// Estimate a model of a ship from its particulars, with uncertainty bands of the standard
/// manoeuvres.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct EstimateArguments {
    /// The ship: a name in the zoo or a vessel file.
    #[arg(long, value_name = "SHIP")]
    ship: String,
    /// Approach speed; by default that of the ship's first model, else its service speed, stated or
    /// estimated.
    #[arg(long, value_name = "U")]
    speed_m_s: Option<f64>,
    /// Write the model to a file.
    #[arg(long, value_name = "MODEL.yaml")]
    out: Option<PathBuf>,
    /// Seed of the draws for the bands.
    #[arg(long, value_name = "NUMBER", default_value_t = 1)]
    seed: u64,
    /// Print one JSON document.
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct EstimateDocument<'a> {
    ship: &'a str,
    status: Status,
    law: &'static str,
    speed_m_s: f64,
    revolutions_rps: Option<f64>,
    draws: usize,
    failed: usize,
    manoeuvres: &'a StandardManoeuvres,
    bands: &'a [UncertaintyBand],
    values: &'a [EstimateSpread],
    estimated_particulars: Vec<EstimatedParticular>,
    model: &'a Model,
    #[serde(skip_serializing_if = "Option::is_none")]
    out: Option<&'a PathBuf>,
}

/// Runs the command.
///
/// # Errors
/// Returns an error that names the missing particulars, or if the model cannot be written.
pub fn run(zoo: &Zoo, asked: &EstimateArguments) -> Result<(), Failure> {
    let vessel = resolve::resolve_ship(zoo, &asked.ship)?;
    // Before the estimate: the regressions need a speed.
    let vessel = with_speed(&vessel, asked.speed_m_s);
    let inputs = [PathBuf::from(&asked.ship)];
    let file = output_file(asked.out.as_deref(), &inputs)?;
    let (estimate, law) = estimate_model(zoo, &vessel, asked.speed_m_s)?;
    let speed_m_s = approach_speed(&vessel, asked.speed_m_s)?;
    let bands = estimate_bands(&estimate, &law, asked.seed).ok_or_else(|| {
        Failure::Refused(format!(
            "{}: no model of this law can be built from its \
                                                 particulars",
            vessel.name()
        ))
    })?;
    if let Some(file) = file {
        let text = model_file(zoo, &estimate.model, "estimated from particulars")?;
        file.write(text.as_bytes())?;
    }
    // Every value of the model with its deviation and the particulars that it was estimated from.
    let values = estimate.value_spreads();
    let document = EstimateDocument {
        ship: vessel.name(),
        status: estimate.model.status,
        law: LAW,
        speed_m_s,
        revolutions_rps: estimate.model.revolutions_rps,
        draws: bands.draws,
        failed: bands.failed,
        manoeuvres: &bands.manoeuvres,
        bands: &bands.figures,
        values: &values,
        estimated_particulars: estimated_particulars(&estimate.model.particulars),
        model: &estimate.model,
        out: asked.out.as_ref(),
    };
    output::print_result(asked.json, &document, || format_estimate(&vessel, &document, &bands))
}

/// Returns the ship with an estimated service speed if none is known.
pub(super) fn with_speed(vessel: &Vessel, asked: Option<f64>) -> Vessel {
    let mut vessel = vessel.clone();
    let own = vessel.file.models.first().and_then(|model| model.speed_m_s);
    if asked.or(own).is_none() {
        // Both are completed, because the estimate of the speed may need the block coefficient.
        let needed = ["block_coefficient", "service_speed_m_s"];
        complete_particulars(&mut vessel.particulars, needed);
    }
    vessel
}

/// Estimates a model of a ship; returns it with its law.
///
/// # Errors
/// Returns an error that names the missing particulars.
pub(super) fn estimate_model(
    zoo: &Zoo,
    vessel: &Vessel,
    speed_m_s: Option<f64>,
) -> Result<(ShipEstimate, Arc<Law>), Failure> {
    let speed_m_s = approach_speed(vessel, speed_m_s)?;
    let library = RegressionLibrary::parse_embedded()?;
    let law = zoo.law(LAW).ok_or_else(|| {
        Failure::Refused(format!(
            "the law `{LAW}` is not in the \
                                                                   zoo"
        ))
    })?;
    let refused =
        |error: sistership_priors::estimates::EstimateError| Failure::Refused(error.to_string());
    let estimate = estimated(&library, vessel, law, speed_m_s).map_err(refused)?;
    Ok((estimate, Arc::clone(law)))
}

fn approach_speed(vessel: &Vessel, asked: Option<f64>) -> Result<f64, Failure> {
    let own = || vessel.file.models.first().and_then(|model| model.speed_m_s);
    let speed = asked.or_else(own).or_else(|| vessel.particular("service_speed_m_s"));
    match speed {
        // Speed of the call, of the ship's first model, or its service speed, in this order.
        Some(speed) if speed > 0.0 && speed < 50.0 => Ok(speed),
        Some(speed) => {
            Err(Failure::Call(format!("--speed-m-s {speed} should be above 0 and below 50 m/s")))
        }
        None => Err(Failure::Refused(format!(
            "{}: give `lpp_m` among its particulars, or --speed-m-s",
            vessel.name()
        ))),
    }
}

fn format_estimate(
    vessel: &Vessel,
    document: &EstimateDocument<'_>,
    bands: &EstimateBands,
) -> String {
    let head = format!(
        "{} ({}): ESTIMATED from particulars, law {LAW}, {} m/s, {} 1/s\n",
        vessel.name(),
        vessel.file.title,
        format_number(document.speed_m_s),
        document.revolutions_rps.map_or("-".into(), format_number),
    );
    let written =
        document.out.map_or(String::new(), |out| format!("\nmodel written to {}\n", out.display()));
    let estimated = describe_estimates(&document.model.particulars);
    let estimated = estimated.map(|words| format!("remark: {words}\n")).unwrap_or_default();
    format!(
        "{head}\n{}\n{}\n{estimated}Bands contain 95 % of {} models drawn from the covariance of \
         the estimate; {} of them left the physical range in a manoeuvre.\n{written}",
        format_manoeuvres(bands),
        format_values(document.values),
        document.draws,
        document.failed
    )
}

fn format_manoeuvres(bands: &EstimateBands) -> TextTable {
    let mut table = TextTable::new(["figure", "unit", "estimate", "low", "high"]);
    // Figures and bands are matched by name; one without a band gets empty cells.
    let band = |name: &str| bands.figures.iter().find(|band| band.figure == name);
    for NamedFigure { name, unit, value, .. } in bands.manoeuvres.list_figures() {
        let (low, high) = band(&name).map_or(("-".into(), "-".into()), |band| {
            (format_number(band.low), format_number(band.high))
        });
        table.add_row([name, unit, value.map_or("-".into(), format_number), low, high]);
    }
    table
}

fn format_values(spreads: &[EstimateSpread]) -> TextTable {
    let mut table = TextTable::new(["value", "estimate", "deviation", "by"]);
    for spread in spreads {
        let by: Vec<&str> = spread.given.keys().map(String::as_str).collect();
        table.add_row([
            spread.name.clone(),
            format_number(spread.mean),
            format_number(spread.deviation),
            by.join(", "),
        ]);
    }
    table
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn asked(ship: &str, out: Option<PathBuf>) -> EstimateArguments {
        EstimateArguments { ship: ship.into(), speed_m_s: None, out, seed: 1, json: true }
    }

    #[test]
    fn a_ship_without_a_model_gets_one_that_reads_back() {
        let zoo = Zoo::load_embedded().unwrap();
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("pcc.yaml");
        run(&zoo, &asked("pcc", Some(out.clone()))).unwrap();
        let (model, _) = resolve::resolve_model(&zoo, out.to_str().unwrap()).unwrap();
        assert_eq!(model.status, Status::Estimated);
        assert!(model.valid_posterior().is_some());
    }

    #[test]
    fn what_is_missing_is_said() {
        let zoo = Zoo::load_embedded().unwrap();
        let message =
            |name: &str| run(&zoo, &asked(name, None)).unwrap_err().message().unwrap().to_owned();
        assert!(message("ferry-140m").contains("beam_m, draught_m"), "{}", message("ferry-140m"));
        let fast = EstimateArguments { speed_m_s: Some(80.0), ..asked("pcc", None) };
        assert!(matches!(run(&zoo, &fast), Err(Failure::Call(_))));
    }
}
