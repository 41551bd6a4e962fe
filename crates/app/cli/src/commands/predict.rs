//! `sistership predict`: prediction over a horizon from now on, under given orders.

use std::path::PathBuf;

use clap::Args;
use serde_json::{Value, json};
use sistership_api::Limits;
use sistership_jobs::aliases::{CHAMPION, find_alias};
use sistership_jobs::predictions::{PredictionRequest, predict};
use sistership_model::{Law, Model, Zoo};

use super::predict_orders::{self, OrderRow};
use super::predict_text;
use super::store::{StoreArguments, with_archive};
use crate::failure::Failure;
use crate::files::OutputFile;
use crate::values::{not_negative, number, positive};
use crate::{output, resolve};

const EXAMPLES: &str = "\
Examples:
  sistership predict --model mariner --rudder-deg 20 --duration-s 120
  sistership predict --model refined.yaml --orders orders.csv --duration-s 60 --draws 100 --json
  sistership predict --model my-ship/3 --data-dir here --wind-m-s 15 --wind-from-deg 270 \\
    --duration-s 300

Orders are a CSV file with the columns t_s, delta_deg or delta_rad, and n_rps; an empty cell keeps
the previous order. The result is that of `POST /v1/predictions` with a horizon.
Exit status 1 when the motion leaves the physical range.";

/// Predict the motion over a horizon under future orders, in wind and current, with a prediction
/// interval.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct PredictArguments {
    /// The model: a name in the zoo, a model file, a vessel file with a model; else of a store
    /// `ship` (its champion), `ship/number` or `ship/alias`.
    #[arg(long)]
    model: String,
    /// Duration of the prediction.
    #[arg(long, value_name = "SECONDS", value_parser = positive, allow_negative_numbers = true)]
    duration_s: f64,
    /// Orders over time.
    #[arg(long, value_name = "CSV", conflicts_with_all = ["rudder_deg", "n_rps"])]
    orders: Option<PathBuf>,
    /// Constant rudder order, positive to starboard.
    #[arg(long, value_name = "DEG", value_parser = number, allow_negative_numbers = true)]
    rudder_deg: Option<f64>,
    /// Constant order of propeller revolutions; by default those of the initial speed.
    #[arg(long, value_name = "N", value_parser = number, allow_negative_numbers = true)]
    n_rps: Option<f64>,
    /// Initial speed ahead over ground; by default the approach speed of the model.
    #[arg(long, value_name = "U", value_parser = number, allow_negative_numbers = true)]
    speed_m_s: Option<f64>,
    /// Initial heading, clockwise from north; requires --speed-m-s.
    #[arg(long, value_name = "DEG", value_parser = number, requires = "speed_m_s")]
    #[arg(allow_negative_numbers = true)]
    heading_deg: Option<f64>,
    /// Time between samples.
    #[arg(long, value_name = "SECONDS", value_parser = positive, default_value_t = 0.5)]
    #[arg(allow_negative_numbers = true)]
    dt_s: f64,
    /// Water depth; deep water by default.
    #[arg(long, value_name = "H", value_parser = positive, allow_negative_numbers = true)]
    depth_m: Option<f64>,
    /// Speed of a steady wind.
    #[arg(long, value_name = "M/S", value_parser = not_negative, requires = "wind_from_deg")]
    #[arg(allow_negative_numbers = true)]
    wind_m_s: Option<f64>,
    /// Direction the wind comes from, clockwise from north.
    #[arg(long, value_name = "DEG", value_parser = number, requires = "wind_m_s")]
    #[arg(allow_negative_numbers = true)]
    wind_from_deg: Option<f64>,
    /// Speed of a steady current.
    #[arg(long, value_name = "M/S", value_parser = not_negative, requires = "current_towards_deg")]
    #[arg(allow_negative_numbers = true)]
    current_m_s: Option<f64>,
    /// Direction the current sets towards, clockwise from north.
    #[arg(long, value_name = "DEG", value_parser = number, requires = "current_m_s")]
    #[arg(allow_negative_numbers = true)]
    current_towards_deg: Option<f64>,
    /// Number of draws from the posterior of a refined model, for a 95 % prediction interval.
    #[arg(long, value_name = "NUMBER")]
    draws: Option<u32>,
    /// Seed of these draws.
    #[arg(long, value_name = "SEED", default_value_t = 1, requires = "draws")]
    seed: u64,
    #[command(flatten)]
    store: StoreArguments,
    /// Write the track (canonical columns).
    #[arg(long, value_name = "CSV")]
    out: Option<PathBuf>,
    /// Print one JSON document.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
///
/// # Errors
/// Returns an error if the model or an order is refused, or if the motion leaves the physical
/// range.
pub fn run(zoo: &Zoo, asked: &PredictArguments) -> Result<(), Failure> {
    let orders = read_orders(asked)?;
    let (model, law) = find_model(zoo, asked)?;
    let inputs: Vec<PathBuf> =
        asked.orders.iter().cloned().chain([PathBuf::from(&asked.model)]).collect();
    let file = asked.out.as_ref().map(|path| OutputFile::new(path, &inputs)).transpose()?;
    let refused = |error: &dyn std::fmt::Display| Failure::Refused(error.to_string());
    let request: PredictionRequest =
        serde_json::from_value(horizon_request(asked, &orders)).map_err(|error| refused(&error))?;
    // The same limit as for a request to a server.
    let most = Limits::default().prediction_samples;
    let mut answer = predict(&request, &model, &law, most).map_err(|error| refused(&error))?;
    answer["model"] = json!(model.name);
    answer["law"] = json!(model.law);
    if let Some(file) = file {
        file.write(predict_text::track_csv(&answer, &law).as_bytes())?;
    }
    output::print_result(asked.json, &answer, || predict_text::format_prediction(&answer))?;
    if answer["stopped"].is_null() { Ok(()) } else { Err(Failure::Told) }
}

fn read_orders(asked: &PredictArguments) -> Result<Vec<OrderRow>, Failure> {
    match &asked.orders {
        Some(path) => predict_orders::read_orders(path),
        None => {
            let delta_rad = asked.rudder_deg.map(f64::to_radians);
            Ok(vec![OrderRow { t_s: 0.0, delta_rad, n_rps: asked.n_rps }])
        }
    }
}

/// Builds the request as for a server.
fn horizon_request(asked: &PredictArguments, orders: &[OrderRow]) -> Value {
    // Speed and direction come together or not at all, which the flags require.
    let steady = |speed: Option<f64>, key: &str, degrees: Option<f64>| {
        let (speed, degrees) = speed.zip(degrees)?;
        Some(json!({ "speed_m_s": speed, key: degrees.to_radians() }))
    };
    let heading = asked.heading_deg.unwrap_or(0.0).to_radians();
    let start = asked.speed_m_s.map(|speed| json!({ "u_m_s": speed, "psi_rad": heading }));
    json!({ "model": "model", "depth_m": asked.depth_m, "horizon": {
        "start": start,
        "orders": orders,
        "duration_s": asked.duration_s,
        "dt_s": asked.dt_s,
        "wind": steady(asked.wind_m_s, "from_rad", asked.wind_from_deg),
        "current": steady(asked.current_m_s, "towards_rad", asked.current_towards_deg),
        "draws": asked.draws,
        "seed": asked.draws.map(|_| asked.seed),
    } })
}

/// Returns a model of the zoo or of a file; else one of the store, if that exists.
fn find_model(zoo: &Zoo, asked: &PredictArguments) -> Result<(Model, Law), Failure> {
    match resolve::resolve_model(zoo, &asked.model) {
        Ok((model, law)) => Ok((model, (*law).clone())),
        Err(unknown) if !asked.store.exists() => Err(unknown),
        // The fault of a file that exists is more useful than a search in the store.
        Err(unknown) if std::path::Path::new(&asked.model).is_file() => Err(unknown),
        Err(_) => stored_model(asked),
    }
}

fn stored_model(asked: &PredictArguments) -> Result<(Model, Law), Failure> {
    let (ship, rest) = asked.model.split_once('/').unwrap_or((&asked.model, CHAMPION));
    with_archive(&asked.store, async |archive| {
        let number = match rest.parse() {
            Ok(number) => number,
            Err(_) => match find_alias(&archive.store, ship, rest).await.map_err(error_text)? {
                Some(alias) => alias.version_number,
                None => return Err(format!("the store has no model `{}`", asked.model)),
            },
        };
        let version = archive.store.versions().get(ship, number).await.map_err(error_text)?;
        let model = archive.model_with_weights(&version).await.map_err(error_text)?;
        let law = archive.store.laws().get(&model.law).await.map_err(error_text)?;
        let law = Law::parse(&law.name, &law.document).map_err(error_text)?;
        Ok((model, law))
    })
}

fn error_text(error: impl std::fmt::Display) -> String {
    error.to_string()
}
